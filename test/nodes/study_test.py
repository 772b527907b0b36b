#!/usr/bin/python3
"""Studies in jobs: the same result however they are split, after they were killed, and by Slurm."""
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time
import unittest
import unittest.mock

import roslib.packages
import rostest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'test' / 'nodes'))
from unit_fixtures import Folder, suite_of  # noqa: E402

RUN = ROOT / 'scripts' / 'studies' / 'run_jobs.py'
SLURM = ROOT / 'scripts' / 'slurm_two_nodes'
CASES = 60
WAIT = 60.0  # s


def program():
    return roslib.packages.find_node('haptex', 'run_study')[0]


class Study(Folder):
    def command(self, name, *options, cases=CASES):
        return ['/usr/bin/python3', str(RUN), program(), str(self.folder), 'extremes', '--cases', str(cases),
                '--directory', str(self.folder / name), *options]

    def run_study(self, name, *options, environment=None, **more):
        return subprocess.run(self.command(name, *options, **more), env=dict(os.environ, **(environment or {})),
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)

    def merged(self, name):
        return (self.folder / name / 'extremes.txt').read_bytes()

    def files(self, name):
        return {path: path.stat().st_mtime_ns for path in (self.folder / name).glob('extremes_*_of_*.txt')}


class Local(Study):
    def test_the_result_is_the_same_for_1_2_and_7_jobs(self):
        answers = [self.run_study(f'split_{jobs}', '--jobs', str(jobs)) for jobs in (1, 2, 7)]
        for answer, jobs in zip(answers, (1, 2, 7)):
            self.assertEqual(answer.returncode, 0, answer.stderr)
            self.assertEqual(answer.stdout, answers[0].stdout)
            self.assertEqual(self.merged(f'split_{jobs}'), self.merged('split_1'))
            self.assertEqual(len(self.files(f'split_{jobs}')), jobs)
        self.assertIn('stability/failures\t0\tcases\n', answers[0].stdout)

    def test_a_study_that_was_killed_goes_on_where_it_was(self):
        self.assertEqual(self.run_study('whole', '--jobs', '1').returncode, 0)
        started = subprocess.Popen(self.command('killed', '--jobs', str(CASES)), stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, start_new_session=True)
        end = time.monotonic() + WAIT
        while len(self.files('killed')) < 3 and time.monotonic() < end:
            time.sleep(0.005)
        os.killpg(started.pid, signal.SIGKILL)
        started.wait()
        time.sleep(0.5)  # GNU parallel's jobs have sessions of their own; those end by themselves
        before = self.files('killed')
        self.assertGreaterEqual(len(before), 3)
        self.assertLess(len(before), CASES)
        answer = self.run_study('killed', '--jobs', str(CASES))
        self.assertEqual(answer.returncode, 0, answer.stderr)
        after = self.files('killed')
        self.assertEqual({path: after[path] for path in before}, before)
        self.assertEqual(self.merged('killed'), self.merged('whole'))

    def test_a_damaged_file_is_refused_by_name_and_computed_anew(self):
        self.assertEqual(self.run_study('damaged', '--jobs', '3').returncode, 0)
        sound = self.merged('damaged')
        path = self.folder / 'damaged' / 'extremes_2_of_3.txt'
        path.write_bytes(path.read_bytes().replace(b'\tnone\t', b'\tnone\t1', 1))
        merge = subprocess.run([program(), 'extremes', '--cases', str(CASES), '--jobs', '3', '--directory',
                                str(path.parent), '--merge', str(self.folder / 'out')],
                               stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual(merge.returncode, 1)
        self.assertIn(f'{path}: is damaged', merge.stderr)
        self.assertFalse((self.folder / 'out').exists())
        answer = self.run_study('damaged', '--jobs', '3')
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertIn('is damaged', answer.stderr)
        self.assertEqual(self.merged('damaged'), sound)

    def test_other_cases_in_the_same_directory_are_computed_anew(self):
        self.assertEqual(self.run_study('again', '--jobs', '2').returncode, 0)
        answer = self.run_study('again', '--jobs', '2', '--seed', '100')
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertIn("input seed is '1' and '100': computed anew", answer.stderr)
        self.assertIn(b'\ninput seed 100\n', self.merged('again'))

    def test_a_study_with_few_units_has_a_job_for_each(self):
        answer = self.run_study('few', cases=5)
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertEqual({path.name for path in self.files('few')}, {f'extremes_{job}_of_5.txt' for job in range(1, 6)})
        answer = self.run_study('none', cases=0)
        self.assertEqual(answer.returncode, 2)
        self.assertIn("--cases is '0': allowed are whole numbers from 1 on", answer.stderr)
        self.assertEqual(self.files('none'), {})

    def test_units_of_the_evaluation_are_those_of_its_rater(self):
        answer = subprocess.run([program(), 'evaluation', '--cases', '3', '--seed', '5'], stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual(answer.returncode, 0, answer.stderr)
        fabrics = {path.stem for path in (ROOT / 'config' / 'fabrics').glob('*.yaml')} - {'linear'}
        self.assertIn(f'units\t{3 * len(fabrics)}\ncases\t3\nseed\t5\nfabrics\t', answer.stdout)
        for name in ('rater', 'libraries', 'processor', 'program', 'instructions'):
            self.assertIn(f'\n{name}\t', answer.stdout)

    def test_what_cannot_be_done_is_refused(self):
        for options, reason in ((('--jobs', '0'), "'0': allowed are 1 to 100000"), (('--workers', 'x'), "'x': allowed"),
                                (('--slurm', '--sshloginfile', 'x'), 'not allowed with')):
            answer = self.run_study('refused', *options)
            self.assertEqual(answer.returncode, 2)
            self.assertIn(reason, answer.stderr)
        answer = self.run_study('refused', '--jobs', str(CASES + 1))
        self.assertEqual(answer.returncode, 1)
        self.assertIn(f'jobs = {CASES + 1}: allowed are 1 to {CASES}', answer.stderr)


def can_have_its_own_files():
    """Whether a process may see other files than the rest, as one on another machine does."""
    return subprocess.run(['unshare', '--mount', 'true'], stderr=subprocess.DEVNULL, check=False).returncode == 0


@unittest.skipUnless(can_have_its_own_files(), 'mounting directories is not permitted')
class Remote(Study):
    def setUp(self):
        super().setUp()
        environment = unittest.mock.patch.dict(os.environ)  # a service has no SHELL
        environment.start()
        self.addCleanup(environment.stop)
        os.environ.pop('SHELL', None)

    def test_files_of_another_machine_are_fetched(self):
        directory, far = self.folder / 'remote', self.folder / 'far'
        for path in (directory, far):
            path.mkdir()
        # Stands for ssh: there the directory is another one. It is called with options, a host and a command.
        ssh = self.folder / 'ssh'
        ssh.write_text('#!/bin/bash\n'
                       'while [ "$1" != far ]; do shift; done; shift; [ "$1" != -- ] || shift\n'
                       f'exec unshare --mount bash -c "mount --bind {far} {directory} && cd && $*"\n', encoding='utf-8')
        ssh.chmod(0o755)
        logins = self.folder / 'logins'
        logins.write_text(f'2/{ssh} far\n', encoding='utf-8')
        self.assertEqual(self.run_study('whole', '--jobs', '1', cases=8).returncode, 0)
        answer = self.run_study('remote', '--jobs', '3', '--sshloginfile', str(logins), cases=8)
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertEqual(self.merged('remote'), self.merged('whole'))
        self.assertEqual({path.name for path in far.iterdir()}, {path.name for path in self.files('remote')})


@unittest.skipUnless(shutil.which('slurmctld', path=os.environ['PATH'] + ':/usr/sbin'),
                     'Slurm is not installed: scripts/packages_slurm.txt')
class Slurm(Study):
    def setUp(self):
        super().setUp()
        self.cluster = self.folder / 'cluster'
        answer = subprocess.run([str(SLURM), 'start', str(self.cluster)], stdout=subprocess.PIPE, text=True, check=False)
        self.addCleanup(subprocess.run, [str(SLURM), 'stop', str(self.cluster)], check=False)
        self.assertEqual(answer.returncode, 0)
        self.environment = {'SLURM_CONF': re.fullmatch('export SLURM_CONF=(.*)\n', answer.stdout)[1]}

    def test_two_nodes_compute_what_one_process_does_and_go_on_after_a_cancelled_job(self):
        self.assertEqual(self.run_study('whole', '--jobs', '1').returncode, 0)
        started = subprocess.Popen(self.command('slurm', '--jobs', '20', '--slurm'), stderr=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, env=dict(os.environ, **self.environment))
        end = time.monotonic() + WAIT
        while len(self.files('slurm')) < 3 and time.monotonic() < end:
            time.sleep(0.01)
        started.send_signal(signal.SIGINT)
        started.wait(WAIT)
        before = self.files('slurm')
        self.assertGreaterEqual(len(before), 3)
        answer = self.run_study('slurm', '--jobs', '20', '--slurm', environment=self.environment)
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertEqual(self.merged('slurm'), self.merged('whole'))
        after = self.files('slurm')
        self.assertEqual({path: after[path] for path in before}, before)
        log = (self.cluster / 'slurmctld.log').read_text(encoding='utf-8')
        for node in ('one', 'two'):
            self.assertIn(f'NodeList={node}', log)


Tests = suite_of(Local, Remote, Slurm)

if __name__ == '__main__':
    rostest.rosrun('haptex', 'study', f'{__name__}.Tests')
