#!/usr/bin/python3
"""The doctor on this machine, as a person starts it, with emulated devices and without a master."""
import os
import pathlib
import re
import socket
import subprocess
import unittest

import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from ros_fixtures import eventually

DOCTOR = pathlib.Path(__file__).resolve().parents[2] / 'scripts/doctor'


def examine(*arguments, **environment):
    """@returns what it prints, without the spaces of its columns, and the exit status"""
    result = subprocess.run([str(DOCTOR), *arguments], env=dict(os.environ, **environment), check=False,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return re.sub(' +', ' ', result.stdout), result.returncode


def free_port():
    with socket.socket() as probe:
        probe.bind(('', 0))
        return probe.getsockname()[1]


class Doctor(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.port, cls.contactors = (rospy.get_param(f'~{name}') for name in ('port', 'contactors'))
        eventually(lambda: os.path.exists(cls.port) and os.path.exists(cls.contactors), 'the links')

    def test_the_device_says_who_it_is_and_its_motors_stay_off(self):
        forces = []
        rospy.Subscriber('emulator/index/motor_force', WrenchStamped, forces.append)
        eventually(lambda: forces, 'what the motors of the emulator do')
        text, status = examine('--device', self.port)
        self.assertRegex(text, rf'ok device {re.escape(self.port)}: exoskeleton, version 1, firmware \d+')
        self.assertRegex(text, r'device the force sensor of the index shows \d\.\d\d')
        self.assertNotIn('Traceback', text)
        self.assertEqual(status, int('prevent running' in text), text)
        self.assertEqual({(f.wrench.force.x, f.wrench.force.y, f.wrench.force.z) for f in forces},
                         {(0.0, 0.0, 0.0)})

    def test_contactors_say_who_they_are(self):
        text, _ = examine('--device', self.contactors)
        self.assertRegex(text, 'ok device .*: contactors, version 129')
        self.assertIn('is not measured', text)

    def test_a_port_that_is_in_use_is_left_alone(self):
        descriptor = os.open(self.port, os.O_RDWR | os.O_NOCTTY)
        self.addCleanup(os.close, descriptor)
        text, status = examine('--device', self.port)
        self.assertRegex(text, rf'error device .* is in use by python3\S* \({os.getpid()}\)')
        self.assertEqual(status, 1)

    def test_the_nodes_of_this_graph_are_told(self):
        text, _ = examine()
        self.assertIn('haptex runs in /haptex: exoskeleton_emulator, tactile_emulator;', text)
        self.assertIn('ok clock all nodes that answer are on this machine', text)

    def test_without_a_master_it_says_so_and_goes_on(self):
        text, status = examine(ROS_MASTER_URI=f'http://127.0.0.1:{free_port()}', ROS_IP='127.0.0.1')
        self.assertIn('note graph no master runs', text)
        self.assertIn('ok network', text)
        self.assertIn("ok network the ROS_IP '127.0.0.1' leads to 127.0.0.1", text)
        self.assertEqual(status, int('prevent running' in text), text)

    def test_an_address_of_another_machine_prevents_running(self):
        text, status = examine(ROS_IP='192.0.2.1')  # for documentation, RFC 5737
        self.assertIn('leads to 192.0.2.1, which is no address of this machine', text)
        self.assertEqual(status, 1)

    def test_a_master_that_does_not_answer_is_given_up(self):
        with socket.socket() as silent:
            silent.bind(('127.0.0.1', 0))
            silent.listen()
            text, _ = examine(ROS_MASTER_URI=f'http://127.0.0.1:{silent.getsockname()[1]}')
        self.assertIn('no master runs', text)


if __name__ == '__main__':
    rospy.init_node('doctor_test')
    rostest.rosrun('haptex', 'doctor', Doctor)
