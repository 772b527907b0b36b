#!/usr/bin/python3
"""Nodes end at once, forces first: by SIGINT, SIGTERM and shutdown calls, at rest and under contact,
and so does a whole launch."""
import collections
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import time
import xmlrpc.client

import rosgraph
import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from haptex.msg import ServoForce
from ros_fixtures import WAIT, DeviceTest, Diagnostics, process_of

FELT = 0.05  # N
NO_FORCE = 0.01  # N, of motors
GONE = 5.0  # s, from the signal to the end of the process: 0.2 to 0.5 s unless the machine is busy
UNFELT = 0.02  # s, from the end of a node that commands no force itself to zero force
MOST_WORK = 0.05  # s, of a thread meanwhile, beyond what it did in as long a time before
ATTEMPTS = 3  # a machine that stands still trips the watchdog, too, though not each time
WATCHED = 0.5  # s, before, at least
TICK = 1.0 / os.sysconf('SC_CLK_TCK')  # s, what the system counts a thread's work in
DEVICE = 'exoskeleton emulator'  # name in the diagnostics
# What a shutdown call may bring: who asks and why, or anything.
CALLS = (('/test', 'a test'), ('/test', 17), ('/test', {'why': ['a', 1.5]}), ('/test',), ())


def thread_work(process):
    """Seconds of processor time by thread; empty if the process is gone."""
    work = {}
    try:
        for thread in os.listdir(f'/proc/{process}/task'):
            with open(f'/proc/{process}/task/{thread}/stat', encoding='ascii') as stat:
                fields = stat.read().rsplit(')', 1)[1].split()
            work[thread] = TICK * (int(fields[11]) + int(fields[12]))
    except OSError:
        pass
    return work


def is_alive(process):
    try:
        with open(f'/proc/{process}/stat', encoding='ascii') as stat:
            return stat.read().rsplit(')', 1)[1].split()[0] != 'Z'
    except OSError:
        return False


class Forces:
    """Stamps (s) and sizes (N) of the last forces on a topic."""

    def __init__(self, topic, kind, force_of):
        self.series = collections.deque(maxlen=5000)
        self.force_of = force_of
        rospy.Subscriber(topic, kind, self.take, tcp_nodelay=True)

    def take(self, message):
        force = self.force_of(message)
        self.series.append((message.header.stamp.to_sec(),
                            (force.x ** 2 + force.y ** 2 + force.z ** 2) ** 0.5))

    @property
    def size(self):
        stamp, size = self.series[-1] if self.series else (0.0, 0.0)
        return size if rospy.get_time() - stamp < 0.1 else 0.0

    def until(self, end):
        return [(stamp, size) for stamp, size in list(self.series) if stamp <= end]


