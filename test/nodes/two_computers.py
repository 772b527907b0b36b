"""Two network namespaces joined by a virtual cable, each with processes of its own: as two computers
with the same files and the same clock."""
import os
import pathlib
import shutil
import signal
import subprocess

MASTER_PORT = 11311
# For benchmarks of networks, RFC 2544: nobody's.
ADDRESSES = {'cloth': '198.18.77.1', 'hand': '198.18.77.2'}


def ip(*arguments):
    subprocess.run(['ip', *arguments], check=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                   text=True)


class TwoComputers:
    """The master's URI leads to 'cloth'. @throws OSError or subprocess.CalledProcessError if this
    user or this kernel cannot make them"""

    def __init__(self, folder):
        """@param folder for logs and ROS's home directories"""
        self.folder, self.processes, self.made = pathlib.Path(folder), [], []
        self.cable = {}  # the network device of each
        try:
            for name in ADDRESSES:
                ip('netns', 'add', self.space(name))
                self.made.append(self.space(name))
            self.cable = {name: f'hx{name[0]}{os.getpid()}' for name in ADDRESSES}
            first, second = self.cable.values()
            ip('link', 'add', first, 'type', 'veth', 'peer', 'name', second)
            for name, address in ADDRESSES.items():
                end = self.cable[name]
                ip('link', 'set', end, 'netns', self.space(name))
                ip('-n', self.space(name), 'address', 'add', f'{address}/30', 'dev', end)
                for device in (end, 'lo'):
                    ip('-n', self.space(name), 'link', 'set', device, 'up')
        except (OSError, subprocess.CalledProcessError):
            self.close()
            raise

    @staticmethod
    def space(name):
        return f'haptex_{name}_{os.getpid()}'

    def command(self, name, words, without=None):
        """@param without path of a folder that is empty there"""
        hidden = []
        if without:
            empty = self.folder / 'empty'
            empty.mkdir(exist_ok=True)
            # In a space of mounts of its own, which `ip netns exec` makes.
            hidden = ['sh', '-c', 'mount --bind "$0" "$1" && shift && exec "$@"', str(empty), str(without)]
        return ['ip', 'netns', 'exec', self.space(name), *hidden, *map(str, words)]

    def environment(self, name):
        home = self.folder / name
        home.mkdir(exist_ok=True)
        return dict(os.environ, ROS_MASTER_URI=f'http://{ADDRESSES["cloth"]}:{MASTER_PORT}',
                    ROS_IP=ADDRESSES[name], ROS_HOME=str(home), ROS_LOG_DIR=str(home))

    def start(self, name, *words):
        """A process that goes on until close(). @returns it; its output is in a log"""
        log = self.folder / f'{len(self.processes)}.log'
        with open(log, 'w', encoding='utf-8') as file:
            process = subprocess.Popen(self.command(name, words), env=self.environment(name),
                                       stdout=file, stderr=subprocess.STDOUT, start_new_session=True)
        process.log = log
        self.processes.append(process)
        return process

    def run(self, name, *words, without=None, wait=60.0):
        """@returns what it prints, and its exit status: 124 if it has not ended by itself"""
        result = subprocess.run(['timeout', '-s', 'INT', '-k', '5', str(wait),
                                 *self.command(name, words, without)], env=self.environment(name),
                                check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        return result.stdout, result.returncode

    def logs(self):
        return '\n'.join(f'== {" ".join(process.args[4:])}\n' +
                         process.log.read_text('utf-8', errors='replace')[-3000:]
                         for process in self.processes)

    def close(self):
        for process in reversed(self.processes):
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGINT)
        for process in reversed(self.processes):
            try:
                process.wait(20.0)
            except subprocess.TimeoutExpired:
                pass
        for space in self.made:
            # roslaunch starts nodes in sessions of their own: what is left of them.
            left = subprocess.run(['ip', 'netns', 'pids', space], check=False, stdout=subprocess.PIPE,
                                  text=True).stdout.split()
            for number in left:
                os.kill(int(number), signal.SIGKILL)
            subprocess.run(['ip', 'netns', 'delete', space], check=False)
        shutil.rmtree(self.folder, ignore_errors=True)
