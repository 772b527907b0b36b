#!/usr/bin/python3
"""Cloth goes with frames of tf, and they feel it."""
import math

import numpy as np
import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import TransformStamped, WrenchStamped
from haptex.msg import ClothMesh, ClothState
from haptex.srv import AttachParticles, ReleaseParticles
from ros_fixtures import NodeTest
from std_msgs.msg import Header

WAIT = 60.0  # s
WARP_OF_HEADER = 2.58433  # m
BOWS = ('car', 'rear_bow', 'middle_bow', 'front_bow', 'header')
PIVOT, REACH, CLOSED = np.array([0.0, 0.8]), 1.55, math.radians(22.0)  # of the header: m, m, rad
NEAR = 0.02  # m: between two steps the cloth goes straight


def array(points):
    return np.array([[point.x, point.y, point.z] for point in points])


class SoftTop(NodeTest):
    @classmethod
    def setUpClass(cls):
        cls.transforms = tf2_ros.Buffer()
        cls.listener = tf2_ros.TransformListener(cls.transforms)
        cls.mesh = rospy.wait_for_message('cloth/mesh', ClothMesh, WAIT)
        cls.header = np.nonzero(np.abs(np.array(cls.mesh.rest_warp_coordinates) - WARP_OF_HEADER) < 1e-3)[0]
        cls.attach = rospy.ServiceProxy('cloth/attach', AttachParticles)

    def state(self):
        return rospy.wait_for_message('cloth/state', ClothState, WAIT)

    def angle(self):
        """rad, by which the header has turned in tf."""
        header = self.transforms.lookup_transform('world', 'header', rospy.Time(0), rospy.Duration(WAIT))
        rotation = header.transform.rotation
        return 2.0 * math.atan2(-rotation.y, rotation.w)

    def test_the_cloth_goes_with_the_header(self):
        self.eventually(lambda: self.angle() > 1.0, 'the header on its way', wait=WAIT)
        self.assertEqual(len(self.header), 34)
        rows = []

        def follows():
            """A moment later, on a busy machine a second."""
            rows.append(array(self.state().positions)[self.header])
            x, z = rows[-1][0, [0, 2]] - PIVOT
            return math.atan2(z, x) - CLOSED > 0.8

        self.eventually(follows, 'the cloth with the header', wait=WAIT)
        row = rows[-1]
        self.assertLess(abs(np.linalg.norm(row[0, [0, 2]] - PIVOT) - REACH), NEAR)
        # The row stays as straight and as wide as the bow.
        self.assertLess(np.ptp(row[:, [0, 2]], axis=0).max(), 1e-9)
        self.assertAlmostEqual(np.ptp(row[:, 1]), 1.2, 9)

    def test_every_bow_feels_it(self):
        for bow in BOWS:
            wrench = rospy.wait_for_message(f'cloth/frames/{bow}', WrenchStamped, WAIT)
            self.assertEqual(wrench.header.frame_id, bow)
            force = np.array([wrench.wrench.force.x, wrench.wrench.force.y, wrench.wrench.force.z])
            self.assertTrue(np.all(np.isfinite(force)))
            self.assertGreater(np.linalg.norm(force), 0.01, bow)
            self.assertLess(np.linalg.norm(force), 5000.0, bow)

    def test_other_frames_take_cloth_and_let_go_of_it(self):
        particle = len(self.mesh.rest_warp_coordinates) // 2 + 5
        broadcaster = tf2_ros.StaticTransformBroadcaster()
        hand = TransformStamped(header=Header(frame_id='world', stamp=rospy.Time.now()), child_frame_id='hand')
        hand.transform.rotation.w = 1.0
        broadcaster.sendTransform(hand)
        answer = self.attach(header=Header(frame_id='hand'), particles=[particle])
        self.assertTrue(answer.success, answer.message)
        before = array(self.state().positions)[particle]
        rospy.sleep(0.5)
        self.assertLess(np.linalg.norm(array(self.state().positions)[particle] - before), 1e-6)
        answer = rospy.ServiceProxy('cloth/release', ReleaseParticles)([particle])
        self.assertTrue(answer.success, answer.message)

    def test_frames_that_tf_does_not_know_are_refused(self):
        for frame, reason in (('nowhere', 'tf does not connect'), ('a/b', 'allowed is'), ('', 'allowed is'),
                              ('x' * 1000000, 'allowed is')):
            answer = self.attach(header=Header(frame_id=frame), particles=[0])
            self.assertFalse(answer.success)
            self.assertIn(reason, answer.message)
            self.assertLess(len(answer.message), 1000)


if __name__ == '__main__':
    rospy.init_node('soft_top_test')
    rostest.rosrun('haptex', 'soft_top', SoftTop)
