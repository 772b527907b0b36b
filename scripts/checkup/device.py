"""The serial port, who may use it, and what the device at its other end says. It is greeted and
listened to by the program ask_device, and never commanded: the motors stay off."""
import math
import os

import yaml

from checkup import finding

ok, note, warning, error = finding.of('device')

PATTERNS = ('/dev/ttyUSB*', '/dev/ttyACM*')
DRIVERS = {'exoskeleton_driver', 'haptics', 'tactile_driver'}
RESTING_FORCE = 0.05  # N, that a sensor which nobody touches may show: ten of its steps
BAD_FRAMES = 0.001  # share of damaged or lost ones that does not matter


def path_of(machine, port):
    """A name without a slash is a link in ROS's home directory, as for the nodes."""
    if '/' in port:
        return port
    home = machine.environment.get('ROS_HOME') or f'{machine.environment.get("HOME", "")}/.ros'
    return f'{home}/{port}'


def check_access(machine, path, port):
    """@returns what keeps this user from it, or None"""
    if port.readable_and_writable:
        return None
    text = f'{path} may not be read and written by {machine.user} (group {port.group}, {port.mode:o})'
    if port.group in machine.groups(configured=True):
        return error(f'{text}: this login is older than the membership in {port.group}', 'log in again')
    if port.group == 'root':
        return error(text, 'a udev rule that gives it to dialout: '
                     'SUBSYSTEM=="tty", GROUP="dialout", MODE="0660"')
    return error(text, f'sudo usermod -aG {port.group} {machine.user}\nlog in again')


def check_holder(machine, path):
    """@returns who has it open, or None"""
    for process in machine.holders(path):
        text = f'{path} is in use by {process.name} ({process.number}), so the device is not asked'
        if process.name in DRIVERS:
            return note(f'{text}; what the driver knows is in /diagnostics',
                        'rostopic echo -n 1 /diagnostics')
        return error(text, f'end {process.name}')
    return None


def check_port(machine, path):
    """@returns a finding if the device cannot be asked, or None"""
    port = machine.port(path)
    if not port:
        others = [other for pattern in PATTERNS for other in machine.paths(pattern)]
        return error(f'there is no {path}; there are: {", ".join(others) or "no USB serial ports"}',
                     'plug it in and switch it on; sudo dmesg | tail says what the kernel saw')
    if not port.is_device:
        return error(f'{path} is no serial port', 'give one, /dev/ttyUSB0 for example')
    return check_access(machine, path, port) or check_holder(machine, path)


def check_ports(machine):
    """Those that are there, when none was named."""
    paths = [path for pattern in PATTERNS for path in machine.paths(pattern)]
    if not paths:
        yield note('no USB serial port is there: fine with the emulator')
    for path in paths:
        port = machine.port(path)
        trouble = port and check_access(machine, path, port)
        if trouble:
            yield warning(trouble.text, trouble.remedy)
        elif port:
            yield ok(f'{path} may be used; rosrun haptex doctor --device {path} asks who is there')
    if paths and any(process.name == 'ModemManager' for process in machine.processes()):
        yield warning('ModemManager runs: it opens new serial ports and writes to them',
                      'sudo systemctl disable --now ModemManager')


def check_versions(answer):
    """@returns a finding if the driver would not take the device, or None"""
    version, expected = answer['version'], answer['expected_version']
    if version != expected:
        return error(f'the {answer["device"]} speaks version {version} of its protocol, this package '
                     f'version {expected}', 'firmware and package of the same version')
    counts, wanted = (answer.get(key) for key in ('counts_per_revolution',
                                                  'expected_counts_per_revolution'))
    if counts != wanted:
        return error(f'the encoders have {counts} counts per revolution, the driver computes with '
                     f'{wanted}: all angles would be wrong',
                     'set kCountsPerRevolution (device_messages.h) and build anew')
    return None


def check_line(answer):
    bad = answer['corrupt_frames'] + answer['lost_states']
    frames = answer['good_frames'] + bad
    if frames and bad > BAD_FRAMES * frames:
        yield warning(f'{bad} of {frames} frames were damaged or lost',
                      'a shorter cable, a transceiver for 1 Mbit/s; docs/serial_protocol.md')


def check_sensors(answer):
    if answer.get('states') == 0:
        yield error('the exoskeleton answers, but sends no states', 'switch it off and on')
        return
    if not answer['motors_off']:
        yield warning('the motors are on although nobody commands them', 'switch it off and on')
    for finger in ('index', 'thumb'):
        force = math.sqrt(sum(component * component for component in answer[f'{finger}_force']))
        if answer[f'{finger}_saturated']:
            yield warning(f'the force sensor of the {finger} is at the end of its range',
                          'take the finger out; if it stays so, the sensor or its cable is broken')
        elif force > RESTING_FORCE:
            yield warning(f'the force sensor of the {finger} shows {force:.2f} N',
                          'if nothing touches it: let the firmware take its zero anew')
        else:
            yield ok(f'the force sensor of the {finger} shows {force:.3f} N')


def check_calibration(machine, folder):
    """Of contactors: what the launch files take without another word."""
    text = machine.text(f'{folder}/config/tactile/representative.yaml') if folder else None
    if text and 'not measured' in text:
        yield note('the calibration "representative" of the contactors is not measured: amplitudes are '
                   'those of another array', 'calibration:=FILE, see docs/tactile_protocol.md')


def describe(answer):
    return (f'{answer["device"]}, version {answer["version"]}, firmware {answer["firmware"]}, '
            f'number {answer["serial_number"]}')


def check_answer(machine, path, answer, folder):
    if answer['device'] == 'none':
        garbage = answer['garbage_bytes']
        yield error(f'nobody answers at {path} within 2 s' +
                    (f'; {garbage} bytes came that are no frames' if garbage else ''),
                    'is it switched on, the right port, 921600 baud? docs/serial_protocol.md')
        return
    trouble = check_versions(answer)
    yield trouble or ok(f'{path}: {describe(answer)}')
    yield from check_line(answer)
    if trouble:
        return
    if answer['device'] == 'contactors':
        yield from check_calibration(machine, folder)
        return
    yield from check_sensors(answer)
    yield note('its encoders count from where they were at power-on: it is calibrated by homing, which '
               'the launch files do', 'rosservice call /haptex/exoskeleton/home')


def check_device(machine, name, folder):
    """@param name of a port @param folder of haptex, or None"""
    path = path_of(machine, name)
    trouble = check_port(machine, path)
    if trouble:
        yield trouble
        return
    program = machine.program('ask_device')
    if not program:
        yield error(f'{path} is free, but the program that asks the device is not built', 'scripts/demo')
        return
    result = machine.run(program, os.path.abspath(path))
    if result.status != 0:
        # Processes of other users cannot be looked into.
        is_held = 'another program has it open' in result.output
        yield error(result.output or f'{path} could not be asked',
                    f'sudo fuser -v {path} tells which' if is_held else 'unplug it and plug it in again')
        return
    yield from check_answer(machine, path, yaml.safe_load(result.output), folder)
