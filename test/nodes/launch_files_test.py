#!/usr/bin/python3
"""What the launch files and views promise, read without a master."""
import pathlib
import re
import textwrap
import unittest

import roslaunch.config
import roslaunch.xmlloader
import rostest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def loaded(name, *arguments):
    """@returns the parameters and, by full name, the nodes of a launch file"""
    config = roslaunch.config.load_config_default([(str(ROOT / 'launch' / name), list(arguments))], None,
                                                  assign_machines=False)
    return ({name: parameter.value for name, parameter in config.params.items()},
            {node.namespace + node.name: node for node in config.nodes})


def loaded_text(text):
    """@returns the nodes of a launch file that is given by its text, by full name"""
    config = roslaunch.config.ROSLaunchConfig()
    roslaunch.xmlloader.XmlLoader().load_string(text, config, verbose=False)
    return {node.namespace + node.name: node for node in config.nodes}


class LaunchFiles(unittest.TestCase):
    def test_handles_are_there_where_a_resting_hand_is_drawn(self):
        name = '/haptex/exoskeleton_emulator/markers'
        for launch in ('exoskeleton.launch', 'haptex.launch'):
            for arguments, markers in ((['rviz:=true', 'path:=rest'], True), (['rviz:=true'], False),
                                       (['path:=rest'], False), (['markers:=true'], True)):
                self.assertEqual(loaded(launch, *arguments)[0][name], markers, (launch, arguments))

    def test_no_name_is_of_one_namespace_only(self):
        installed = [ROOT / 'scripts' / name for name in ('demo_report', 'bag_report')]
        for folder in (ROOT / 'launch', ROOT / 'rviz', *installed):
            for path in filter(pathlib.Path.is_file, folder.iterdir()):
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

    def test_documented_launch_files_start_what_they_say_where_they_say(self):
        text = (ROOT / 'docs/nodes.md').read_text('utf-8')
        hands, computers = map(textwrap.dedent, re.findall(r'^    <launch>\n.*?^    </launch>\n', text,
                                                           re.MULTILINE | re.DOTALL))
        nodes = loaded_text(hands)
        for hand in ('left', 'right'):
            self.assertIn(f'/{hand}/haptex/force_renderer', nodes)
        nodes = loaded_text(computers)
        for name, machine in (('cloth_simulation', 'cloth'), ('proximity', 'cloth'), ('force_renderer', 'hand'),
                              ('exoskeleton_driver', 'hand')):
            self.assertEqual(nodes[f'/haptex/{name}'].machine_name, machine, name)

    def test_the_hand_alone_has_no_cloth(self):
        nodes = loaded('haptex.launch', 'cloth:=false')[1]
        self.assertIn('/haptex/force_renderer', nodes)
        self.assertNotIn('/haptex/cloth_simulation', nodes)
        self.assertNotIn('/haptex/proximity', nodes)


if __name__ == '__main__':
    rostest.rosrun('haptex', 'launch_files', LaunchFiles)
