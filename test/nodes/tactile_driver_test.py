#!/usr/bin/python3
"""tactile_driver and the emulated drive electronics behind a pseudo-terminal. Amplitudes come from
the test, or from a process that it kills."""
import os
import signal
import subprocess
import sys
import time
import wave

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus
from haptex.msg import ArrayState, Tactile
from haptex.srv import InjectFault
from ros_fixtures import WAIT, Diagnostics, NodeTest, Repeated, await_connections
from std_msgs.msg import Header

NAN = float('nan')
FINGERS = ('index', 'thumb')
STEP = 0.025  # s
CONTACTORS = 24
LINK, INDEX = 'contactor link', 'contactors of the index'
# Beside what is promised: messages take time, more on a busy machine, and this process is one.
PATIENCE = 0.02  # s


def tactile(finger='index', slow=20.0, fast=5.0, frame=None):
    return Tactile(header=Header(frame_id=frame or f'{finger}_tactile', stamp=rospy.Time.now()),
                   amplitudes_40=[slow] * CONTACTORS, amplitudes_320=[fast] * CONTACTORS)


def source(publisher):
    """Amplitudes for the index every 25 ms until the end of the with statement."""
    return Repeated(publisher, tactile, STEP)


def be_a_source():
    """What this file does as a process that can be killed: as tactile_renderer, it listens to the
    driver's state."""
    rospy.init_node('source', anonymous=True)
    rospy.Subscriber('tactile/array_state', ArrayState, lambda _: None)
    publisher = rospy.Publisher('index/tactile', Tactile, queue_size=1, tcp_nodelay=True)
    rate = rospy.Rate(1.0 / STEP)
    while not rospy.is_shutdown():
        publisher.publish(tactile())
        rate.sleep()


