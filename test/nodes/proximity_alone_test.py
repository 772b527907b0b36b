#!/usr/bin/python3
"""proximity without a cloth, with one that sends nonsense, and with one that dies."""
import subprocess

import roslib.packages
import rospy
import rostest
from geometry_msgs.msg import Point
from haptex.msg import ClothMesh, ClothState
from haptex.srv import QueryProximity, QueryProximityRequest
from ros_fixtures import WAIT, Diagnostics, NodeTest, await_connections
from std_msgs.msg import Header

NAN = float('nan')
CORNERS = [(0.0, 0.0), (0.1, 0.0), (0.0, 0.1), (0.1, 0.1)]
POINT = QueryProximityRequest(header=Header(frame_id='world'), distance=0.1,
                              shape=QueryProximityRequest.POINT, points=[Point(0.01, 0.02, 0.02)])


def mesh(triangles=(0, 1, 2, 1, 3, 2), corners=tuple(CORNERS)):
    return ClothMesh(header=Header(frame_id='world'), triangles=list(triangles),
                     rest_weft_coordinates=[u for u, _ in corners],
                     rest_warp_coordinates=[v for _, v in corners], masses=[1e-3] * len(corners))


def state(step, frame='world', corners=tuple(CORNERS)):
    """In the plane x = 0."""
    return ClothState(header=Header(frame_id=frame, stamp=rospy.Time(1)), step=step,
                      positions=[Point(0.0, u, v) for u, v in corners])


class ProximityAlone(NodeTest):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service('proximity/query', WAIT)
        cls.query = staticmethod(rospy.ServiceProxy('proximity/query', QueryProximity))
        cls.before_any_cloth = cls.query(POINT)
        cls.meshes = rospy.Publisher('cloth/mesh', ClothMesh, queue_size=10)
        cls.states = rospy.Publisher('cloth/state', ClothState, queue_size=10)
        await_connections(cls.meshes, cls.states)
        cls.diagnostics = Diagnostics()

    def answer(self):
        """The first answer that is none of another test's cloth, which has more triangles."""
        answers = []

        def answered():
            answers.append(self.query(POINT))
            return answers[-1].success and len(answers[-1].elements) == 2

        self.eventually(answered, 'an answer', meanwhile=self.send_cloth)
        return answers[-1]

    def eventually_says(self, text):
        self.eventually(lambda: text in self.query(POINT).message, text)

    def send_cloth(self):
        self.meshes.publish(mesh())
        self.states.publish(state(1))

    def dropped(self):
        return self.diagnostics.values('proximity queries')['why the last message was dropped']

    def test_refuses_before_there_is_a_cloth(self):
        self.assertFalse(self.before_any_cloth.success)
        self.assertIn('no good message on cloth/mesh: is cloth_simulation running?',
                      self.before_any_cloth.message)

    def test_survives_nonsense_and_tells_what_it_was(self):
        self.answer()
        for send, says in (
                (lambda: self.states.publish(state(2, frame='moon')), "frame_id = 'moon'"),
                (lambda: self.states.publish(state(2, corners=CORNERS[:3])),
                 'positions has 3 elements: cloth/mesh has 4 particles'),
                (lambda: self.states.publish(state(2, corners=[(NAN, 0.0)] * 4)),
                 'positions[0] = (0, nan, 0)'),
                (lambda: self.meshes.publish(mesh(triangles=[0, 1, 4])), 'triangles[2] = 4'),
                (lambda: self.meshes.publish(mesh(triangles=[])), 'triangles has 0 elements'),
                (lambda: self.meshes.publish(mesh(corners=[(NAN, 0.0)] * 4)),
                 'rest coordinates of particle 0 = (nan, 0)')):
            self.eventually(lambda: says in self.dropped(), says, meanwhile=send)
            response = self.answer()
            self.assertAlmostEqual(response.distance, 0.01, delta=1e-15)
            self.assertEqual(response.step, 1)

    def test_cloth_whose_publisher_is_silent_gets_stale(self):
        self.answer()
        self.eventually_says('the cloth is stale')

    def test_cloth_whose_simulation_is_killed_gets_stale(self):
        program = roslib.packages.find_node('haptex', 'cloth_simulation')[0]
        simulation = subprocess.Popen([program, '_scene:=wool_sample',
                                       f'__ns:={rospy.get_namespace()}'])
        try:
            self.eventually(lambda: len(self.query(POINT).elements) > 2, 'the real cloth')
        finally:
            simulation.kill()
            simulation.wait()
        self.eventually_says('the cloth is stale')


if __name__ == '__main__':
    rospy.init_node('proximity_alone_test')
    rostest.rosrun('haptex', 'proximity_alone', ProximityAlone)
