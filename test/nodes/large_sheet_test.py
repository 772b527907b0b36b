#!/usr/bin/python3
"""Sheets in parts: the same whatever the number of processes, and what is refused."""
import os
import pathlib
import subprocess
import sys

import numpy as np
import roslib.packages
import rostest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'test' / 'nodes'))
from unit_fixtures import Folder, suite_of  # noqa: E402

# Lies flat, is held along two edges, and is blown at.
SCENE = f'''
fabric: {ROOT}/config/fabrics/wool.yaml
sheet: {{size: [0.1, 0.2], cells: [2, 4], diagonals: alternating, rpy: [0, -1.5707963, 0]}}
attach: [top, left]
model: [gravity, viscosity, bending, bending_hysteresis, air, wind]
wind: {{velocity: [1, 2, 0.5]}}
time_step: 0.01
'''
EDGE = 0.01  # m


def program():
    return roslib.packages.find_node('haptex', 'large_sheet')[0]


class LargeSheet(Folder):
    def run_sheet(self, processes, *arguments):
        environment = dict(os.environ, OPENBLAS_NUM_THREADS='1', OMPI_ALLOW_RUN_AS_ROOT='1',
                           OMPI_ALLOW_RUN_AS_ROOT_CONFIRM='1')
        return subprocess.run(['mpirun', '--oversubscribe', '-n', str(processes), program(), *arguments],
                              env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)

    def scene(self, text=SCENE):
        path = self.folder / 'scene.yaml'
        path.write_text(text, encoding='utf-8')
        return str(path)

    def test_any_number_of_processes_takes_it_to_the_same_place(self):
        results = []
        for processes in (1, 2, 5):
            path = self.folder / f'{processes}.obj'
            answer = self.run_sheet(processes, self.scene(), '--edge', str(EDGE), '--seconds', '0.1',
                                    '--out', str(path))
            self.assertEqual(answer.returncode, 0, answer.stderr)
            table = np.array([line.split('\t') for line in answer.stdout.splitlines()[2:]], float)
            lines = path.read_text(encoding='utf-8').splitlines()
            positions = np.array([line.split()[1:] for line in lines if line.startswith('v ')], float)
            results.append((table, positions, [line for line in lines if not line.startswith('v ')]))
        (first, positions, others), *more = results
        self.assertEqual(len(first), 10)
        self.assertEqual(positions.shape, (11 * 21, 3))
        self.assertEqual(sum(line.startswith('f ') for line in others), 2 * 10 * 20)
        self.assertLess(positions[:, 2].min(), -0.005)  # m: it fell
        for table, places, rest in more:
            np.testing.assert_allclose(places, positions, rtol=0.0, atol=1e-9)
            np.testing.assert_allclose(table[:, [0, 4, 5, 6]], first[:, [0, 4, 5, 6]], rtol=1e-6, atol=1e-12)
            self.assertEqual(rest, others)

    def refusal(self, status, *arguments, scene=SCENE):
        answer = self.run_sheet(2, self.scene(scene), *arguments)
        self.assertEqual(answer.returncode, status)
        self.assertEqual(answer.stdout, '')
        return answer.stderr

    def test_bad_arguments_are_refused_once_with_what_is_allowed(self):
        self.assertIn('--edge is missing: it is needed', self.refusal(2))
        self.assertIn("--edge is 'nan': allowed are numbers greater than 0", self.refusal(2, '--edge', 'nan'))
        told = self.refusal(2, '--edge', '0.01', '--step', '-1')
        self.assertEqual(told.count("--step is '-1': allowed are numbers greater than 0"), 1)
        self.assertIn('its cloth collides; allowed is a sheet that is held by its sides and moves in the air',
                      self.refusal(2, '--edge', '0.01', scene=SCENE.replace('[gravity,', '[gravity, self_collision,')))

    def test_processes_without_a_row_are_refused(self):
        answer = self.run_sheet(4, self.scene(), '--edge', '0.1')
        self.assertNotEqual(answer.returncode, 0)
        self.assertIn('the sheet has 3 rows of particles for 4 processes: each needs one', answer.stderr)

    def test_a_file_that_cannot_be_written_is_told_before_anything_moves(self):
        answer = self.run_sheet(2, self.scene(), '--edge', '0.01', '--out', str(self.folder / 'none' / 'a.obj'))
        self.assertNotEqual(answer.returncode, 0)
        self.assertIn('cannot write to', answer.stderr)
        self.assertNotIn('time_s', answer.stdout)


Tests = suite_of(LargeSheet)

if __name__ == '__main__':
    rostest.rosrun('haptex', 'large_sheet', f'{__name__}.Tests')
