#!/usr/bin/python3
"""A cloth with a budget says what runs and what a budget would buy."""
import math
import pathlib
import unittest

import roslib.packages
import rospy
import rostest
import yaml
from haptex.msg import ClothMesh, ClothQuality, ClothState
from haptex.srv import QueryBudget, SetFabric
from ros_fixtures import Diagnostics, NodeTest
from std_srvs.srv import Trigger

WAIT = 30.0  # s
BUDGET = 50.0  # ms
CYCLE = 12.5e-3  # s, the time step of the scene
SIDE = 0.2  # m, of the scene's sheet


def front():
    """What there is for the fabric of the scene."""
    presets = pathlib.Path(roslib.packages.get_pkg_dir('haptex'), 'config', 'presets')
    qualities = yaml.safe_load((presets / 'front.yaml').read_text())['qualities']
    return [item for item in qualities if item['fabric'] == 'wool']


class Quality(NodeTest):
    @classmethod
    def setUpClass(cls):
        services = {'query_budget': QueryBudget, 'set_fabric': SetFabric, 'reset': Trigger}
        for name, service in services.items():
            rospy.wait_for_service('cloth/' + name, WAIT)
            setattr(cls, name, rospy.ServiceProxy('cloth/' + name, service))
        cls.diagnostics = Diagnostics()

    def quality(self):
        """The last one: the topic is latched."""
        return rospy.wait_for_message('cloth/quality', ClothQuality, WAIT)

    def test_topic_tells_what_runs_and_what_error_to_expect(self):
        quality = self.quality()
        self.assertEqual(quality.header.frame_id, 'world')
        self.assertEqual(quality.budget_ms, BUDGET)
        point = quality.quality
        point_of_file = {item['name']: item for item in front()}[point.name]
        self.assertEqual(point.cell_size, point_of_file['cell_size'])
        self.assertAlmostEqual(point.time_step * point.substeps, CYCLE)
        self.assertLessEqual(point.time_step, point_of_file['time_step'] * (1 + 1e-9))
        self.assertEqual(point.fabric, 'wool')
        measured = [item for item in point_of_file['measured'] if item['fabric'] == 'wool']
        self.assertEqual(point.motion, [item['motion'] for item in measured])
        for error in ('position_error', 'force_error', 'energy_error'):
            self.assertEqual(list(getattr(point, error)), [item[error] for item in measured])

    def test_mesh_has_the_cells_of_the_point(self):
        mesh = rospy.wait_for_message('cloth/mesh', ClothMesh, WAIT)
        coordinates = sorted(set(round(u, 9) for u in mesh.rest_weft_coordinates))
        widest = max(b - a for a, b in zip(coordinates, coordinates[1:]))
        point = self.quality().quality
        of_mesh = SIDE / math.ceil(SIDE / point.cell_size * (1 - 1e-9))
        self.assertEqual(point.cells_as_measured, abs(widest - of_mesh) < 1e-6)
        self.assertIn(round(SIDE / widest), [round(SIDE / item['cell_size']) for item in front()])

    def test_topic_goes_on_and_counts_cycles_within_the_budget(self):
        first = self.quality()
        self.eventually(lambda: self.quality().header.stamp > first.header.stamp,
                        'another message of cloth/quality')
        later = self.quality()
        self.assertGreater(later.cycle_ms, 0.0)
        self.assertGreaterEqual(later.worst_cycle_ms, 0.0)
        self.assertTrue(0.0 <= later.within_budget <= 1.0)
        self.assertGreater(later.load, 0.0)

    def test_larger_budgets_buy_points_that_are_not_cheaper(self):
        names = [item['name'] for item in front()]
        places = []
        for budget in (1e-6, 0.1, 1.0, 10.0, 1e3, 1e9):
            answer = self.query_budget(budget)
            self.assertTrue(answer.success, answer.message)
            self.assertIn(answer.quality.name, names)
            self.assertIn(answer.quality.name, answer.message)
            self.assertEqual(answer.affordable, answer.cycle_ms <= 0.8 * budget * (1 + 1e-9))
            self.assertEqual(answer.quality.fabric, 'wool')
            places.append(names.index(answer.quality.name))
        self.assertEqual(places[1:], sorted(places[1:]))
        self.assertEqual(places[-1], len(names) - 1)

    def test_points_with_other_cells_need_a_restart(self):
        mesh = rospy.wait_for_message('cloth/mesh', ClothMesh, WAIT)
        columns = len(set(round(u, 9) for u in mesh.rest_weft_coordinates))
        for budget in (1e-6, 1.0, 1e9):
            answer = self.query_budget(budget)
            same = round(SIDE / answer.quality.cell_size) == columns - 1
            self.assertEqual(answer.needs_restart, not same)

    def test_budgets_that_are_none_are_refused(self):
        for budget in (0.0, -1.0, float('nan'), float('inf')):
            answer = self.query_budget(budget)
            self.assertFalse(answer.success)
            self.assertIn('budget_ms', answer.message)
            self.assertIn('allowed are finite numbers > 0', answer.message)

    def test_another_fabric_has_its_own_errors(self):
        self.assertTrue(self.set_fabric('linear').success)
        self.eventually(lambda: self.quality().quality.fabric == 'linear', 'errors of linear')
        self.assertTrue(self.set_fabric('wool').success)
        self.eventually(lambda: self.quality().quality.fabric == 'wool', 'errors of wool')

    def test_reset_keeps_the_simulation_running(self):
        self.assertTrue(self.reset().success)
        self.eventually(
            lambda: rospy.wait_for_message('cloth/state', ClothState, WAIT).step > 3, 'steps')

    def test_diagnostics_name_the_quality_and_the_expected_error(self):
        values = self.diagnostics.values('cloth simulation')
        self.assertIn(values['quality'], [item['name'] for item in front()])
        self.assertEqual(float(values['budget (ms)']), BUDGET)
        self.assertTrue(any(key.startswith('expected error of position in ') for key in values))


if __name__ == '__main__':
    rospy.init_node('quality_test')
    rostest.rosrun('haptex', 'quality', Quality)
