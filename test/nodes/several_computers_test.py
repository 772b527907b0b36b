#!/usr/bin/python3
"""The cloth runs on one computer, hand and forces on another: two network namespaces, for which the
test needs root."""
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import rostest
from ros_fixtures import eventually
from two_computers import ADDRESSES, TwoComputers

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCTOR = ROOT / 'scripts/doctor'
FELT = r',(0\.[1-9]|[1-9])'  # 0.1 N or more, as a column of CSV
AHEAD = 0.05  # s, of a clock that is wrong


def words(text):
    """Without the spaces of columns."""
    return re.sub(' +', ' ', text)


class SeveralComputers(unittest.TestCase):
    trouble = ''  # why there are no two computers

    @classmethod
    def setUpClass(cls):
        folder = tempfile.mkdtemp(prefix='haptex_computers_')
        try:
            cls.computers = TwoComputers(folder)
        except (OSError, subprocess.CalledProcessError) as error:
            reason = getattr(error, 'stdout', None) or error
            cls.trouble = f'no network namespaces here: {reason}'
            return
        cls.addClassCleanup(cls.computers.close)
        # With the fabrics that scenes name.
        shutil.copytree(ROOT / 'config', pathlib.Path(folder) / 'config')
        cls.scenes = pathlib.Path(folder) / 'config/scenes'
        cls.scene = cls.scenes / 'wool_sample.yaml'
        # As docs/nodes.md has it.
        cls.computers.start('cloth', 'roslaunch', 'haptex', 'cloth.launch', 'quality:=scene',
                            'budget_ms:=10', 'recorder:=false', f'scene:={cls.scene}')
        cls.computers.start('hand', 'roslaunch', '--wait', 'haptex', 'haptex.launch', 'cloth:=false',
                            f'scene:={cls.scene}', f'path:={ROOT}/test/nodes/hold_edge.yaml')

    def setUp(self):
        if self.trouble:
            self.skipTest(self.trouble)

    def examined(self, **options):
        text, status = self.computers.run('hand', DOCTOR, **options)
        return words(text), status

    def await_text(self, name, command, text):
        """Runs it again and again until it prints the text, a regular expression; lines that YAML has
        broken are whole."""
        printed = []

        def is_there():
            printed.append(re.sub(r'\\\n *\\?', '', self.computers.run(name, *command)[0]))
            return re.search(text, printed[-1])

        eventually(is_there, lambda: f'{text!r} of {command}: {printed[-1]}\n{self.computers.logs()}', 180.0)

    def test_1_the_hand_feels_the_cloth_of_the_other_computer(self):
        self.await_text('hand', ('rostopic', 'echo', '-p', '-n', '100', '/haptex/index/contact/normal_force'),
                        FELT)

    def test_2_queries_are_answered_across(self):
        self.await_text('hand', ('rosservice', 'call', '/haptex/proximity/query',
                                 '{header: {frame_id: world}, shape: 0, points: [{x: 0.01, z: -0.1}], '
                                 'distance: 0.1, nearest: 1}'), 'success: True')

    def test_3_the_doctor_finds_names_scene_and_clock_good(self):
        text, status = self.examined()
        self.assertEqual(status, 0, text)
        self.assertRegex(text, f'ok network the ROS_IP \'{ADDRESSES["hand"]}\' leads to .* answers there')
        self.assertRegex(text, f'ok scene {self.scene} .*/haptex/force_renderer/scene')
        self.assertRegex(text, f'clock the clock of {ADDRESSES["cloth"]} is .* ms are allowed')

    def test_4_a_scene_that_lies_on_one_computer_only_is_told(self):
        text, status = self.examined(without=self.scenes)
        self.assertEqual(status, 1, text)
        self.assertRegex(text, f'error scene {self.scene} .*is not on this machine')
        text, status = self.computers.run('hand', 'rosrun', 'haptex', 'force_renderer', '__ns:=another',
                                          f'_scene:={self.scene}', without=self.scenes)
        self.assertNotEqual(status, 0, text)
        self.assertIn(f"parameter /another/force_renderer/scene: there is no file '{self.scene}'", text)

    def test_5_a_clock_that_is_ahead_is_told_by_the_doctor_and_by_who_drops_what_comes_from_there(self):
        self.computers.start('cloth', ROOT / 'test/nodes/clock_ahead.py', AHEAD)
        self.await_text('hand', (DOCTOR,), rf'error +clock +the clock of {ADDRESSES["cloth"]} is '
                        r'\d\d\.\d ms ahead: stamps beyond 20 ms are dropped')
        self.await_text('hand', ('rostopic', 'echo', '-n', '20', '/diagnostics'),
                        r'header\.stamp is -\d+(\.\d+)? ms before the clock here: allowed are -20')


if __name__ == '__main__':
    rostest.rosrun('haptex', 'several_computers', SeveralComputers)
