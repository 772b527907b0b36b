"""What the tests of nodes in Python have in common."""
import threading
import time
import unittest
import xmlrpc.client

import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from haptex.msg import OperatingState
from std_srvs.srv import Trigger

WAIT = 30.0  # s


def eventually(happens, what, wait=WAIT, meanwhile=lambda: None):
    """Waits until something happens; fails with `what`, a text or a function that makes one."""
    end = time.monotonic() + wait
    while not happens():
        if time.monotonic() > end:
            raise AssertionError(what() if callable(what) else what)
        meanwhile()
        time.sleep(0.01)


class AnswersTest(unittest.TestCase):
    """A test of services whose answers say whether they did it, and why not."""

    def accepted(self, response):
        self.assertTrue(response.success, response.message)
        return response

    def refused(self, response, says):
        self.assertFalse(response.success, f'accepted instead of refused: {says}')
        self.assertIn(says, response.message)


def await_connections(*publishers):
    for publisher in publishers:
        eventually(publisher.get_num_connections, f'a subscriber of {publisher.name}')


def process_of(node):
    """Its number, or None while it does not answer."""
    try:
        uri = rosgraph.Master('/test').lookupNode(rospy.resolve_name(node))
        return xmlrpc.client.ServerProxy(uri).getPid('/test')[2]
    except (OSError, rosgraph.MasterException, xmlrpc.client.Error):
        return None


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


class Repeated:
    """Publishes what `make` makes once in about a period (s) until the end of the with statement;
    `last` is when it did so last, of time.monotonic()."""

    def __init__(self, publisher, make, period):
        self.publisher, self.make, self.period = publisher, make, period
        self.ends, self.last = threading.Event(), 0.0
        self.thread = threading.Thread(target=self.run)

    def run(self):
        while not self.ends.wait(self.period):
            self.publisher.publish(self.make())
            self.last = time.monotonic()

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.ends.set()
        self.thread.join()


class NodeTest(unittest.TestCase):
    eventually = staticmethod(eventually)


class DeviceTest(NodeTest):
    """With an exoskeleton or its emulator and what is around it. With the parameter ~shared driver
    and force renderer are one process."""

    @classmethod
    def setUpClass(cls):
        shared = rospy.get_param('~shared', False)
        cls.driver = 'haptics' if shared else 'exoskeleton_driver'
        cls.renderer = 'haptics' if shared else 'force_renderer'
        cls.ask = {}
        for name in ('enable', 'disable', 'home', 'clear_fault'):
            rospy.wait_for_service(f'exoskeleton/{name}', WAIT)
            cls.ask[name] = rospy.ServiceProxy(f'exoskeleton/{name}', Trigger)
        cls.state = None
        rospy.Subscriber('exoskeleton/operating_state', OperatingState, cls.take_state)

    @classmethod
    def take_state(cls, state):
        cls.state = state

    def await_state(self, is_reached, request_for, what):
        """Asks again and again for what `request_for` the state tells; None: for nothing."""
        def reached():
            type(self).state = None
            time.sleep(0.15)  # the next operating state
            state = self.state
            if not state:
                return False
            if is_reached(state):
                return True
            request = request_for(state)
            if request:
                try:
                    self.ask[request]()
                except rospy.ServiceException:
                    pass  # the driver is not there yet
            return False

        self.eventually(reached, lambda: f'{what}: {self.state}', 2 * WAIT)

    def recover(self):
        """Homed and enabled, whatever was before."""
        self.await_state(lambda state: state.state == 'ENABLED' and state.is_homed,
                         lambda state: ('clear_fault' if state.state == 'FAULT' else
                                        None if state.is_busy else
                                        'enable' if state.is_homed else 'home'),
                         'homed and enabled')

    def disable(self):
        """The motors off, whatever was before."""
        self.await_state(lambda state: state.state == 'DISABLED' and not state.is_busy,
                         lambda state: 'clear_fault' if state.state == 'FAULT' else 'disable',
                         'disabled')

    def await_contact(self, is_felt, what='contact'):
        """@param is_felt whether forces are @param what as for eventually()"""
        def felt():
            if not self.state or self.state.state != 'ENABLED':
                self.recover()
            return is_felt()

        self.eventually(felt, what, 2 * WAIT)
