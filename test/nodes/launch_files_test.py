#!/usr/bin/python3
"""What the launch files and views promise, read without a master."""
import pathlib
import re
import unittest

import roslaunch.config
import rostest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def loaded(name, *arguments):
    """@returns the parameters and, by full name, the nodes of a launch file"""
    config = roslaunch.config.load_config_default([(str(ROOT / 'launch' / name), list(arguments))], None,
                                                  assign_machines=False)
    return ({name: parameter.value for name, parameter in config.params.items()},
            {node.namespace + node.name: node for node in config.nodes})


class LaunchFiles(unittest.TestCase):
    def test_handles_are_there_where_a_resting_hand_is_drawn(self):
        name = '/haptex/exoskeleton_emulator/markers'
        for launch in ('exoskeleton.launch', 'haptex.launch'):
            for arguments, markers in ((['rviz:=true', 'path:=rest'], True), (['rviz:=true'], False),
                                       (['path:=rest'], False), (['markers:=true'], True)):
                self.assertEqual(loaded(launch, *arguments)[0][name], markers, (launch, arguments))

    def test_no_name_is_of_one_namespace_only(self):
        for folder in ('launch', 'rviz'):
            for path in (ROOT / folder).iterdir():
                self.assertEqual(re.findall('[^)]/haptex/.*', path.read_text('utf-8')), [], path)

    def test_frames_of_a_fixed_hand_have_the_prefix(self):
        for arguments, frames in (([], 'world hand_base'),
                                  (['tf_prefix:=left'], 'left/world left/hand_base')):
            parameters, nodes = loaded('exoskeleton.launch', 'port:=/dev/ttyUSB0', *arguments)
            self.assertTrue(nodes['/haptex/hand_base'].args.endswith(f' {frames}'))
            self.assertEqual(f'{parameters["/haptex/tf_prefix"]}/'.lstrip('/') + 'world',
                             frames.split()[0])

    def test_rviz_gets_the_prefix_where_there_is_one(self):
        for launch in ('cloth.launch', 'exoskeleton.launch', 'haptex.launch', 'evaluation.launch'):
            for arguments, program in (([], 'rviz'), (['tf_prefix:=left'], 'rviz_with_prefix')):
                node = loaded(launch, 'rviz:=true', *arguments)[1]['/haptex/rviz']
                self.assertEqual(node.type, program)


if __name__ == '__main__':
    rostest.rosrun('haptex', 'launch_files', LaunchFiles)
