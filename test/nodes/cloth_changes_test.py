#!/usr/bin/python3
"""cloth_simulation exchanges its sheet and single properties while it runs."""
import math

import numpy as np
import rospy
import rostest
from dynamic_reconfigure.client import Client
from geometry_msgs.msg import Point, Vector3
from haptex.msg import ClothMesh, ClothState, ContactForces
from haptex.srv import (SetFabric, SetProperties, SetPropertiesRequest, SetSheet, SetSheetRequest,
                        StepCloth)
from ros_fixtures import AnswersTest, Diagnostics, eventually
from std_srvs.srv import SetBool, Trigger
from visualization_msgs.msg import MarkerArray

WAIT = 30.0  # s
AREA, DENSITY, GRAVITY = 0.2 * 0.2, 0.15, 9.80665  # m^2, kg/m^2, m/s^2


class ClothChanges(AnswersTest):
    @classmethod
    def setUpClass(cls):
        for name, kind in (('pause', SetBool), ('reset', Trigger), ('step', StepCloth),
                           ('set_fabric', SetFabric), ('set_sheet', SetSheet),
                           ('set_properties', SetProperties)):
            rospy.wait_for_service('cloth/' + name, WAIT)
            setattr(cls, name, rospy.ServiceProxy('cloth/' + name, kind))
        cls.shown = Client('cloth_simulation', timeout=WAIT)
        cls.start = cls.shown.get_configuration(timeout=WAIT)

    def setUp(self):
        self.accepted(self.pause(True))
        self.properties(**{name: value for name, value in self.start.items() if name != 'groups'
                           and not name.startswith(('wind', 'air'))})
        self.accepted(self.set_sheet(SetSheetRequest()))

    def properties(self, **values):
        self.accepted(self.set_properties(SetPropertiesRequest(names=list(values),
                                                               values=list(values.values()))))

    @staticmethod
    def message(topic, kind):
        return rospy.wait_for_message(topic, kind, WAIT)

    def mesh(self):
        return self.message('cloth/mesh', ClothMesh)

    def state(self, mesh):
        """One of the mesh."""
        found = []
        eventually(lambda: found.append(self.message('cloth/state', ClothState)) or
                   found[-1].mesh == mesh, f'a state of mesh {mesh}')
        return found[-1]

    def test_another_sheet_starts_at_rest_in_its_place(self):
        before = self.mesh()
        self.accepted(self.set_sheet(SetSheetRequest(size=[0.3, 0.1], cells=[12, 4],
                                                     diagonals='one_way')))
        mesh = self.mesh()
        self.assertEqual(mesh.mesh, before.mesh + 1)
        self.assertEqual(len(mesh.masses), 13 * 5)
        self.assertAlmostEqual(sum(mesh.masses), DENSITY * 0.03, 12)
        state = self.state(mesh.mesh)
        self.assertEqual((state.step, state.simulated_time), (0, 0.0))
        self.assertEqual(list(state.attached), list(range(52, 65)))
        self.assertEqual(state.positions[64], Point(0.0, 0.15, 0.0))
        cloth = [marker for marker in self.message('cloth/markers', MarkerArray).markers
                 if marker.ns == 'cloth']
        self.assertEqual(len(cloth[0].points), 3 * 2 * 12 * 4)
        self.accepted(self.step(steps=40))
        self.assertTrue(all(math.isfinite(p.z) for p in self.state(mesh.mesh).positions))

    def test_a_sheet_of_the_same_cells_is_another_one(self):
        before = self.mesh()
        self.accepted(self.set_sheet(SetSheetRequest(size=[0.25, 0.2])))
        self.assertEqual(self.mesh().mesh, before.mesh + 1)
        self.assertEqual(len(self.mesh().masses), len(before.masses))

    def test_the_fabric_stays_with_another_sheet(self):
        self.accepted(self.set_fabric('denim'))
        self.properties(density=2.0)
        self.accepted(self.set_sheet(SetSheetRequest(cells=[8, 8])))
        mesh = self.mesh()
        self.assertEqual((mesh.fabrics, list(mesh.factors)), (['denim'], [1, 1, 1, 1, 2]))
        self.accepted(self.set_fabric('wool'))
        self.assertAlmostEqual(sum(self.mesh().masses), 2.0 * DENSITY * AREA, 12)

    def test_refuses_sheets(self):
        mesh = self.mesh().mesh
        for size, cells, diagonals, says in (
                ([-0.1, 0.2], [0, 0], '', 'size[0] = -0.1 m'),
                ([math.nan, 0.2], [0, 0], '', 'size[0] = nan'),
                ([0.2, 200.0], [0, 0], '', 'size[1] = 200 m'),
                ([0.0, 0.0], [8, 0], '', 'cells[1] = 0'),
                ([0.0, 0.0], [4000000000, 8], '', 'cells = 4000000000'),
                ([0.0, 0.0], [1001, 1000], '', 'at most 2000000'),
                ([0.0, 0.0], [0, 0], 'round', "diagonals is 'round'")):
            self.refused(self.set_sheet(size, cells, diagonals), says)
        self.assertEqual(self.mesh().mesh, mesh)

    def test_loads_of_another_mesh_are_refused(self):
        self.accepted(self.set_sheet(SetSheetRequest(cells=[4, 4])))
        mesh = self.mesh().mesh
        publisher = rospy.Publisher('cloth/contact_forces', ContactForces, queue_size=1)
        self.addCleanup(publisher.unregister)
        eventually(publisher.get_num_connections, 'nobody takes contact forces')
        diagnostics = Diagnostics()
        loads = ContactForces(mesh=mesh - 1, triangles=[1000], barycentric=[1, 0, 0],
                              positions=[Point()], forces=[Vector3(0, 0, 1)], stiffness=[0.0] * 9)
        loads.header.frame_id = 'world'
        publisher.publish(loads)
        eventually(lambda: f'mesh = {mesh - 1}: allowed is {mesh}' in diagnostics.values(
            'cloth simulation')['last contact forces refused for'], 'the refusal')

    def test_gravity_and_density_are_what_the_bar_carries(self):
        self.properties(gravity_z=-2.0 * GRAVITY, density=3.0)
        mesh = self.mesh()
        self.assertEqual(mesh.gravity.z, -2.0 * GRAVITY)
        self.assertAlmostEqual(sum(mesh.masses), 3.0 * DENSITY * AREA, 12)
        self.assertEqual(self.shown.get_configuration()['density'], 3.0)
        state = self.state(mesh.mesh)
        weight = sum(force.z for force in state.forces)
        self.assertAlmostEqual(weight, -2.0 * GRAVITY * sum(mesh.masses), 9)

    def test_a_stiffer_warp_hangs_shorter_by_its_factor(self):
        def elongation():
            self.accepted(self.reset())
            self.accepted(self.step(steps=800))
            places = np.array([(p.y, p.z) for p in self.state(self.mesh().mesh).positions])
            return -places[:33, 1].mean() - 0.2
        self.properties(density=5.0, bending=0.1)
        soft = elongation()
        self.properties(warp=4.0)
        self.assertAlmostEqual(elongation() / soft, 0.25, delta=0.02)

    def test_positions_stay_when_a_property_changes(self):
        self.accepted(self.step(steps=40))
        mesh = self.mesh().mesh
        before = self.state(mesh)
        self.properties(shear=0.5)
        after = self.state(mesh)
        self.assertEqual(before.positions, after.positions)
        self.assertEqual(before.velocities, after.velocities)

    def test_sliders_set_the_same(self):
        shown = self.shown.update_configuration({'bending': 7.0, 'gravity_x': 1.5})
        self.assertEqual((shown['bending'], shown['gravity_x']), (7.0, 1.5))
        mesh = self.mesh()
        self.assertEqual((mesh.factors[3], mesh.gravity.x), (7.0, 1.5))
        shown = self.shown.update_configuration({'wind_x': 3.0})  # no air in this scene
        self.assertEqual(shown['wind_x'], 0.0)
        self.assertEqual(self.mesh().gravity.x, 1.5)

    def test_refuses_properties(self):
        mesh = self.mesh()
        for names, values, says in (([], [], 'names is empty'),
                                    (['weft'], [], 'values has 0 elements'),
                                    (['colour'], [1.0], "'colour' is no property"),
                                    (['weft', 'weft'], [1.0, 2.0], "'weft' twice"),
                                    (['weft'], [0.0], 'weft = 0: allowed are 0.01 to 100'),
                                    (['density'], [math.nan], 'density = nan'),
                                    (['gravity_z'], [-1e9], 'gravity_z = -1000000000'),
                                    (['wind_x'], [1.0], 'models no air')):
            self.refused(self.set_properties(names, values), says)
        after = self.mesh()
        self.assertEqual((mesh.factors, mesh.gravity), (after.factors, after.gravity))


if __name__ == '__main__':
    rospy.init_node('cloth_changes_test')
    rostest.rosrun('haptex', 'cloth_changes', ClothChanges)
