#!/usr/bin/python3
"""Nodes end at once, forces first: by SIGINT, SIGTERM and `rosnode kill`, at rest and under contact,
and so does a whole launch."""
import os
import signal
import socket
import subprocess
import tempfile
import time
import xmlrpc.client

import rosgraph
import roslib.packages
import rospy
import rostest
from haptex.msg import OperatingState, ServoForce
from ros_fixtures import WAIT, NodeTest
from std_srvs.srv import Trigger

FELT = 0.05  # N
GONE = 1.0  # s, from the signal to the end of the process
MOST_WORK = 0.05 * GONE  # s, of a thread meanwhile: 5 % of a core
TICK = 1.0 / os.sysconf('SC_CLK_TCK')  # s, what the system counts a thread's work in
NODES = ('force_renderer', 'exoskeleton_driver', 'cloth_simulation', 'proximity',
         'exoskeleton_emulator')
WAYS = ('SIGINT', 'SIGTERM')


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


class Stopping(NodeTest):
    @classmethod
    def setUpClass(cls):
        cls.ask = {}
        for name in ('enable', 'home', 'clear_fault'):
            rospy.wait_for_service(f'exoskeleton/{name}', WAIT)
            cls.ask[name] = rospy.ServiceProxy(f'exoskeleton/{name}', Trigger)
        cls.state = None
        cls.force = 0.0
        rospy.Subscriber('exoskeleton/operating_state', OperatingState, cls.take_state)
        rospy.Subscriber('index/servo_cf', ServoForce, cls.take_force, tcp_nodelay=True)

    @classmethod
    def take_state(cls, state):
        cls.state = state

    @classmethod
    def take_force(cls, message):
        cls.force = (message.force.x ** 2 + message.force.y ** 2 + message.force.z ** 2) ** 0.5

    @staticmethod
    def process(node):
        """Its number, or None while it does not answer."""
        try:
            uri = rosgraph.Master('/test').lookupNode(rospy.resolve_name(node))
            return xmlrpc.client.ServerProxy(uri).getPid('/test')[2]
        except (OSError, rosgraph.MasterException):
            return None

    def recover(self):
        """Homed and enabled, whatever was before."""
        def is_ready():
            type(self).state = None
            time.sleep(0.15)  # the next operating state
            state = self.state
            if not state:
                return False
            if state.state == 'ENABLED' and state.is_homed:
                return True
            request = ('clear_fault' if state.state == 'FAULT' else
                       None if state.is_busy else 'enable' if state.is_homed else 'home')
            if request:
                try:
                    self.ask[request]()
                except rospy.ServiceException:
                    pass  # the driver is not there yet
            return False

        self.eventually(is_ready, lambda: f'homed and enabled: {self.state}', 2 * WAIT)

    def await_contact(self):
        def felt():
            if not self.state or self.state.state != 'ENABLED':
                self.recover()
            return self.force > FELT

        self.eventually(felt, 'contact', 2 * WAIT)

    def stop(self, node, way):
        """Ends it and waits until another one of its name is there."""
        self.eventually(lambda: self.process(node), f'the node {node}')
        victim = self.process(node)
        before = thread_work(victim)
        begin = time.monotonic()
        if way == 'rosnode kill':
            uri = rosgraph.Master('/test').lookupNode(rospy.resolve_name(node))
            xmlrpc.client.ServerProxy(uri).shutdown('/test', 'a test')
        else:
            os.kill(victim, getattr(signal, way))
        after = before
        while is_alive(victim) and time.monotonic() < begin + 5.0 * GONE:
            after = thread_work(victim) or after
            time.sleep(0.01)
        took = time.monotonic() - begin
        work = max((after[thread] - before.get(thread, 0.0) for thread in after), default=0.0)
        print(f'{node}: gone {1e3 * took:.0f} ms after {way}, busiest thread {1e3 * work:.0f} ms')
        self.assertLess(took, GONE, f'{node} by {way}')
        self.assertLessEqual(work, MOST_WORK + TICK, f'a thread of {node} by {way}')
        self.eventually(lambda: self.process(node) not in (None, victim), f'another {node}')

    def test_nodes_end_under_contact(self):
        for node in NODES:
            for way in WAYS:
                self.recover()
                self.await_contact()
                self.stop(node, way)

    def test_nodes_end_at_rest(self):
        for node in NODES:
            self.stop(node, 'rosnode kill')
            self.stop(node, 'SIGINT')

    def test_a_launch_ends_without_escalation(self):
        with socket.socket() as free:
            free.bind(('', 0))
            port = free.getsockname()[1]
        paths = roslib.packages.get_pkg_dir('haptex') + '/test/nodes'
        environment = dict(os.environ, ROS_MASTER_URI=f'http://127.0.0.1:{port}')
        link = os.path.join(tempfile.mkdtemp(), 'exoskeleton')
        launch = subprocess.Popen(
            ['roslaunch', '-p', str(port), 'haptex', 'haptex.launch', f'port:={link}',
             'emulator:=true', f'path:={paths}/hold_edge.yaml'], env=environment,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.addCleanup(launch.kill)
        time.sleep(8.0)
        begin = time.monotonic()
        launch.send_signal(signal.SIGINT)
        output, _ = launch.communicate(timeout=30.0)
        took = time.monotonic() - begin
        print(f'a launch is gone {took:.1f} s after SIGINT')
        self.assertNotIn('escalating', output)
        self.assertLess(took, 5.0)  # roslaunch itself waits for one node after the other


if __name__ == '__main__':
    rospy.init_node('stopping_test')
    rostest.rosrun('haptex', 'stopping', Stopping)
