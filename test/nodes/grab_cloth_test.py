#!/usr/bin/python3
"""A handle grasps a patch of cloth, which goes with it until it lets go."""
import numpy as np
import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import PoseStamped, Quaternion, TransformStamped, WrenchStamped
from haptex.msg import ClothState
from haptex.srv import AttachParticles, ReleaseParticles
from ros_fixtures import Diagnostics, NodeTest
from std_msgs.msg import Header
from std_srvs.srv import SetBool
from tf.transformations import quaternion_about_axis, rotation_matrix

WAIT = 30.0  # s
CORNER = 0  # particle, of the lower edge
RATE = 100.0  # Hz, of poses


class Grab(NodeTest):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service('grab/grasp', WAIT)
        cls.grasp = rospy.ServiceProxy('grab/grasp', SetBool)
        cls.publisher = rospy.Publisher('grab/pose', PoseStamped, queue_size=1)
        cls.eventually(lambda: cls.publisher.get_num_connections() > 0, 'the handle')

    def tearDown(self):
        self.grasp(False)

    def state(self):
        return rospy.wait_for_message('cloth/state', ClothState, WAIT)

    def place(self, particle=CORNER):
        point = self.state().positions[particle]
        return np.array([point.x, point.y, point.z])

    def put(self, position, turn=0.0, frame='world'):
        """@param turn rad, about z"""
        message = PoseStamped()
        message.header.frame_id = frame
        message.pose.position.x, message.pose.position.y, message.pose.position.z = position
        message.pose.orientation = Quaternion(*quaternion_about_axis(turn, (0, 0, 1)))
        self.publisher.publish(message)
        rospy.sleep(0.2)

    def grasp_corner(self):
        """@returns where the handle is, and the corner, which has swung on before it was grasped"""
        handle = self.place()
        self.put(handle)
        answer = self.grasp(True)
        self.assertTrue(answer.success, answer.message)
        rospy.sleep(0.2)
        self.assertIn(CORNER, self.state().attached)
        return handle, self.place()

    def test_what_is_grasped_goes_with_the_handle_and_is_felt(self):
        handle, start = self.grasp_corner()
        for i in range(50):
            way = np.array([0.001, 0.0, 0.0005]) * (i + 1)
            message = PoseStamped()
            message.header.frame_id = 'world'
            message.pose.position.x, message.pose.position.y, message.pose.position.z = handle + way
            message.pose.orientation.w = 1.0
            self.publisher.publish(message)
            rospy.sleep(1.0 / RATE)
        self.eventually(lambda: np.linalg.norm(self.place() - start - [0.05, 0.0, 0.025]) < 1e-6,
                        'the corner where the handle is')
        wrench = rospy.wait_for_message('cloth/frames/grab', WrenchStamped, WAIT)
        self.assertGreater(wrench.wrench.force.x ** 2 + wrench.wrench.force.z ** 2, 1e-8)
        self.assertTrue(self.grasp(False).success)
        self.eventually(lambda: CORNER not in self.state().attached, 'the corner to be free')

    def test_it_turns_with_the_handle(self):
        handle, start = self.grasp_corner()
        others = [particle for particle in self.state().attached if 0 < particle < 100]
        self.assertTrue(others)
        before = self.place(others[-1]) - start
        self.put(handle, turn=0.5)
        turn = rotation_matrix(0.5, (0, 0, 1))[:3, :3]
        self.eventually(lambda: np.linalg.norm(self.place(others[-1]) - self.place() - turn @ before) < 1e-6,
                        'what is grasped to turn')

    def test_nothing_is_grasped_where_nothing_is(self):
        self.put([1.0, 1.0, 1.0])
        answer = self.grasp(True)
        self.assertFalse(answer.success)
        self.assertIn('no free particle is within 20 mm', answer.message)

    def test_a_pose_of_tf_that_is_refused_leaves_the_cloth_where_it_was_and_is_told(self):
        broadcaster = tf2_ros.TransformBroadcaster()
        attach = rospy.ServiceProxy('cloth/attach', AttachParticles)

        def tell(x):
            lost = TransformStamped(header=Header(frame_id='world', stamp=rospy.Time.now()), child_frame_id='lost')
            lost.transform.translation.x, lost.transform.rotation.w = x, 1.0
            broadcaster.sendTransform(lost)
            rospy.sleep(0.3)  # longer than anything is extrapolated

        def attached():
            tell(0.0)  # until the node is connected
            return attach(header=Header(frame_id='lost'), particles=[CORNER]).success

        self.eventually(attached, 'the corner to be attached')
        start = self.place()
        tell(1e300)
        self.assertLess(np.linalg.norm(self.place() - start), 1e-6)
        told = Diagnostics().values('cloth simulation')
        self.assertEqual(told['poses of frame lost refused'], '1')
        self.assertEqual(told['last poses of frame lost refused for'],
                         "the origin of frame 'lost' = (1e+300, 0, 0) m: allowed are finite components from -100 to 100 m")
        tell(0.01)  # what was refused is not remembered
        self.eventually(lambda: np.linalg.norm(self.place() - start - [0.01, 0, 0]) < 1e-6, 'the corner where the frame is')
        answer = rospy.ServiceProxy('cloth/release', ReleaseParticles)([CORNER])
        self.assertTrue(answer.success, answer.message)

    def test_poses_that_make_no_sense_leave_it_where_it_is(self):
        _, start = self.grasp_corner()
        self.put([float('nan'), 0.0, 0.0])
        self.put([1e6, 0.0, 0.0])
        self.put([0.5, 0.0, 0.0], frame='nowhere')
        self.assertLess(np.linalg.norm(self.place() - start), 1e-9)
        self.assertFalse(self.grasp(True).success)  # it holds already


if __name__ == '__main__':
    rospy.init_node('grab_cloth_test')
    rostest.rosrun('haptex', 'grab_cloth_test', Grab)
