#!/usr/bin/python3
"""A node ends with an error that names what is wrong with its parameters or files."""
import os
import pathlib
import subprocess
import tempfile
import unittest

import roslib.packages
import rostest

# Of the emulator's port: a place where one could be made.
LINK = '_link:=' + os.path.join(tempfile.gettempdir(), 'haptex_refused')


class RefusedParameters(unittest.TestCase):
    runs = 0

    def refused(self, *parameters, says, node='cloth_simulation'):
        # A name of its own for each run: parameters of earlier runs stay on the server.
        RefusedParameters.runs += 1
        name = f'refused_{RefusedParameters.runs}'
        program = roslib.packages.find_node('haptex', node)[0]
        run = subprocess.run([program, f'__name:={name}', *parameters], capture_output=True,
                             text=True, timeout=30)
        self.assertEqual(run.returncode, 1, run.stderr)
        for text in says:
            self.assertIn(text.replace('~', f'/{name}/'), run.stderr)
        return run.stderr

    def test_missing_scene(self):
        self.refused(says=['~scene', 'is not set'])

    def test_scene_of_another_type(self):
        self.refused('_scene:=3', says=['~scene', 'is not set to a string'])

    def test_unknown_scene(self):
        self.refused('_scene:=velvet', says=["there is no 'velvet'", 'wool_sample'])

    def test_scene_path_without_a_file(self):
        self.refused('_scene:=/no/such.yaml', says=["there is no file '/no/such.yaml'"])

    def test_broken_scene_file(self):
        with tempfile.NamedTemporaryFile('w', suffix='.yaml') as scene:
            scene.write('fabric: [')
            scene.flush()
            self.refused(f'_scene:={scene.name}', says=[scene.name])

    def test_rates_and_scale_that_are_not_positive_numbers(self):
        for name in ('state_rate', 'marker_rate', 'strain_scale'):
            for value in ('0', '-1', 'many'):
                self.refused('_scene:=wool_sample', f'_{name}:={value}',
                             says=[f'~{name}'])

    def test_prefixes_of_frames_that_there_are_not(self):
        for value in ('/left', 'left/', 'a-b'):
            self.refused('_scene:=wool_sample', f'_tf_prefix:={value}',
                         says=[f"tf_prefix = '{value}'", 'allowed are letters, digits and _'])
        self.refused('_scene:=wool_sample', '_tf_prefix:=3', says=['~tf_prefix is not a string'])

    def test_files_of_another_kind_without_their_content(self):
        with open('/etc/passwd', encoding='utf-8') as file:
            words = [line.split(':')[-2] for line in file]  # home directories
        for parameter, node in (('scene', 'cloth_simulation'), ('scene', 'proximity'),
                                ('quality', 'cloth_simulation')):
            scene = [] if parameter == 'scene' else ['_scene:=wool_sample']
            errors = self.refused(*scene, f'_{parameter}:=/etc/passwd', node=node,
                                  says=['/etc/passwd: a text of', 'must be a map with the keys'])
            self.assertEqual([word for word in words if len(word) > 3 and word in errors], [])

    def test_colours_by_what_there_is_not(self):
        for value in ('weight', '3'):
            self.refused('_scene:=wool_sample', f'_colour_by:={value}',
                         says=['~colour_by', 'strain or fabric'])

    def test_qualities_and_budgets(self):
        scene = '_scene:=wool_sample'
        self.refused(scene, '_quality:=best', says=['~quality', "there is no 'best'", 'balanced'])
        self.refused(scene, '_quality:=3', says=['~quality', 'is not set to a string'])
        self.refused(scene, '_quality:=front', says=['front.yaml', 'allowed is a file with one'])
        for value in ('0', '-1', 'much'):
            self.refused(scene, f'_budget_ms:={value}', says=['~budget_ms'])

    def test_scenes_of_nodes_that_can_do_without(self):
        for node in ('proximity', 'tactile_renderer'):
            self.refused('_scene:=3', node=node, says=['~scene', 'is not set to a string'])
            self.refused('_scene:=velvet', node=node, says=["there is no 'velvet'"])
            with tempfile.NamedTemporaryFile('w', suffix='.yaml') as scene:
                scene.write('fabric: [')
                scene.flush()
                self.refused(f'_scene:={scene.name}', node=node, says=[scene.name])

    def test_proximity_ages_that_are_not_positive_numbers(self):
        for value in ('0', '-1', 'old'):
            self.refused(f'_stale_after:={value}', node='proximity', says=['~stale_after'])

    def test_proximity_volume_levels_that_there_are_not(self):
        for value in ('-3', '17', '1.5', 'all'):
            self.refused(f'_volume_level:={value}', node='proximity',
                         says=['~volume_level', 'allowed are whole numbers from -2 to 16'])

    def test_driver_ports(self):
        for port in ('_port:=', '_port:=3', '_rate:=1'):
            self.refused(port, node='exoskeleton_driver',
                         says=['~port', 'is not set to a string', '/dev/ttyUSB0'])

    def test_driver_robot_descriptions(self):
        self.refused('_port:=/dev/null', node='exoskeleton_driver',
                     says=['parameter robot_description is not set', 'URDF'])
        self.refused('_port:=/dev/null', '_robot_description:=3', node='exoskeleton_driver',
                     says=['~robot_description', 'is not a string'])
        self.refused('_port:=/dev/null', '_robot_description:=a robot',
                     node='exoskeleton_driver', says=['~robot_description'])

    def refused_emulator(self, *parameters, says):
        package = roslib.packages.get_pkg_dir('haptex')
        description = pathlib.Path(package, 'urdf', 'hand_exoskeleton.urdf').read_text()
        self.refused(f'_robot_description:={description}', *parameters,
                     node='exoskeleton_emulator', says=says)

    def test_emulator_links(self):
        for link in ('_link:=', '_link:=3', '_rate:=1'):
            self.refused_emulator(link, says=['~link', 'is not set to a string'])
        self.refused_emulator('_link:=/no/such/folder/link', says=['/no/such/folder/link'])
        with tempfile.NamedTemporaryFile('w') as file:
            self.refused_emulator(f'_link:={file.name}', says=[file.name])

    def test_emulator_robot_descriptions(self):
        self.refused(LINK, node='exoskeleton_emulator',
                     says=['parameter robot_description is not set', 'URDF'])
        self.refused(LINK, '_robot_description:=a robot',
                     node='exoskeleton_emulator', says=['~robot_description'])

    def test_emulator_paths(self):
        self.refused_emulator(LINK, '_path:=3', says=['~path', 'is not set to a string'])
        self.refused_emulator(LINK, '_path:=dance', says=['~path', "there is no 'dance'", 'pinch'])
        with tempfile.NamedTemporaryFile('w', suffix='.yaml') as path:
            path.write('key_frames: [')
            path.flush()
            self.refused_emulator(LINK, f'_path:={path.name}', says=[path.name])

    def test_emulator_markers_that_are_neither_true_nor_false(self):
        self.refused_emulator(LINK, '_markers:=many',
                              says=['~markers', 'true or false'])

    def test_renderer_scenes(self):
        self.refused(node='force_renderer', says=['~scene', 'is not set'])
        self.refused('_scene:=velvet', node='force_renderer', says=["there is no 'velvet'"])

    def test_scenes_that_do_not_list_what_a_node_is_there_for(self):
        for node, scene, effect in (('force_renderer', 'linear_sheet', 'fingers'),
                                    ('tactile_renderer', 'acrylic_knit_sample', 'tactile')):
            self.refused(f'_scene:={scene}', node=node,
                         says=[f'{scene}.yaml', f'does not list {effect}', node])

    def test_scene_whose_fabric_lacks_what_it_lists(self):
        shipped = pathlib.Path(roslib.packages.get_pkg_dir('haptex'), 'config')
        text = (shipped / 'scenes' / 'wool_sample.yaml').read_text()
        with tempfile.NamedTemporaryFile('w', suffix='.yaml') as scene:
            scene.write(text.replace('fabric: wool', f'fabric: {shipped}/fabrics/linear.yaml'))
            scene.flush()
            self.refused(f'_scene:={scene.name}',
                         says=[scene.name, 'lists tactile', "fabric 'linear' has no surface"])

    def test_renderer_radii_that_no_fingertip_has(self):
        for name in ('index_radius', 'thumb_radius'):
            for value in ('0', '-1', 'thick', '0.2'):
                self.refused('_scene:=wool_sample', f'_{name}:={value}', node='force_renderer',
                             says=[f'~{name}'])

    def test_fingers_that_nobody_has(self):
        for value in ('ring', '3'):
            self.refused('_scene:=wool_sample', f'_fingers:={value}', node='force_renderer',
                         says=['fingers', 'allowed are both, index and thumb'])

    def test_tactile_limits_that_no_array_has(self):
        for name in ('lowest_frequency', 'highest_frequency', 'largest_displacement'):
            for value in ('0', '-1', 'many'):
                self.refused(f'_{name}:={value}', node='tactile_renderer', says=[f'~{name}'])
        self.refused('_lowest_frequency:=300', '_highest_frequency:=100', node='tactile_renderer',
                     says=['~highest_frequency', '100', 'above the lowest'])

    def test_ports_of_the_contactors(self):
        for port in ('_port:=', '_port:=3', '_rate:=1'):
            self.refused(port, node='tactile_driver',
                         says=['~port', 'is not set to a string', '/dev/ttyUSB1'])
        self.refused('_link:=', node='tactile_emulator', says=['~link', 'is not set to a string'])
        self.refused('_link:=/no/such/folder/link', node='tactile_emulator',
                     says=['/no/such/folder/link'])

    def test_mountings_of_a_tracker(self):
        for mounting in ('0 0 0 0 0', '0 0 0 0 0 x', '0 0 0 nan 0 0', '11 0 0 0 0 0'):
            self.refused(f'_mounting:={mounting}', node='hand_tracker',
                         says=['~mounting', mounting, 'six finite numbers'])
        self.refused('_mounting:=3', node='hand_tracker',
                     says=['~mounting', 'is not set to a string'])

    def test_calibrations_of_the_contactors(self):
        for node, port in (('tactile_driver', '_port:=/dev/null'), ('tactile_emulator', LINK)):
            self.refused(port, '_calibration:=perfect', node=node,
                         says=["there is no 'perfect'", 'representative'])
            with tempfile.NamedTemporaryFile('w', suffix='.yaml') as file:
                file.write('source: a test\nindex: 3\nthumb: 4\n')
                file.flush()
                self.refused(port, f'_calibration:={file.name}', node=node,
                             says=[file.name, 'index'])

    def test_sounds_of_the_contactors_that_there_cannot_be(self):
        sound = '_sound:=' + os.path.join(tempfile.gettempdir(), 'a.wav')
        for parameters, says in ((['_sound:=/no/such/folder/a.wav'], ['/no/such/folder/a.wav']),
                                 ([sound, '_sound_finger:=ring'],
                                  ['~sound_finger', 'allowed are index and thumb']),
                                 ([sound, '_sound_contactor:=24'],
                                  ['~sound_contactor', 'whole numbers from 0 to 23'])):
            self.refused(LINK, *parameters, node='tactile_emulator', says=says)


if __name__ == '__main__':
    rostest.rosrun('haptex', 'refused_parameters', RefusedParameters)