class Stopping(DeviceTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.shared = cls.driver == cls.renderer
        # The others are the same programs in both ways.
        cls.nodes = (cls.driver,) if cls.shared else (cls.renderer, cls.driver, 'cloth_simulation',
                                                      'proximity', 'exoskeleton_emulator')
        cls.diagnostics = Diagnostics()
        cls.commanded = Forces('index/servo_cf', ServoForce, lambda message: message.force)
        cls.driven = Forces('emulator/index/motor_force', WrenchStamped,
                            lambda message: message.wrench.force)

    def await_touch(self):
        """Commanded and driven."""
        self.await_contact(lambda: self.commanded.size > FELT and self.driven.size > FELT)

    def end(self, node, way, make_ready):
        """Ends it, once it is made ready for that, and waits until another one of its name is there.
        @returns when it was asked and when it had gone, s"""
        self.eventually(lambda: process_of(node), f'the node {node}')
        victim = process_of(node)
        uri = rosgraph.Master('/test').lookupNode(rospy.resolve_name(node))
        earlier, watched = thread_work(victim), time.monotonic()
        time.sleep(WATCHED)
        make_ready()
        before, watched = thread_work(victim), time.monotonic() - watched
        asked = rospy.get_time()
        if isinstance(way, tuple):
            self.assertEqual(xmlrpc.client.ServerProxy(uri).shutdown(*way), [1, '', 0])
        else:
            os.kill(victim, getattr(signal, way))
        after = before
        while is_alive(victim) and rospy.get_time() < asked + 2.0 * GONE:
            after = thread_work(victim) or after
            time.sleep(0.01)
        gone = rospy.get_time()
        rate = {thread: (before[thread] - earlier.get(thread, 0.0)) / watched for thread in before}
        work = {thread: after[thread] - before.get(thread, 0.0) for thread in after}
        more = max((work[thread] - rate.get(thread, 0.0) * (gone - asked) for thread in work),
                   default=0.0)
        print(f'{node}: gone {1e3 * (gone - asked):.0f} ms after {way}, busiest thread '
              f'{1e3 * max(work.values(), default=0.0):.0f} ms')
        self.assertLess(gone - asked, GONE, f'{node} by {way}')
        # Twice a tick: both works are counted in ticks.
        self.assertLessEqual(more, MOST_WORK + 2.0 * TICK, f'a thread of {node} by {way}')
        self.eventually(lambda: process_of(node) not in (None, victim), f'another {node}')
        return asked, gone

    def watchdog_trips(self):
        return int(self.diagnostics.values(DEVICE)['watchdog trips of the firmware'])

    def check_forces_first(self, node, way, asked, gone):
        """Who commands and who drives takes the force to zero before it goes; where the others are
        missing the force falls by itself."""
        if node == 'exoskeleton_emulator':
            return  # there is no device any more
        own = node in (self.renderer, self.driver)
        end = gone if own else gone + UNFELT
        self.assertTrue(any(size > FELT for stamp, size in self.driven.until(asked)
                            if stamp > asked - 0.1), f'a force before {node} was ended')
        listeners = [(self.driven, NO_FORCE)] if node == self.driver else []
        if node != self.driver or self.shared:
            listeners.append((self.commanded, 0.0))
        for listener, zero in listeners:
            stamp, size = listener.until(end)[-1]
            self.assertGreater(stamp, asked, f'a force after {node} was ended by {way}')
            self.assertLessEqual(size, zero, f'the last force before {node} had gone by {way}')

    def test_nodes_end_under_contact(self):
        for node in self.nodes:
            for way in ('SIGTERM',) if self.shared else ('SIGINT', 'SIGTERM'):
                for _ in range(ATTEMPTS):
                    self.recover()
                    trips = self.watchdog_trips() if node == self.driver else None
                    asked, gone = self.end(node, way, self.await_touch)
                    self.check_forces_first(node, way, asked, gone)
                    if trips is None or self.watchdog_trips() == trips:
                        break
                else:  # the device ends the force of a dead driver
                    self.fail(f'the watchdog of the firmware trips whenever {node} ends by {way}')

    def test_nodes_end_at_rest(self):
        calls = list(CALLS)
        for node in self.nodes:
            for way in (calls.pop(0), 'SIGINT'):
                self.disable()
                self.end(node, way, lambda: self.eventually(
                    lambda: self.driven.size <= NO_FORCE, 'motors that are off'))

    def test_a_launch_ends_without_escalation(self):
        with socket.socket() as free:
            free.bind(('', 0))
            port = free.getsockname()[1]
        here = pathlib.Path(__file__).resolve().parent
        environment = dict(os.environ, ROS_MASTER_URI=f'http://127.0.0.1:{port}')
        environment.pop('ROS_NAMESPACE', None)  # of this test
        link = os.path.join(tempfile.mkdtemp(), 'exoskeleton')
        launch = subprocess.Popen(
            ['roslaunch', '-p', str(port), 'haptex', 'haptex.launch', f'port:={link}',
             'emulator:=true', f'path:={here}/hold_edge.yaml',
             f'shared:={str(self.shared).lower()}'], env=environment,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.addCleanup(launch.wait)
        self.addCleanup(launch.terminate)  # with its nodes, if it is still there
        watcher = subprocess.Popen([sys.executable, f'{here}/watch_force.py', 'index', str(FELT)],
                                   env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                   text=True)
        self.addCleanup(watcher.kill)
        self.assertIn('felt\n', iter(watcher.stdout.readline, ''))  # after what rospy says
        begin = time.monotonic()
        launch.send_signal(signal.SIGINT)
        output, _ = launch.communicate(timeout=30.0)
        took = time.monotonic() - begin
        last, _ = watcher.communicate('gone\n', timeout=WAIT)
        print(f'a launch is gone {took:.1f} s after SIGINT; {last.strip()}')
        self.assertNotIn('escalating', output)
        self.assertLess(took, 2.0 * GONE)  # roslaunch itself waits for one node after the other
        self.assertIn('the last force: 0 N\n', last)


if __name__ == '__main__':
    rospy.init_node('stopping_test')
    rostest.rosrun('haptex', 'stopping', Stopping)
