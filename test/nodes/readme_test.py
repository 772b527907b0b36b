#!/usr/bin/python3
"""Every command of README.md, as it stands there: each launch in its order, with the commands that
need a graph, then those that need none. What is not run here is listed with the reason, so that a
new command of another kind fails."""
import os
import pathlib
import re
import shlex
import signal
import socket
import subprocess
import tempfile
import time
import unittest

import rostest
from readme_commands import commands_of
from ros_fixtures import eventually

ROOT = pathlib.Path(__file__).resolve().parents[2]
COMMANDS = commands_of((ROOT / 'README.md').read_text('utf-8'))
WAIT = 300.0  # s, for what a command does; more than any takes on a busy machine
RECORDING = 3.0  # s

# What stands for something of the reader's own.
EXAMPLES = {'/path/to/scene.yaml': str(ROOT / 'config/scenes/wool_in_wind.yaml'), 'NAME': 'denim',
            'CSV': str(ROOT / 'config/readings/wool_readings.csv'),
            'PATTERN.json': str(ROOT / 'test/garment/patterns/shirt_mean_specification.json'),
            'GARMENT.yaml': str(ROOT / 'config/garments/fitted_shirt.yaml'),
            'BODY.yaml': str(ROOT / 'config/bodies/woman.yaml')}

CLOTH = 'roslaunch haptex cloth.launch quality:=balanced'
TOUCH = 'roslaunch haptex haptex.launch path:=demo'
# In which graph the commands of a section run; of others in that of the launch before them.
GRAPHS = {'Query': CLOTH, 'Add a fabric': CLOTH, 'Inspect': TOUCH, 'Record': TOUCH}

INSTALLS = 'installs packages and builds'
MEASURES = 'measures for minutes to half an hour; its figures are in docs/results'
# Who else runs them, or why nobody does.
ELSEWHERE = {
    'scripts/test': 'runs this test',
    'scripts/demo': f'{INSTALLS}; demo_judgement.test and launch_files.test look at its parts',
    'scripts/demo rviz:=true': INSTALLS,
    'catkin_make -DPYTHON_EXECUTABLE=/usr/bin/python3': 'builds in a workspace of the reader',
    'export ROS_IP=127.0.0.1': 'scripts/test sets it for all tests',
    'scripts/rviz_screenshot': f'{INSTALLS}; readme.test opens the same view',
    'scripts/evaluate': f'{INSTALLS}; machine_rater.test looks at its parts',
    'rosrun haptex drape_garment SHIRT.yaml worn.obj --body BODY.obj --edge 0.03':
        'takes minutes; test_dressing drapes',
    'scripts/validate': 'test_oracles makes the same checks',
    'scripts/validate --seed S': 'test_oracles makes the same checks',
    'scripts/validate contact': 'test_oracles makes the same checks',
    'scripts/validate cloth': 'test_oracles makes the same checks',
    'scripts/validate exoskeleton': 'test_oracles makes the same checks',
    **{f'scripts/bench {name}': MEASURES for name in ('cloth_step', 'folded', 'locking', 'loop', 'stability')},
}


def runs_elsewhere(command):
    return command.text in ELSEWHERE


def is_launch(command):
    return command.text.startswith('roslaunch ')


def needs_graph(command):
    return command.text.startswith(('rostopic ', 'rosservice ', 'rosrun haptex record_topics '))


def needs_nothing(command):
    return (command.text.startswith(('rosrun haptex ', 'source '))
            and not needs_graph(command) and not runs_elsewhere(command))


def plan():
    """@returns the commands of each launch, by its text"""
    graphs, latest = {}, None
    for command in COMMANDS:
        if is_launch(command):
            latest = command.text
            graphs[latest] = []
    for command in COMMANDS:
        latest = command.text if is_launch(command) else latest
        if needs_graph(command):
            graphs[GRAPHS.get(command.section, latest)].append(command.text)
    return graphs


def filled(text):
    for word, value in EXAMPLES.items():
        text = re.sub(rf'(?<![\w/]){re.escape(word)}(?!\w)', value, text)
    return text


