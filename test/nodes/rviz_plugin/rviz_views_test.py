#!/usr/bin/python3
"""Views of rviz with our displays and panel under Xvfb: test_rviz_views, which says what is tested."""
import os
import pathlib
import re
import signal
import socket
import subprocess
import tempfile
import time
import unittest

import rosgraph
import roslib.packages
import rospy
import rostest
from haptex.msg import Contact
from haptex.srv import SetFabric

LONGEST = 480.0  # s, of the program
WAIT = 60.0  # s
RECORDED = 20.0  # s
FABRICS = ['wool', 'denim', 'silk_habutae', 'linear']


def eventually(happens, what):
    end = time.monotonic() + WAIT
    while not happens():
        if time.monotonic() > end:
            raise AssertionError(what)
        time.sleep(0.05)


def listens(port):
    try:
        socket.create_connection(('127.0.0.1', port), 1.0).close()
        return True
    except OSError:
        return False


class Display:
    """Of Xvfb, as long as this lives."""

    def __init__(self):
        read, write = os.pipe()
        self.process = subprocess.Popen(['Xvfb', '-displayfd', str(write), '-noreset', '-screen', '0', '1400x900x24'],
                                        pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as pipe:
            self.name = f':{pipe.readline().strip()}'

    def close(self):
        self.process.terminate()
        self.process.wait()


class Master:
    """Of ROS, for programs that publish a cloth and a hand of their own, as long as this lives."""

    def __init__(self):
        with socket.socket() as probe:
            probe.bind(('', 0))
            port = probe.getsockname()[1]
        self.process = subprocess.Popen(['rosmaster', '--core', '-p', str(port)], stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        self.uri = f'http://127.0.0.1:{port}'
        eventually(lambda: listens(port), 'the master does not start')

    def close(self):
        self.process.kill()
        self.process.wait()


class RvizViews(unittest.TestCase):
    def setUp(self):
        self.display = Display()
        self.addCleanup(self.display.close)
        self.home = tempfile.TemporaryDirectory()
        self.addCleanup(self.home.cleanup)
        self.environment = {**os.environ, 'DISPLAY': self.display.name, 'HOME': self.home.name,
                            'LIBGL_ALWAYS_SOFTWARE': '1', 'QT_X11_NO_MITSHM': '1'}

    def start_master(self):
        master = Master()
        self.addCleanup(master.close)
        return master

    def run_program(self, master, *arguments, **environment):
        environment = {**self.environment, 'ROS_MASTER_URI': master.uri, **environment}
        program = roslib.packages.find_node('haptex', 'test_rviz_views')[0]
        with open(pathlib.Path(self.home.name, 'log'), 'w+', encoding='utf-8') as log:
            run = subprocess.run([program, *arguments], env=environment, stdout=log,
                                 stderr=subprocess.STDOUT, timeout=LONGEST, check=False)
            log.seek(0)
            output = log.read()
        failed = [line for line in output.splitlines() if 'FAILED' in line or 'Failure' in line]
        self.assertEqual(run.returncode, 0, '\n'.join(failed) + output[-3000:])
        return output

    def test_nothing_that_people_do_to_a_view_ends_it(self):
        output = self.run_program(self.start_master(), '--gtest_filter=-*AMaster*:*AReplayedBag*')
        self.assertIn('[  PASSED  ] 12 tests', output)
        figures = re.findall(r'^(?:rviz alone|a service that ).*$', output, re.MULTILINE)
        self.assertEqual(len(figures), 2, output)
        print('\n'.join(figures))

    def test_a_master_that_hangs_or_dies_keeps_nothing(self):
        master = self.start_master()
        output = self.run_program(master, '--gtest_filter=*AMaster*', HAPTEX_MASTER=str(master.process.pid))
        figures = re.findall(r'^a master that .*$', output, re.MULTILINE)
        self.assertEqual(len(figures), 3, output)
        print('\n'.join(figures))

    def test_a_replayed_bag_is_said_by_the_panel(self):
        bag = pathlib.Path(self.home.name, 'session.bag')
        recorder = roslib.packages.find_node('haptex', 'record_topics')[0]
        with subprocess.Popen([recorder, str(bag), 'haptex/.*', '/diagnostics', '/tf'],
                              env={**os.environ, 'ROS_NAMESPACE': '/'}) as record:
            time.sleep(RECORDED)
            record.send_signal(signal.SIGINT)
        master = self.start_master()
        rosgraph.Master('/rviz_views_test', master.uri).setParam('/use_sim_time', True)
        with subprocess.Popen(['rosbag', 'play', '--clock', '--quiet', str(bag), '__name:=player'],
                              env={**os.environ, 'ROS_MASTER_URI': master.uri, 'ROS_NAMESPACE': '/'},
                              stdin=subprocess.DEVNULL) as player:
            self.addCleanup(lambda: player.poll() is None and player.kill())
            output = self.run_program(master, '--gtest_filter=*AReplayedBag*', HAPTEX_PLAYER='/player')
        self.assertIn('[  PASSED  ] 1 test', output)
        print(re.findall(r'^beside a replayed bag: .*$', output, re.MULTILINE)[0])

    def test_the_fabric_changes_200_times_while_it_is_touched_and_rviz_draws_it(self):
        config = pathlib.Path(roslib.packages.get_pkg_dir('haptex'), 'rviz', 'haptex.rviz')
        set_fabric = rospy.ServiceProxy('cloth/set_fabric', SetFabric)
        set_fabric.wait_for_service(WAIT)
        touches = []
        for finger in ['index', 'thumb']:
            rospy.Subscriber(f'{finger}/contact', Contact, lambda contact: contact.touching and touches.append(1))
        eventually(lambda: touches, 'the emulated hand does not touch the cloth')
        with subprocess.Popen(['rviz', '-d', str(config), '__ns:=' + rospy.get_namespace()],
                              env=self.environment, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as rviz:
            self.addCleanup(lambda: rviz.poll() is None and rviz.kill())
            master = rosgraph.Master('/rviz_views_test')
            topic = rospy.resolve_name('cloth/state')
            eventually(lambda: any(name == topic and any('rviz' in node for node in nodes)
                                   for name, nodes in master.getSystemState()[1]),
                       'rviz does not look at the cloth')
            for i in range(200):
                touches.clear()
                eventually(lambda: touches, f'nothing is touched any more after {i} changes')
                self.assertTrue(set_fabric(FABRICS[i % len(FABRICS)]).success)
                self.assertIsNone(rviz.poll(), f'rviz has ended after {i} changes')
            time.sleep(2.0)  # to draw the last
            self.assertIsNone(rviz.poll())
            rviz.terminate()


if __name__ == '__main__':
    rospy.init_node('rviz_views_test')
    rostest.rosrun('haptex', 'rviz_views', RvizViews)