class TactileDriver(NodeTest):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service('tactile_emulator/inject_fault', WAIT)
        cls.inject = staticmethod(rospy.ServiceProxy('tactile_emulator/inject_fault', InjectFault))
        cls.diagnostics = Diagnostics()
        cls.state, cls.displayed, cls.moved_at = None, {}, 0.0
        rospy.Subscriber('tactile/array_state', ArrayState, cls.take_state)
        for finger in FINGERS:
            rospy.Subscriber(f'tactile_emulator/{finger}/displayed', Tactile, cls.take_displayed,
                             callback_args=finger, tcp_nodelay=True)
        cls.publisher = rospy.Publisher('index/tactile', Tactile, queue_size=1, tcp_nodelay=True)
        await_connections(cls.publisher)

    @classmethod
    def take_state(cls, message):
        cls.state = message

    @classmethod
    def take_displayed(cls, message, finger):
        cls.displayed[finger] = message
        if finger == 'index' and max(message.amplitudes_40) > 0.0:
            cls.moved_at = time.monotonic()

    def slow(self, finger='index'):
        return max(self.displayed[finger].amplitudes_40) if finger in self.displayed else NAN

    def await_displayed(self):
        self.eventually(lambda: abs(self.slow() - 20.0) < 0.01, lambda: f'20 um, is {self.slow()}')

    def await_rest(self):
        self.eventually(lambda: self.slow() == 0.0, lambda: f'rest, is {self.slow()}')

    def setUp(self):
        self.eventually(lambda: self.state and self.state.connected,
                        lambda: f'connection: {self.state}')

    def test_displays_what_is_published_and_nothing_on_the_other_finger(self):
        with source(self.publisher):
            self.await_displayed()
            message = self.displayed['index']
            self.assertEqual(message.header.frame_id, 'index_tactile')
            self.assertLess(max(abs(fast - 5.0) for fast in message.amplitudes_320), 0.01)
            self.assertEqual(self.slow('thumb'), 0.0)
            self.assertEqual(self.diagnostics.next(INDEX).level, DiagnosticStatus.OK)
        self.await_rest()
        status = self.diagnostics.next(INDEX)
        self.assertEqual(status.level, DiagnosticStatus.WARN)
        self.assertIn('no amplitudes', status.message)

    def test_rests_when_the_source_falls_silent(self):
        with source(self.publisher) as amplitudes:
            self.await_displayed()
        self.await_rest()
        self.assertLess(self.moved_at - amplitudes.last, 2 * STEP + PATIENCE)

    def test_rests_25_ms_after_the_source_was_killed(self):
        for attempt in range(3):
            process = subprocess.Popen([sys.executable, __file__, '--source'], env=os.environ)
            try:
                self.await_displayed()
                time.sleep(0.007 * attempt)  # another moment of the step
                process.send_signal(signal.SIGKILL)
                death = time.monotonic()
            finally:
                process.kill()
                process.wait()
            self.await_rest()
            self.assertLess(self.moved_at - death, STEP + PATIENCE)
        self.eventually(lambda: int(self.diagnostics.values(LINK)['sources that have died']) >= 3,
                        'deaths counted')

    def test_rests_when_the_line_stalls_and_comes_back(self):
        with source(self.publisher):
            self.await_displayed()
            trips = int(self.diagnostics.values('contactor emulator')['watchdog trips'])
            asked = time.monotonic()
            self.assertTrue(self.inject('stall', 'both', 1.0, 0.4).success)
            self.await_rest()
            self.assertLess(self.moved_at - asked, STEP + 2 * PATIENCE)
            self.await_displayed()
            values = self.diagnostics.values('contactor emulator')
            self.assertEqual(int(values['watchdog trips']), trips + 1)
            self.assertGreater(int(self.diagnostics.values(LINK)['timeouts']), 0)
        self.await_rest()

    def test_survives_damaged_frames_and_a_port_that_goes(self):
        with source(self.publisher):
            self.await_displayed()
            for fault in ('flip', 'drop_bytes', 'garbage', 'duplicate'):
                self.assertTrue(self.inject(fault, 'both', 0.3, 1.0).success)
            time.sleep(1.1)
            self.await_displayed()
            self.assertGreater(int(self.diagnostics.values(LINK)['corrupt frames']), 0)
            lost = int(self.diagnostics.values(LINK)['times the port was lost'])
            self.assertTrue(self.inject('closed_port', 'both', 1.0, 0.3).success)
            self.eventually(lambda: not self.state.connected, 'port lost')
            self.await_displayed()
            values = self.diagnostics.values(LINK)
            self.assertEqual(int(values['times the port was lost']), lost + 1)
        self.await_rest()

    def test_refuses_faults_that_there_are_not(self):
        answer = self.inject('saturated_sensor', 'both', 1.0, 1.0)
        self.assertFalse(answer.success)
        self.assertIn('closed_port', answer.message)

    def test_refuses_amplitudes_that_nobody_can_want(self):
        for message, says in ((tactile(slow=NAN), 'amplitudes_40[0] = nan'),
                              (tactile(fast=-1.0), 'amplitudes_320[0] = -1'),
                              (tactile(slow=1001.0), 'allowed are numbers from 0 to 1000 um'),
                              (tactile(frame='thumb_tactile'), 'allowed is index_tactile')):
            refused = int(self.diagnostics.values(INDEX)['amplitudes refused'])
            self.publisher.publish(message)
            self.eventually(
                lambda: int(self.diagnostics.values(INDEX)['amplitudes refused']) == refused + 1,
                f'refusal: {says}')
            values = self.diagnostics.values(INDEX)
            self.assertIn(says, values['why the last amplitudes were refused'])
            self.assertEqual(self.slow(), 0.0)

    def test_plays_a_contactor(self):
        path = rospy.get_param('~sound')
        with source(self.publisher):
            self.await_displayed()
            time.sleep(1.2)
        with wave.open(path) as sound:
            self.assertEqual(sound.getframerate(), 44100)
            self.assertGreater(sound.getnframes(), 44100)
        values = self.diagnostics.values('contactor emulator')
        self.assertAlmostEqual(float(values['largest displacement (um)']), 25.0, delta=1.0)

    @classmethod
    def tearDownClass(cls):
        os.remove(rospy.get_param('~sound'))


if __name__ == '__main__':
    if '--source' in sys.argv:
        be_a_source()
    else:
        rospy.init_node('tactile_driver_test')
        rostest.rosrun('haptex', 'tactile_driver', TactileDriver)
