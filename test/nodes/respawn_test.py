#!/usr/bin/python3
"""Nodes of haptex.launch that crash come back by themselves, and the forces with them."""
import os
import signal
import time

import rospy
import rostest
from haptex.msg import Contact, Tactile
from ros_fixtures import NodeTest, process_of

FELT = 0.2  # N, of the hand that holds the cloth
NODES = ['proximity', 'force_renderer', 'tactile_renderer', 'cloth_simulation']


class Respawn(NodeTest):
    @classmethod
    def setUpClass(cls):
        cls.felt, cls.felt_at, cls.tactile_at = 0.0, 0.0, 0.0
        rospy.Subscriber('index/contact', Contact, cls.take_contact)
        rospy.Subscriber('index/tactile', Tactile, cls.take_tactile)

    @classmethod
    def take_contact(cls, message):
        cls.felt, cls.felt_at = message.normal_force, time.monotonic()

    @classmethod
    def take_tactile(cls, _):
        cls.tactile_at = time.monotonic()

    def is_felt(self, since):
        return self.felt_at > since and self.felt > FELT

    def test_a_node_that_is_killed_comes_back_with_the_forces(self):
        self.eventually(lambda: self.is_felt(0.0), 'forces at the start', wait=60.0)
        for node in NODES:
            before = process_of(node)
            os.kill(before, signal.SIGKILL)
            self.eventually(lambda: process_of(node) not in (None, before), f'{node} comes back')
            since = time.monotonic()
            self.eventually(lambda: self.is_felt(since), f'forces after {node} has come back')
            self.eventually(lambda: self.tactile_at > since, f'amplitudes after {node} came back')


if __name__ == '__main__':
    rospy.init_node('respawn_test')
    rostest.rosrun('haptex', 'respawn', Respawn)
