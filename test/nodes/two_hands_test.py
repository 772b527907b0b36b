#!/usr/bin/python3
"""Two hands in one graph, in namespaces and with prefixes of tf of their own, do not meet."""
import os
import pathlib
import signal

import rosbag
import rosgraph
import rospy
import rostest
import tf2_ros
from haptex.msg import ClothState, Contact
from ros_fixtures import NodeTest, process_of
from tf2_msgs.msg import TFMessage

HANDS = ('left', 'right')
FELT = 0.2  # N, of a hand that holds the cloth
WAIT = 60.0  # s
MANY_PINCHES = 150.0  # s, of 14 s each; two graphs at once are often late, and then the device lets go


class TwoHands(NodeTest):
    @classmethod
    def setUpClass(cls):
        cls.frames, cls.felt = set(), dict.fromkeys(HANDS, 0.0)
        for topic in ('/tf', '/tf_static'):
            rospy.Subscriber(topic, TFMessage, cls.take_transforms)
        for hand in HANDS:
            rospy.Subscriber(f'/{hand}/haptex/index/contact', Contact, cls.take_contact, hand)

    @classmethod
    def take_transforms(cls, message):
        for transform in message.transforms:
            cls.frames |= {transform.header.frame_id, transform.child_frame_id}

    @classmethod
    def take_contact(cls, message, hand):
        cls.felt[hand] = message.normal_force

    def recorder_of(self, hand):
        """The name of its node ends with a number."""
        nodes = {node for kind in rosgraph.Master('/test').getSystemState() for _, names in kind
                 for node in names if node.startswith(f'/{hand}/record_scene')}
        self.assertEqual(len(nodes), 1, nodes)
        return nodes.pop()

    def test_1_both_feel_their_cloth(self):
        for hand in HANDS:
            self.eventually(lambda hand=hand: self.felt[hand] > FELT, f'forces of the {hand} hand',
                            wait=MANY_PINCHES)

    def test_2_frames_have_the_prefix_of_their_hand(self):
        buffer = tf2_ros.Buffer()
        tf2_ros.TransformListener(buffer)
        for hand in HANDS:
            state = rospy.wait_for_message(f'/{hand}/haptex/cloth/state', ClothState, WAIT)
            self.assertEqual(state.header.frame_id, f'{hand}/world')
            self.eventually(lambda hand=hand: buffer.can_transform(
                f'{hand}/world', f'{hand}/index_tactile', rospy.Time()), f'tf of the {hand} hand')
        self.assertFalse(buffer.can_transform('left/world', 'right/hand_base', rospy.Time()))
        self.assertEqual({frame.split('/')[0] for frame in self.frames}, set(HANDS))

    def test_3_both_record_their_own_topics(self):
        for hand in HANDS:
            path = pathlib.Path(f'{rospy.get_param("~bag")}_{hand}.bag')
            self.addCleanup(path.unlink)
            os.kill(process_of(self.recorder_of(hand)), signal.SIGINT)
            self.eventually(path.exists, f'the bag of the {hand} hand', wait=WAIT)
            with rosbag.Bag(path) as bag:
                topics = bag.get_type_and_topic_info().topics
            self.assertGreater(topics[f'/{hand}/haptex/cloth/state'].message_count, 10)
            self.assertGreater(topics[f'/{hand}/haptex/index/contact'].message_count, 10)
            self.assertGreater(topics['/tf'].message_count, 10)
            spaces = {topic.split('/')[1] for topic in topics}
            self.assertEqual(spaces - {'tf', 'tf_static', 'diagnostics'}, {hand})


if __name__ == '__main__':
    rospy.init_node('two_hands_test')
    rostest.rosrun('haptex', 'two_hands', TwoHands)
