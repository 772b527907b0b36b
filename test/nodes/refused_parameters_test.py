#!/usr/bin/python3
"""cloth_simulation ends with an error that names what is wrong with its parameters or files."""
import subprocess
import tempfile
import unittest

import roslib.packages
import rostest

NODE = roslib.packages.find_node('haptex', 'cloth_simulation')[0]


class RefusedParameters(unittest.TestCase):
    runs = 0

    def refused(self, *parameters, says):
        # A name of its own for each run: parameters of earlier runs stay on the server.
        RefusedParameters.runs += 1
        name = f'refused_{RefusedParameters.runs}'
        run = subprocess.run([NODE, f'__name:={name}', *parameters], capture_output=True,
                             text=True, timeout=30)
        self.assertEqual(run.returncode, 1, run.stderr)
        for text in says:
            self.assertIn(text.replace('~', f'/{name}/'), run.stderr)

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


if __name__ == '__main__':
    rostest.rosrun('haptex', 'refused_parameters', RefusedParameters)
