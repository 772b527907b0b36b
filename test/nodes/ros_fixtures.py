"""What the tests of nodes in Python have in common."""
import time
import unittest

import rospy
from diagnostic_msgs.msg import DiagnosticArray

WAIT = 30.0  # s


def eventually(happens, what, wait=WAIT, meanwhile=lambda: None):
    """Waits until something happens; fails with `what`, a text or a function that makes one."""
    end = time.monotonic() + wait
    while not happens():
        if time.monotonic() > end:
            raise AssertionError(what() if callable(what) else what)
        meanwhile()
        time.sleep(0.01)


def await_connections(*publishers):
    for publisher in publishers:
        eventually(publisher.get_num_connections, f'a subscriber of {publisher.name}')


class Diagnostics:
    """The last status of every name, without the node's."""

    def __init__(self):
        self.last = {}
        self.subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, self.take)

    def take(self, array):
        for status in array.status:
            self.last[status.name.split(': ', 1)[-1]] = status

    def next(self, name):
        """Of what is published from now on."""
        self.last.pop(name, None)
        eventually(lambda: name in self.last, f'diagnostics of {name}')
        return self.last[name]

    def values(self, name):
        """Of next()."""
        return {item.key: item.value for item in self.next(name).values}


class NodeTest(unittest.TestCase):
    eventually = staticmethod(eventually)
