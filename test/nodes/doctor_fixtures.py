"""A machine on which all is well, for the doctor's tests: each changes one thing."""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'scripts'))
from checkup.machine import Answer, Port, Process  # noqa: E402

EXOSKELETON = """
device: exoskeleton
version: 1
expected_version: 1
firmware: 258
serial_number: 1234567
counts_per_revolution: 2048
expected_counts_per_revolution: 2048
states: 490
motors_off: true
index_force: [0.001, 0, -0.002]
index_saturated: false
thumb_force: [0, 0, 0.003]
thumb_saturated: false
good_frames: 500
corrupt_frames: 0
garbage_bytes: 0
lost_states: 0
"""
CONTACTORS = """
device: contactors
version: 129
expected_version: 129
firmware: 258
serial_number: 1234567
contactors: 24
good_frames: 10
corrupt_frames: 0
garbage_bytes: 0
lost_states: 0
"""
PACKAGES = """# What haptex needs.

# Compiler
cmake

# Tests
git

# View, and its screenshot
rviz
"""


class FakeMachine:
    """The functions of checkup.machine.Machine, from what is given."""

    def __init__(self, **changes):
        self.environment = {'ROS_MASTER_URI': 'http://lab1:11311', 'HOME': '/home/ada', 'DISPLAY': ':0'}
        self.host_name, self.user, self.is_root = 'lab1', 'ada', False
        self.files = {'/pkg/scripts/packages.txt': PACKAGES,
                      '/etc/os-release': 'PRETTY_NAME="Debian GNU/Linux 12"\n',
                      '/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor': 'performance\n',
                      '/dev/ttyUSB0': ''}
        self.commands = {'dpkg-query': Answer(0, 'cmake installed\ngit installed\nrviz installed'),
                         'xdpyinfo': Answer(0, ''), 'git': Answer(0, '0123abc'),
                         'glxinfo': Answer(0, 'OpenGL renderer string: Mesa Intel(R) UHD'),
                         'ask_device': Answer(0, EXOSKELETON)}
        self.programs = None  # all
        self.memberships = {True: {'ada', 'dialout'}, False: {'ada', 'dialout'}}
        self.limits = {'rtprio': 80, 'memlock': None}
        self.fifo, self.count, self.stolen = True, 4, 0.0
        self.ports = {'/dev/ttyUSB0': Port(True, True, 'dialout', 0o660)}
        self.running, self.open = [], {}
        self.hosts = {'lab1': ['192.168.1.7'], 'lab2': ['192.168.1.8']}
        self.own = {'192.168.1.7', '127.0.0.1', '127.0.1.1'}
        self.towards, self.reached = '192.168.1.7', True
        self.environment.update(changes.pop('environment', {}))
        for name, value in changes.items():
            assert hasattr(self, name), name
            setattr(self, name, value)

    def text(self, path):
        return self.files.get(str(path))

    def paths(self, pattern):
        return sorted(path for path in self.files if pathlib.PurePath(path).match(pattern))

    def exists(self, path):
        return path in self.files

    def run(self, *command, **_):
        return self.commands.get(command[0].rsplit('/', 1)[-1], Answer(None, ''))

    def program(self, name):
        return f'/pkg/bin/{name}' if self.programs is None or name in self.programs else None

    def groups(self, configured):
        return self.memberships[configured]

    def limit(self, name):
        return self.limits[name]

    def fifo_granted(self, _):
        return self.fifo

    def processors(self):
        return self.count

    def steal(self, _):
        return self.stolen

    def port(self, path):
        return self.ports.get(path)

    def processes(self):
        return self.running

    def holders(self, path):
        return self.open.get(path, [])

    def addresses(self, name):
        return self.hosts.get(name, [name] if name[:1].isdigit() else [])

    def is_own(self, address):
        return address in self.own

    def address_towards(self, _):
        return self.towards

    def reaches_itself(self, _):
        return self.reached


def process(name, number=12, **environment):
    return Process(number, name, environment)
