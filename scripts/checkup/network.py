"""Under which name this machine is known to the other nodes, and whether that name leads to it."""
import urllib.parse

from checkup import finding

ok, note, warning, error = finding.of('network')


def is_loopback(address):
    return address.startswith('127.')


def own_name(machine):
    """@returns what nodes on this machine call it (roscpp's order), and what says so"""
    for variable in ('ROS_HOSTNAME', 'ROS_IP'):
        if machine.environment.get(variable):
            return machine.environment[variable], variable
    return machine.host_name, 'host name'


def master_place(machine):
    """@returns host and port of ROS_MASTER_URI, or None if it is none"""
    try:
        parts = urllib.parse.urlsplit(machine.environment.get('ROS_MASTER_URI', ''))
        return (parts.hostname, parts.port) if parts.hostname and parts.port else None
    except ValueError:  # of the port
        return None


def suggestion(machine, master):
    """A line that mends the own name."""
    address = machine.address_towards(master) if master else None
    return f'export ROS_IP={address or "127.0.0.1"}' + (
        '' if address else '    # this machine alone; its address in the network for several')


def check_master_name(machine):
    text = machine.environment.get('ROS_MASTER_URI')
    if not text:
        return error('ROS_MASTER_URI is not set, so no node finds the master',
                     'source build/devel/setup.bash, or that of your workspace')
    place = master_place(machine)
    if not place:
        return error(f'ROS_MASTER_URI is {text[:200]!r}: it has to be http://HOST:PORT',
                     'export ROS_MASTER_URI=http://localhost:11311')
    if not machine.addresses(place[0]):
        return error(f'the master\'s host {place[0]!r} (ROS_MASTER_URI) does not resolve',
                     'give its address in ROS_MASTER_URI, or add a line to /etc/hosts')
    return ok(f'the master is looked for at {text}')


def is_remote(machine, host):
    addresses = machine.addresses(host)
    return bool(addresses) and not any(map(machine.is_own, addresses))


def check_own_name(machine):
    name, source = own_name(machine)
    place = master_place(machine)
    master = place[0] if place else None
    remote = master is not None and is_remote(machine, master)
    addresses = machine.addresses(name)
    mend = suggestion(machine, master)
    if not addresses:
        return error(f'the {source} {name!r} does not resolve, but nodes tell it to each other', mend)
    strange = [address for address in addresses if not machine.is_own(address)]
    if strange:
        return error(f'the {source} {name!r} leads to {strange[0]}, which is no address of this machine',
                     mend)
    if remote and any(map(is_loopback, addresses)):
        return error(f'the {source} {name!r} leads to {addresses[0]}, where the machine of the master '
                     f'({master}) finds itself instead of this one', mend)
    if not machine.reaches_itself(name):
        return error(f'this machine does not answer at its own {source} {name!r} ({addresses[0]})',
                     'let the firewall (nft list ruleset) pass connections among the machines of the graph')
    if any(map(is_loopback, addresses)):
        return ok(f'the {source} {name!r} leads to {addresses[0]}: for nodes of this machine alone')
    return ok(f'the {source} {name!r} leads to {addresses[0]}, and this machine answers there')


def check_network(machine):
    yield check_master_name(machine)
    if machine.environment.get('ROS_IP') and machine.environment.get('ROS_HOSTNAME'):
        yield note('both ROS_HOSTNAME and ROS_IP are set: ROS_HOSTNAME counts', 'unset one of them')
    yield check_own_name(machine)
