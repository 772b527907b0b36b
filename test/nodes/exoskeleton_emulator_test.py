#!/usr/bin/python3
"""exoskeleton_emulator without a driver: targets, faults by name, tf and ground truth."""
import math

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Point, PointStamped, Pose, PoseStamped, Quaternion, WrenchStamped
from haptex.srv import InjectFault
from ros_fixtures import WAIT, NodeTest, await_connections
from std_msgs.msg import Header
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerInit, MarkerArray

NAN = float('nan')
REST = {'index': (0.094, 0.022, -0.051), 'thumb': (0.052, 0.033, -0.101)}  # config/paths/rest.yaml


def close(point, expected, tolerance=1e-6):
    return math.dist((point.x, point.y, point.z), expected) < tolerance


class ExoskeletonEmulator(NodeTest):
    @classmethod
    def setUpClass(cls):
        for name in ('inject_fault', 'power_cycle'):
            rospy.wait_for_service(f'emulator/{name}', WAIT)
        cls.inject = staticmethod(rospy.ServiceProxy('emulator/inject_fault', InjectFault))
        cls.cycle_power = staticmethod(rospy.ServiceProxy('emulator/power_cycle', Trigger))
        cls.values, cls.targets, cls.hand = {}, {}, None
        rospy.Subscriber('/diagnostics', DiagnosticArray, cls.take_diagnostics)
        rospy.Subscriber('emulator/target_markers', MarkerArray, cls.take_targets)
        rospy.Subscriber('/tf', TFMessage, cls.take_transforms)
        cls.points = {finger: rospy.Publisher(f'{finger}/target', PointStamped, queue_size=10)
                      for finger in REST}
        cls.poses = rospy.Publisher('hand_base/target', PoseStamped, queue_size=10)
        cls.dragging = rospy.Publisher('emulator/interactive_markers/feedback',
                                       InteractiveMarkerFeedback, queue_size=10)
        await_connections(*cls.points.values(), cls.poses, cls.dragging)

    @classmethod
    def take_diagnostics(cls, array):
        for status in array.status:
            if status.name.endswith('exoskeleton emulator'):
                cls.values = {item.key: item.value for item in status.values}

    @classmethod
    def take_targets(cls, array):
        cls.targets = {marker.ns: marker.pose.position for marker in array.markers}

    @classmethod
    def take_transforms(cls, message):
        for transform in message.transforms:
            if (transform.header.frame_id, transform.child_frame_id) == ('world', 'hand_base'):
                cls.hand = transform.transform

    def eventually_refused(self, publisher, message, says):
        self.eventually(lambda: self.values, 'diagnostics')
        before = int(self.values['targets refused'])
        publisher.publish(message)
        self.eventually(lambda: int(self.values['targets refused']) == before + 1, says)
        self.assertIn(says, self.values['why the last target was refused'])

    def send_point(self, finger, point, frame='hand_base'):
        self.points[finger].publish(PointStamped(Header(frame_id=frame), Point(*point)))

    def send_pose(self, position, orientation=(0.0, 0.0, 0.0, 1.0)):
        self.poses.publish(PoseStamped(Header(frame_id='world'),
                                       Pose(Point(*position), Quaternion(*orientation))))

    def test_1_rests_without_a_path(self):
        self.eventually(lambda: self.targets and self.hand, 'targets and hand')
        for finger, place in REST.items():
            self.assertTrue(close(self.targets[finger], place), finger)
        self.assertTrue(close(self.hand.translation, (0.005, -0.094, -0.315)))

    def test_2_takes_points_in_the_frame_of_the_hand(self):
        self.send_point('index', (0.08, 0.02, -0.06))
        self.eventually(lambda: close(self.targets['index'], (0.08, 0.02, -0.06)), 'index')
        self.assertTrue(close(self.targets['thumb'], REST['thumb']), 'follows the path')

    def test_3_takes_the_pose_of_the_hand_and_points_in_other_frames(self):
        half = math.sqrt(0.5)
        self.send_pose((0.1, 0.2, 0.3), (0.0, 0.0, half, half))  # x of the hand is y of the world
        self.eventually(lambda: close(self.hand.translation, (0.1, 0.2, 0.3)), 'hand')
        rospy.sleep(0.2)  # for the emulator to hear it from tf
        self.send_point('thumb', (0.1 - 0.03, 0.2 + 0.06, 0.3 - 0.09), 'world')
        self.eventually(lambda: close(self.targets['thumb'], (0.06, 0.03, -0.09), 1e-5), 'thumb')

    def test_4_takes_what_is_dragged(self):
        feedback = InteractiveMarkerFeedback(
            header=Header(frame_id='hand_base'), client_id='test', marker_name='index',
            event_type=InteractiveMarkerFeedback.POSE_UPDATE,
            pose=Pose(Point(0.07, 0.02, -0.06), Quaternion(0.0, 0.0, 0.0, 1.0)))
        self.dragging.publish(feedback)
        self.eventually(lambda: close(self.targets['index'], (0.07, 0.02, -0.06)), 'index')
        feedback.event_type = InteractiveMarkerFeedback.MOUSE_UP
        self.dragging.publish(feedback)
        feedback = InteractiveMarkerFeedback(
            header=Header(frame_id='world'), client_id='test', marker_name='hand_base',
            event_type=InteractiveMarkerFeedback.POSE_UPDATE,
            pose=Pose(Point(0.0, -0.1, 0.0), Quaternion(0.0, 0.0, 0.0, 1.0)))
        self.dragging.publish(feedback)
        self.eventually(lambda: close(self.hand.translation, (0.0, -0.1, 0.0)), 'hand')

    def test_5_offers_handles(self):
        init = rospy.wait_for_message('emulator/interactive_markers/update_full',
                                      InteractiveMarkerInit, WAIT)
        self.assertEqual({marker.name for marker in init.markers}, {'index', 'thumb', 'pinch', 'hand_base'})

    def test_6_refuses_targets_that_are_none(self):
        header = Header(frame_id='hand_base')
        index = self.points['index']
        before = dict(self.targets)
        self.eventually_refused(index, PointStamped(header, Point(NAN, 0.0, 0.0)),
                                'allowed are finite coordinates from -10 to 10 m')
        self.eventually_refused(index, PointStamped(header, Point(0.0, 1e9, 0.0)),
                                'allowed are finite coordinates from -10 to 10 m')
        self.eventually_refused(index, PointStamped(Header(frame_id='moon'), Point(0, 0, 0)),
                                "header.frame_id = 'moon': tf does not connect it with 'hand_base'")
        self.eventually_refused(index, PointStamped(Header(), Point(0, 0, 0)),
                                "header.frame_id = '': name the frame")
        pose = Pose(Point(0.0, 0.0, 0.0), Quaternion(0.0, 0.0, 0.0, 1.0))
        self.eventually_refused(self.poses, PoseStamped(header, pose), "allowed is 'world'")
        world = Header(frame_id='world')
        self.eventually_refused(self.poses, PoseStamped(world, Pose()), 'allowed is 1')
        pose.position.z = NAN
        self.eventually_refused(self.poses, PoseStamped(world, pose), 'not finite')
        for finger, place in before.items():
            self.assertTrue(close(self.targets[finger], (place.x, place.y, place.z)), finger)

    def test_7_injects_faults_by_name(self):
        answer = self.inject('saturated_sensor', 'both', 1.0, 3600.0)
        self.assertTrue(answer.success, answer.message)
        self.eventually(lambda: 'saturated_sensor for' in self.values.get('faults now', ''), 'on')
        self.assertTrue(self.inject('saturated_sensor', 'both', 0.0, 1.0).success)
        self.eventually(lambda: self.values['faults now'] == '', 'off')

    def test_7_refuses_faults_that_there_are_not(self):
        for request, says in ((('explode', 'both', 1.0, 1.0), 'wrong_version, stall, closed_port'),
                              (('drop', 'sideways', 1.0, 1.0), 'to_device, from_device and both'),
                              (('drop', 'both', 1.5, 1.0), 'numbers from 0 to 1'),
                              (('drop', 'both', NAN, 1.0), 'numbers from 0 to 1'),
                              (('drop', 'both', 1.0, 0.0), 'above 0 and at most 3600 s')):
            answer = self.inject(*request)
            self.assertFalse(answer.success)
            self.assertIn(says, answer.message)

    def test_8_tells_the_truth_to_those_who_ask(self):
        for finger in REST:
            for force in ('contact_force', 'motor_force'):
                message = rospy.wait_for_message(f'emulator/{finger}/{force}', WrenchStamped, WAIT)
                self.assertEqual(message.header.frame_id, 'hand_base')
                self.assertLess(abs((rospy.Time.now() - message.header.stamp).to_sec()), 5.0)
                self.assertTrue(math.isfinite(message.wrench.force.x))

    def test_9_cycles_the_power(self):
        answer = self.cycle_power()
        self.assertTrue(answer.success)
        self.assertIn('0.2 s later, on again', answer.message)


if __name__ == '__main__':
    rospy.init_node('exoskeleton_emulator_test')
    rostest.rosrun('haptex', 'exoskeleton_emulator', ExoskeletonEmulator)
