"""Where the doctor looks: this machine. Tests have another one of the same functions."""
import collections
import glob
import grp
import os
import pathlib
import pwd
import resource
import socket
import stat
import subprocess
import time

from demo_report.host import fifo_granted, read_steal

PATIENCE = 2.0  # s, for an answer
Answer = collections.namedtuple('Answer', 'status output')  # status None: there is no such program
Process = collections.namedtuple('Process', 'number name environment')
Port = collections.namedtuple('Port', 'is_device readable_and_writable group mode')
LIMITS = {'rtprio': resource.RLIMIT_RTPRIO, 'memlock': resource.RLIMIT_MEMLOCK}


class Machine:
    def __init__(self):
        self.environment = dict(os.environ)
        self.host_name = socket.gethostname()
        self.user = pwd.getpwuid(os.getuid()).pw_name
        self.is_root = os.geteuid() == 0
        self.root = pathlib.Path(__file__).resolve().parents[1]  # of the scripts

    # Files, programs, users

    @staticmethod
    def text(path):
        """None if it cannot be read."""
        try:
            return pathlib.Path(path).read_text(encoding='utf-8', errors='replace')
        except OSError:
            return None

    @staticmethod
    def paths(pattern):
        return sorted(glob.glob(pattern))

    @staticmethod
    def exists(path):
        return os.path.exists(path)

    @staticmethod
    def run(*command, wait=10.0):
        try:
            result = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                    stderr=subprocess.STDOUT, text=True, errors='replace',
                                    timeout=wait, check=False)
            return Answer(result.returncode, result.stdout.strip())
        except FileNotFoundError:
            return Answer(None, '')
        except (OSError, subprocess.TimeoutExpired) as error:
            return Answer(-1, str(error))

    def program(self, name):
        """@returns the path of one of the package, as rosrun finds it, or None"""
        places = [pathlib.Path(prefix) / 'lib' / 'haptex'
                  for prefix in self.environment.get('CMAKE_PREFIX_PATH', '').split(':') if prefix]
        places += [self.root, self.root.parent / 'bin']
        return next((str(place / name) for place in places if os.access(place / name, os.X_OK)), None)

    def groups(self, configured):
        """Names of the groups of this process, or, configured, those that a new login would have."""
        if configured:
            numbers = os.getgrouplist(self.user, pwd.getpwnam(self.user).pw_gid)
        else:
            numbers = os.getgroups() + [os.getegid()]
        return {self.group_name(number) for number in numbers}

    @staticmethod
    def group_name(number):
        try:
            return grp.getgrgid(number).gr_name
        except KeyError:
            return str(number)

    # What the kernel lets it do

    @staticmethod
    def limit(name):
        """That holds now; None: unlimited."""
        soft = resource.getrlimit(LIMITS[name])[0]
        return None if soft == resource.RLIM_INFINITY else soft

    @staticmethod
    def fifo_granted(priority):
        return fifo_granted(priority)

    @staticmethod
    def processors():
        return len(os.sched_getaffinity(0))

    @staticmethod
    def steal(duration):
        """Share of the processors' time in the next seconds that the host gave to others."""
        begin, before = time.monotonic(), read_steal()
        time.sleep(duration)
        elapsed = time.monotonic() - begin
        return (read_steal() - before) / (elapsed * (os.cpu_count() or 1))

    # Serial ports and processes

    def port(self, path):
        """None if there is none."""
        try:
            status = os.stat(path)
        except OSError:
            return None
        return Port(stat.S_ISCHR(status.st_mode), os.access(path, os.R_OK | os.W_OK),
                    self.group_name(status.st_gid), stat.S_IMODE(status.st_mode))

    @staticmethod
    def processes():
        """Those that may be looked into have an environment."""
        found = []
        for folder in glob.glob('/proc/[0-9]*'):
            try:
                program = pathlib.Path(folder, 'cmdline').read_bytes().split(b'\0')[0]
            except OSError:
                continue  # it has ended
            try:
                words = pathlib.Path(folder, 'environ').read_bytes().decode(errors='replace')
            except OSError:
                words = ''
            environment = dict(word.split('=', 1) for word in words.split('\0') if '=' in word)
            name = os.path.basename(program.decode(errors='replace'))
            found.append(Process(int(os.path.basename(folder)), name, environment))
        return found

    def holders(self, path):
        """Processes that have a file open, as far as they may be looked into."""
        real, found = os.path.realpath(path), []
        for process in self.processes():
            for entry in glob.glob(f'/proc/{process.number}/fd/*'):
                try:
                    if os.readlink(entry) == real and process.number != os.getpid():
                        found.append(process)
                        break
                except OSError:
                    pass
        return found

    # The network

    @staticmethod
    def addresses(name):
        """IPv4 addresses, which ROS 1 uses; none if it does not resolve."""
        try:
            answers = socket.getaddrinfo(name, None, socket.AF_INET, socket.SOCK_STREAM)
        except (OSError, UnicodeError):
            return []
        return sorted({address[0] for *_, address in answers})

    @staticmethod
    def is_own(address):
        with socket.socket() as probe:
            try:
                probe.bind((address, 0))
                return True
            except OSError:
                return False

    @staticmethod
    def address_towards(host):
        """This machine's, as seen from there, or None."""
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.connect((host, 9))  # sends nothing
                return probe.getsockname()[0]
            except OSError:
                return None

    @staticmethod
    def answers(host, port):
        try:
            socket.create_connection((host, port), PATIENCE).close()
            return True
        except OSError:
            return False

    def reaches_itself(self, name):
        """Whether a connection to one of its own ports comes about by that name."""
        with socket.socket() as listener:
            listener.bind(('', 0))
            listener.listen()
            return self.answers(name, listener.getsockname()[1])

