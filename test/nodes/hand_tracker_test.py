#!/usr/bin/python3
"""A tracker gives the place of the hand: bad poses are dropped, and silence ends the forces."""
import math
import time

import rospy
import rostest
from force_renderer_test import FELT, Forces
from geometry_msgs.msg import PoseStamped, Quaternion
from haptex.msg import ServoForce
from ros_fixtures import Diagnostics, DeviceTest, Repeated, await_connections
from tf2_msgs.msg import TFMessage

MOUNTING = 0.05  # m along z, of the hand base on the tracked body
PERIOD = 0.01  # s
# ms, from the last pose to no force: what the renderer waits for a hand, and 40 for a busy machine.
DEADLINE = 55.0 + 40.0
TRACKER, WEIGHT = 'hand tracker', 'exoskeleton weight'
NAN = float('nan')


class HandTracker(DeviceTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.emulated, cls.hands = None, []
        cls.subscribers = [rospy.Subscriber('/emulated_tf', TFMessage, cls.take_emulated),
                           rospy.Subscriber('/tf', TFMessage, cls.take_tf)]
        cls.tracked = rospy.Publisher('/tracked', PoseStamped, queue_size=10)
        cls.diagnostics = Diagnostics()
        cls.force = Forces('index/servo_cf', ServoForce)
        await_connections(cls.tracked)
        cls.eventually(lambda: cls.emulated, 'the emulated hand')

    @classmethod
    def take_emulated(cls, message):
        for transform in message.transforms:
            if transform.child_frame_id == 'hand_base':
                cls.emulated = transform.transform

    @classmethod
    def take_tf(cls, message):
        cls.hands += [item for item in message.transforms if item.child_frame_id == 'hand_base']

    def pose(self, hand=None, offset=0.0, age=0.0, frame='world'):
        """Where a tracker sees its body on the emulated hand."""
        message = PoseStamped()
        message.header.stamp = rospy.Time.now() - rospy.Duration(age)
        message.header.frame_id = frame
        hand = hand or self.emulated
        q = hand.rotation
        up = (2.0 * (q.x * q.z + q.w * q.y), 2.0 * (q.y * q.z - q.w * q.x),
              1.0 - 2.0 * (q.x * q.x + q.y * q.y))  # z of the hand base, in world
        message.pose.position.x = hand.translation.x - MOUNTING * up[0] + offset
        message.pose.position.y = hand.translation.y - MOUNTING * up[1]
        message.pose.position.z = hand.translation.z - MOUNTING * up[2]
        message.pose.orientation = Quaternion(q.x, q.y, q.z, q.w)
        return message

    def counts(self):
        values = self.diagnostics.values(TRACKER)
        return int(values['poses taken']), int(values['poses dropped'])

    def await_force(self, what):
        self.eventually(lambda: self.force.size > FELT and self.force.age() < 0.1,
                        lambda: f'{what}: {self.force.size} N, {self.force.age()} s ago')

    def gravity(self):
        """Its size, as the driver holds the links against it."""
        values = self.diagnostics.values(WEIGHT)['gravity in hand_base (m/s^2)']
        return math.sqrt(sum(float(component) ** 2 for component in values.split()))

    def test_a_good_pose_is_the_hand_base_and_bad_ones_are_not(self):
        time.sleep(0.3)  # whatever was before is forgotten
        taken, dropped = self.counts()
        self.hands.clear()
        emulated = self.emulated
        good = self.pose(emulated)
        self.tracked.publish(good)
        self.eventually(lambda: self.hands, 'tf of the hand')
        hand = self.hands[-1]
        self.assertEqual(hand.header.frame_id, 'world')
        self.assertEqual(hand.header.stamp, good.header.stamp)
        for axis in 'xyz':
            self.assertAlmostEqual(getattr(hand.transform.translation, axis),
                                   getattr(emulated.translation, axis), 9)

        bad = [self.pose(age=0.3), self.pose(age=-0.2), self.pose(frame='moon'),
               self.pose(frame=''), self.pose(offset=NAN), self.pose(offset=100.0), self.pose()]
        bad[-1].pose.orientation.w += 0.5
        for message in bad:
            self.tracked.publish(message)
            time.sleep(0.05)
        self.eventually(lambda: self.counts() == (taken + 1, dropped + len(bad)),
                        lambda: f'{self.counts()} after {(taken, dropped)}')
        self.assertEqual(len(self.hands), 1)
        self.assertIn('quaternion',
                      self.diagnostics.values(TRACKER)['why the last pose was dropped'])

    def test_forces_and_weight_end_when_the_tracker_falls_silent(self):
        with Repeated(self.tracked, self.pose, PERIOD) as poses:
            self.recover()
            self.await_force('force of the held edge')
            self.eventually(lambda: self.diagnostics.next(WEIGHT).level == 0, 'weight held')
        silent = rospy.get_time() - (time.monotonic() - poses.last)
        time.sleep(1.0)
        after, still = self.force.after(silent, 0.0)
        rospy.loginfo('force zero %.1f ms after the last pose, %.1f of them the machine stood still',
                      after, still)
        self.assertLess(after - still, DEADLINE)
        self.eventually(lambda: self.diagnostics.next(TRACKER).level == 2, 'silence told')
        weight = self.diagnostics.next(WEIGHT)
        self.assertEqual(weight.level, 1)
        self.assertIn('old', weight.message)
        self.assertEqual(self.gravity(), 0.0)

        # And come back with it.
        with Repeated(self.tracked, self.pose, PERIOD):
            self.recover()
            self.await_force('force again')
            self.assertAlmostEqual(self.gravity(), 9.80665, 3)


if __name__ == '__main__':
    rospy.init_node('tracked_hand_test')
    rostest.rosrun('haptex', 'tracked_hand', HandTracker)