class Shell:
    """A reader's: in a folder with what the README names, with a display and a master's port."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        (self.folder / 'build').symlink_to(ROOT / 'build')
        with socket.socket() as probe:
            probe.bind(('', 0))
            port = probe.getsockname()[1]
        reader, writer = os.pipe()
        self.display = subprocess.Popen(['Xvfb', '-displayfd', str(writer), '-noreset', '-screen', '0', '800x600x24'],
                                        pass_fds=[writer], stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        os.close(writer)
        with os.fdopen(reader) as file:
            number = file.readline().strip()
        self.environment = dict(os.environ, HOME=folder, DISPLAY=f':{number}', LIBGL_ALWAYS_SOFTWARE='1',
                                ROS_MASTER_URI=f'http://127.0.0.1:{port}', ROS_IP='127.0.0.1')
        for variable in ('ROS_HOME', 'ROS_LOG_DIR', 'ROS_HOSTNAME', 'ROS_NAMESPACE'):
            self.environment.pop(variable, None)

    def start(self, text, output):
        return subprocess.Popen(['bash', '-c', filled(text)], cwd=self.folder, env=self.environment,
                                stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT,
                                start_new_session=True, text=True)

    def run(self, text, wait=WAIT):
        """@returns what it prints, and its exit status"""
        process = self.start(text, subprocess.PIPE)
        try:
            output, _ = process.communicate(timeout=wait)
        except subprocess.TimeoutExpired:
            self.interrupt(process)
            output, _ = process.communicate()
        return output, process.returncode

    def first_output(self, text):
        """Of a command that goes on until Ctrl-C."""
        path = self.folder / 'output.log'
        with open(path, 'w', encoding='utf-8') as file:
            process = self.start(text, file)
        try:
            eventually(lambda: path.stat().st_size > 0 or process.poll() is not None,
                       f'output of {text}', WAIT)
        finally:
            self.interrupt(process)
        return path.read_text('utf-8')

    @staticmethod
    def interrupt(process):
        """As Ctrl-C does: the whole group."""
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGINT)
        try:
            process.wait(WAIT)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()

    def close(self):
        self.display.terminate()
        self.display.wait()


class Graph:
    """That a launch of the README has started."""

    def __init__(self, shell, text):
        self.shell, self.text = shell, text
        self.arguments = dict(word.split(':=', 1) for word in shlex.split(text) if ':=' in word)
        self.log = shell.folder / 'launch.log'
        with open(self.log, 'w', encoding='utf-8') as file:
            self.process = shell.start(text, file)

    def output(self):
        return self.log.read_text('utf-8', errors='replace')

    def shows(self, command, text):
        """Waits until a command prints the text, a regular expression."""
        printed = []

        def does():
            if self.process.poll() is not None:
                raise AssertionError(f'{self.text} has ended:\n{self.output()[-4000:]}')
            printed.append(self.shell.run(command, 10.0)[0])
            return re.search(text, printed[-1])

        eventually(does, lambda: f'{text!r} of {command}: {printed[-1:]}\n{self.output()[-4000:]}', WAIT)

    def await_work(self):
        """That the launch does what the README says of it."""
        if 'exoskeleton.launch' in self.text:
            self.shows('rostopic echo -n 1 /haptex/exoskeleton/operating_state', 'state: "?ENABLED')
        elif 'port' in self.arguments:  # of a device that is not here
            self.shows('rostopic echo -n 20 /diagnostics', re.escape(self.arguments['port']))
        elif 'haptex.launch' in self.text:
            self.shows('rostopic echo -n 1 /haptex/index/contact', 'normal_force')
        if 'cloth.launch' in self.text or 'haptex.launch' in self.text:
            self.shows('rostopic echo -n 1 --noarr /haptex/cloth/state', 'step: ')
        if 'tracker' in self.arguments:
            self.shows(f'rostopic info {self.arguments["tracker"]}', '/haptex/hand_tracker')
        if 'tactile_port' in self.arguments:
            self.shows('rostopic echo -n 1 /haptex/tactile/array_state', 'connected: True')
        if self.arguments.get('shared') == 'true':
            self.shows('rosnode list', '/haptex/haptics')
        if self.arguments.get('rviz') == 'true':
            self.shows('xwininfo -root -tree', '(?i)rviz')

    def end(self):
        """@returns the exit status after Ctrl-C"""
        died = set(re.findall(r'\[(\S+)-\d+\] process has died', self.output()))
        if 'port' in self.arguments:
            died -= {'haptex/enable_exoskeleton'}  # which has waited for the device long enough
        assert not died, f'{died}: {self.output()[-4000:]}'
        self.shell.interrupt(self.process)
        return self.process.returncode


class Readme(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix='haptex_readme_')
        cls.addClassCleanup(folder.cleanup)
        cls.shell = Shell(folder.name)
        cls.addClassCleanup(cls.shell.close)

    def test_1_every_command_is_run_or_listed_with_a_reason(self):
        for command in COMMANDS:
            kinds = [kind.__name__ for kind in (runs_elsewhere, is_launch, needs_graph, needs_nothing)
                     if kind(command)]
            self.assertEqual(len(kinds), 1, f'{command} is of the kinds {kinds}')
        self.assertLessEqual(set(ELSEWHERE), {command.text for command in COMMANDS}, 'listed, not there')

    def test_1_what_runs_elsewhere_is_there(self):
        for text in ELSEWHERE:
            program, *arguments = shlex.split(text)
            if program.startswith('scripts/'):
                self.assertTrue(os.access(ROOT / program, os.X_OK), program)
            if program == 'scripts/bench':
                self.assertTrue(list((ROOT / 'bench').glob(f'*/{arguments[0]}.cpp')) or
                                (ROOT / 'bench' / arguments[0]).exists(), text)

    def run_in_graph(self, text):
        if text.startswith('rosrun haptex record_topics'):
            recorder = self.shell.start(text, subprocess.DEVNULL)
            eventually((self.shell.folder / 'sample.bag.active').exists, text, WAIT)
            time.sleep(RECORDING)
            self.shell.interrupt(recorder)
            eventually((self.shell.folder / 'sample.bag').exists, text, WAIT)
        elif text.startswith('rostopic echo') and '-n' not in text:
            self.assertIn('header:', self.shell.first_output(text), text)
        elif text.startswith('rostopic echo'):
            output, status = self.shell.run(text)
            self.assertEqual(status, 0, f'{text}: {output}')
            self.assertIn('---', output, text)
        else:
            answers = []

            def succeeds():
                answers.append(self.shell.run(text))
                return answers[-1][1] == 0 and 'success: True' in answers[-1][0]

            eventually(succeeds, lambda: f'{text}: {answers[-1]}', WAIT)

    def run_launch(self, text, commands):
        graph = Graph(self.shell, text)
        self.addCleanup(self.shell.interrupt, graph.process)
        graph.await_work()
        for command in commands:
            self.run_in_graph(command)
        self.assertEqual(graph.end(), 0, graph.output()[-4000:])
        if 'sound' in graph.arguments:
            self.assertTrue((self.shell.folder / 'contactor.wav').exists(), text)

    def test_3_commands_that_need_no_graph(self):
        for command in filter(needs_nothing, COMMANDS):
            output, status = self.shell.run(command.text)
            self.assertEqual(status, 0, f'{command.text}: {output}')
        for file in ('denim.wav', 'rubbed.wav', 'sample.html', 'sample.png'):
            self.assertTrue((self.shell.folder / file).exists(), file)


def add_launch_tests():
    for number, (launch, commands) in enumerate(plan().items()):
        name = re.sub(r'\W+', '_', launch.replace('roslaunch haptex ', '')).strip('_')

        def test(self, launch=launch, commands=tuple(commands)):
            self.run_launch(launch, commands)

        setattr(Readme, f'test_2_{number:02}_{name}', test)


add_launch_tests()

if __name__ == '__main__':
    rostest.rosrun('haptex', 'readme', Readme)
