"""The nodes that run: whether they are reached from here, whose names they take, whether they find
their scene files on this machine, and how far the clocks of their machines are from this one's."""
import dataclasses
import http.client
import time
import xmlrpc.client

from checkup import finding
from checkup.network import is_loopback, is_remote, master_place

PATIENCE = 2.0  # s, for an answer of the master or a node
LISTENING = 3.0  # s, to diagnostics, which nodes publish once a second
# Programs and, by default, nodes.
PROGRAMS = {'cloth_simulation', 'exoskeleton_driver', 'exoskeleton_emulator', 'force_renderer', 'haptics',
            'proximity', 'tactile_driver', 'tactile_emulator', 'tactile_renderer', 'hand_tracker'}
# Topics that one node of a graph publishes.
SINGLE = ('/cloth/state', '/exoskeleton/fingertips', '/exoskeleton/servo_cf', '/exoskeleton/operating_state')
ALLOWED_OFFSET = 0.020  # s: stamps beyond are dropped (docs/nodes.md, Several computers)
GOOD_OFFSET = 0.005  # s


@dataclasses.dataclass
class Node:
    host: str
    answers: bool


@dataclasses.dataclass
class Snapshot:
    nodes: dict  # Node by name
    publishers: dict = dataclasses.field(default_factory=dict)  # names of nodes by topic
    scenes: dict = dataclasses.field(default_factory=dict)  # values of the parameters ~scene
    simulated_time: bool = False
    # By node, s: the least time from a message's stamp to its arrival by this machine's clock.
    delays: dict = dataclasses.field(default_factory=dict)


class Transport(xmlrpc.client.Transport):
    def make_connection(self, host):
        return http.client.HTTPConnection(host, timeout=PATIENCE)


def ask(uri, method, *arguments):
    """Of ROS's master or slave API. @returns the value, or None if it is refused
    @throws OSError or xmlrpc.client.Error if nobody answers"""
    with xmlrpc.client.ServerProxy(uri, transport=Transport()) as server:
        code, _, value = getattr(server, method)('/doctor', *arguments)
    return value if code == 1 else None


def node_at(uri):
    host = (uri or '').split('://')[-1].rsplit(':', 1)[0]
    try:
        return Node(host, ask(uri, 'getPid') is not None)
    except (OSError, http.client.HTTPException, xmlrpc.client.Error):
        return Node(host, False)


def take_snapshot(master):
    """@param master its URI @returns None if nobody answers there"""
    try:
        state = ask(master, 'getSystemState')
        names = {name for kind in state for _, names in kind for name in names}
        nodes = {name: node_at(ask(master, 'lookupNode', name)) for name in sorted(names)}
        parameters = [name for name in ask(master, 'getParamNames') if name.endswith('/scene')]
        return Snapshot(nodes, {topic: owners for topic, owners in state[0]},
                        {name: ask(master, 'getParam', name) for name in parameters},
                        bool(ask(master, 'getParam', '/use_sim_time')))
    except (OSError, http.client.HTTPException, xmlrpc.client.Error):
        return None


def hear_delays():
    """@returns Snapshot.delays, of all nodes that publish diagnostics"""
    import rospy
    from diagnostic_msgs.msg import DiagnosticArray
    delays = {}

    def take(message):
        delay = time.time() - message.header.stamp.to_sec()
        node = message._connection_header['callerid']  # pylint: disable=protected-access
        delays[node] = min(delay, delays.get(node, delay))

    rospy.init_node('doctor', anonymous=True, disable_signals=True)
    rospy.Subscriber('/diagnostics', DiagnosticArray, take, queue_size=100)
    time.sleep(LISTENING)
    return delays


def other_machines(machine, snapshot):
    """@returns the hosts that are not this machine, each with the names of its nodes that answer"""
    hosts = {}
    for name, node in snapshot.nodes.items():
        if node.answers and is_remote(machine, node.host):
            hosts.setdefault(node.host, []).append(name)
    return hosts


def check_master(machine, snapshot):
    ok, note, _, error = finding.of('graph')
    place = master_place(machine)
    if not place:
        return  # the network's findings tell
    if snapshot:
        yield ok(f'the master answers; {len(snapshot.nodes)} nodes')
    elif is_remote(machine, place[0]):
        yield error(f'no master answers at {place[0]}, port {place[1]}',
                    'start roslaunch there, or let the firewall pass connections')
    else:
        yield note('no master runs, so nothing is said of nodes and clocks', 'roslaunch starts one')


