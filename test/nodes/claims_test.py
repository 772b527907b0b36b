#!/usr/bin/python3
"""Requests and messages that claim more than their bytes carry are refused in little memory."""
import struct
import unittest

import rospy
import rostest
from dynamic_reconfigure.srv import Reconfigure, ReconfigureRequest
from haptex.msg import ClothState, ExternalForces
from haptex.srv import AttachParticles, AttachParticlesRequest, SetProperties, SetPropertiesRequest
from ros_fixtures import await_connections, eventually, process_of
from rosgraph_msgs.msg import Log
from std_srvs.srv import SetBool

WAIT = 20.0  # s
CLAIMS = (0x10000000, 0x40000000, 0xffffffff)  # items
HEADER = struct.pack('<IIII', 0, 0, 0, 0)  # of a message: seq, stamp, an empty frame_id
MOST = 100  # MB that a refusal takes


def of_bytes(message_class, content):
    """A message that is sent as these bytes."""
    class Claim(message_class):
        def serialize(self, buff):
            buff.write(content)
    return Claim()


class Claims(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service('cloth/pause', WAIT)
        cls.pause = rospy.ServiceProxy('cloth/pause', SetBool)
        cls.process = process_of('cloth_simulation')

    def memory(self):
        """What the node held at most until now, MB."""
        with open(f'/proc/{self.process}/status', encoding='ascii') as status:
            return next(int(line.split()[1]) for line in status if line.startswith('VmHWM')) / 1024

    def setUp(self):
        self.before = self.memory()

    def tearDown(self):
        self.assertTrue(self.pause(False).success)  # it lives
        self.assertEqual(process_of('cloth_simulation'), self.process)
        self.assertLess(self.memory() - self.before, MOST)

    def test_requests_are_refused_with_what_is_claimed(self):
        services = [('attach', AttachParticles, AttachParticlesRequest, HEADER, 4),
                    ('set_properties', SetProperties, SetPropertiesRequest, b'', 4)]
        for name, service, request, begin, size in services:
            call = rospy.ServiceProxy(f'cloth/{name}', service)
            for claim in CLAIMS:
                with self.assertRaises(rospy.ServiceException) as caught:
                    call(of_bytes(request, begin + struct.pack('<I', claim)))
                self.assertIn(f'at least {claim * size} bytes is claimed: there are 0',
                              str(caught.exception))

    def test_messages_are_dropped_with_a_word_in_the_log(self):
        logged = []
        subscriber = rospy.Subscriber('/rosout', Log, lambda log: logged.append(log.msg))
        eventually(lambda: subscriber.get_num_connections() > 0, 'the log')
        publisher = rospy.Publisher('cloth/external_forces', ExternalForces, queue_size=10)
        await_connections(publisher)
        for claim in CLAIMS:
            says = f'at least {claim * 4} bytes is claimed'
            message = of_bytes(ExternalForces, HEADER + struct.pack('<II', 0, claim))
            eventually(lambda: any(says in text for text in logged), says,
                       meanwhile=lambda: publisher.publish(message))
        self.assertGreater(rospy.wait_for_message('cloth/state', ClothState, WAIT).step, 0)

    def test_services_of_libraries_are_kept_from_the_memory_of_the_machine(self):
        call = rospy.ServiceProxy('cloth_simulation/set_parameters', Reconfigure)
        for claim in CLAIMS:
            with self.assertRaises((rospy.ServiceException, rospy.ROSException)):
                call(of_bytes(ReconfigureRequest, struct.pack('<I', claim)))
        with open(f'/proc/{self.process}/limits', encoding='ascii') as limits:
            line = next(line for line in limits if line.startswith('Max data size'))
        self.assertEqual(line.split()[3], str(4 << 30))


if __name__ == '__main__':
    rospy.init_node('claims_test')
    rostest.rosrun('haptex', 'claims', Claims)