def check_nodes(machine, snapshot):
    _, _, warning, error = finding.of('graph')
    place = master_place(machine)
    for name, node in snapshot.nodes.items():
        addresses = machine.addresses(node.host)
        if not addresses:
            yield error(f'{name} runs on {node.host!r}, which does not resolve here',
                        'export ROS_IP=ADDRESS there before the launch, or add a line to /etc/hosts here')
        elif any(map(is_loopback, addresses)) and place and is_remote(machine, place[0]):
            yield error(f'{name} told the master of another machine that it is at {node.host!r}: nobody '
                        'reaches it there', 'export ROS_IP=ADDRESS on its machine before the launch')
    silent = [name for name, node in snapshot.nodes.items()
              if not node.answers and machine.addresses(node.host)]
    if silent:
        yield warning(f'registered, but without an answer: {", ".join(silent)}',
                      'rosnode cleanup, if they have died; else look for a firewall')


def check_names(machine, snapshot):
    """Whether another graph has the names that a launch would take."""
    ok, note, warning, _ = finding.of('names')
    spaces = {}
    for name in snapshot.nodes:
        space, _, base = name.rpartition('/')
        if base in PROGRAMS:
            spaces.setdefault(space or '/', []).append(base)
    for space, names in sorted(spaces.items()):
        yield note(f'haptex runs in {space}: {", ".join(sorted(names))}; a launch in the same namespace '
                   'takes their names, and they end',
                   'a namespace and a tf_prefix of its own: docs/nodes.md, Two hands')
    for topic, owners in sorted(snapshot.publishers.items()):
        if topic.endswith(SINGLE) and len(owners) > 1:
            yield warning(f'{topic} is published by {" and ".join(sorted(owners))}: two graphs on the '
                          'same names', 'end one, or give it a namespace of its own')
    if not spaces:
        yield ok('the names of haptex are free in this graph')


def check_processes(machine):
    """Nodes of haptex on this machine that belong to another master."""
    _, _, warning, _ = finding.of('names')
    own = machine.environment.get('ROS_MASTER_URI', '').rstrip('/')
    for process in machine.processes():
        uri = process.environment.get('ROS_MASTER_URI', own).rstrip('/')
        if process.name in PROGRAMS and uri != own:
            yield warning(f'{process.name} ({process.number}) runs on this machine for another master, '
                          f'{uri}: both graphs share processors, ports and links',
                          f'kill -INT {process.number}, if nobody needs it')


def check_scenes(machine, snapshot):
    ok, _, _, error = finding.of('scene')
    for parameter, value in sorted(snapshot.scenes.items()):
        if not isinstance(value, str) or '/' not in value:
            continue  # a name in config/scenes of the package
        if machine.exists(value):
            yield ok(f'{value} ({parameter}) is on this machine')
        else:
            yield error(f'{value} ({parameter}) is not on this machine, and every node reads it itself',
                        'copy it, with the files that it names, to the same path')


def check_clock(host, delay):
    """@param delay s, or None: nothing was heard of it"""
    ok, note, warning, error = finding.of('clock')
    if delay is None:
        return note(f'no diagnostics from {host}, so its clock is not known')
    text = f'the clock of {host} is {1e3 * abs(delay):.1f} ms {"behind" if delay > 0 else "ahead"}'
    mend = 'chrony or PTP on both machines; chronyc tracking tells how far they are'
    if abs(delay) > ALLOWED_OFFSET:
        return error(f'{text}: stamps beyond {1e3 * ALLOWED_OFFSET:.0f} ms are dropped', mend)
    if abs(delay) > GOOD_OFFSET:
        return warning(f'{text}; {1e3 * ALLOWED_OFFSET:.0f} ms are allowed', mend)
    return ok(f'{text}, the delay of a message included; {1e3 * ALLOWED_OFFSET:.0f} ms are allowed')


def check_clocks(machine, snapshot):
    ok, note, *_ = finding.of('clock')
    others = other_machines(machine, snapshot)
    if not others:
        yield ok('all nodes that answer are on this machine')
    elif snapshot.simulated_time:
        yield note('time is simulated (/use_sim_time): clocks are not compared')
    else:
        for host, names in sorted(others.items()):
            yield check_clock(host, min((snapshot.delays[name] for name in names
                                         if name in snapshot.delays), default=None))
