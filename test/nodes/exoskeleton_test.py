#!/usr/bin/python3
"""The promises of exoskeleton_driver with a real exoskeleton_emulator at its port."""
import math
import os
import signal
import subprocess
import sys
import threading
import time

import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import PoseStamped, TwistStamped, Vector3, WrenchStamped
from haptex.msg import OperatingState, ServoForce, ServoForces
from haptex.srv import InjectFault
from ros_fixtures import WAIT, Diagnostics, NodeTest, process_of
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger
from visualization_msgs.msg import MarkerArray

LINK, LOOP = 'exoskeleton link', 'exoskeleton loop'  # names in the diagnostics
FORCE = 'exoskeleton force of the index'
NAN, INFINITY = float('nan'), float('inf')
HELD = Vector3(0.0, 0.0, 3.0)  # N, stretches the index, away from the stops
CLOSE = 0.3  # N: of noise and friction, and of a finger that comes to rest
NO_FORCE = 0.01  # N, of motors
FRAME_FAULTS = ('drop', 'drop_bytes', 'duplicate', 'flip', 'truncate', 'delay', 'reorder',
                'garbage', 'oversize', 'wrong_version')


def norm(vector):
    return math.sqrt(vector.x ** 2 + vector.y ** 2 + vector.z ** 2)


def difference(a, b):
    return norm(Vector3(a.x - b.x, a.y - b.y, a.z - b.z))


def command(force=Vector3(0.0, 0.0, 0.0), age=0.0, frame='hand_base', stiffness=0.0, damping=0.0):
    message = ServoForce(force=force)
    message.stiffness[0], message.damping[4] = stiffness, damping
    message.header.frame_id = frame
    message.header.stamp = rospy.Time.now() - rospy.Duration(age)
    return message


class Listener:
    """The last message of a topic; of a WrenchStamped one also the largest force, and the stamp of
    the last that was not close to none."""

    def __init__(self, topic, kind, close=CLOSE):
        self.last = None
        self.close_to_none = close
        self.largest = 0.0
        self.last_felt = None
        self.subscriber = rospy.Subscriber(topic, kind, self.take, tcp_nodelay=True)

    def take(self, message):
        self.last = message
        if isinstance(message, WrenchStamped):
            force = norm(message.wrench.force)
            self.largest = max(self.largest, force)
            if force >= self.close_to_none:
                self.last_felt = message.header.stamp

    @property
    def force(self):
        return self.last.wrench.force if self.last else Vector3(NAN, NAN, NAN)

    def close(self):
        self.subscriber.unregister()


class Exoskeleton(NodeTest):
    @classmethod
    def setUpClass(cls):
        cls.ask = {}
        for name in ('enable', 'disable', 'pause', 'home', 'clear_fault'):
            rospy.wait_for_service(f'exoskeleton/{name}', WAIT)
            cls.ask[name] = rospy.ServiceProxy(f'exoskeleton/{name}', Trigger)
        for name in ('inject_fault', 'power_cycle'):
            rospy.wait_for_service(f'emulator/{name}', WAIT)
        cls.inject = staticmethod(rospy.ServiceProxy('emulator/inject_fault', InjectFault))
        cls.cycle_power = staticmethod(rospy.ServiceProxy('emulator/power_cycle', Trigger))
        cls.state = Listener('exoskeleton/operating_state', OperatingState)
        cls.diagnostics = Diagnostics()
        cls.commander = rospy.Publisher('index/servo_cf', ServoForce, queue_size=10,
                                        tcp_nodelay=True)

    def setUp(self):
        self.measured = Listener('index/measured_cf', WrenchStamped)
        self.addCleanup(self.measured.close)
        self.felt = Listener('emulator/index/contact_force', WrenchStamped)
        self.addCleanup(self.felt.close)
        self.driven = Listener('emulator/index/motor_force', WrenchStamped, NO_FORCE)
        self.addCleanup(self.driven.close)
        self.recover()

    def granted(self, name):
        """Asks until it is granted: the device may not be there yet, or a driver has just ended."""
        answers = []

        def asked():
            try:
                answers.append(self.ask[name]())
            except rospy.ServiceException as error:
                answers.append(error)
                return False
            if not answers[-1].success:
                time.sleep(0.1)
            return answers[-1].success

        self.eventually(asked, lambda: f'{name}: {answers[-1]}')

    def recover(self):
        """Whatever was before: homed, enabled, and nobody commands."""
        def is_ready():
            state = self.state.last
            if not state:
                return False
            if state.state == 'FAULT':
                self.granted('clear_fault')
            elif state.is_busy:
                pass
            elif not state.is_homed:
                self.granted('home')
            elif state.state != 'ENABLED':
                self.granted('enable')
            else:
                return True
            time.sleep(0.15)  # the next operating state
            return False

        self.eventually(is_ready, 'homed and enabled', 3 * WAIT)

    def hold(self, force=HELD, *options):
        """Another process that commands the force."""
        script = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'hold_force.py')
        process = subprocess.Popen([sys.executable, script, 'index', str(force.x), str(force.y),
                                    str(force.z), *options])
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def await_held(self):
        """Where the machine stood still for 10 ms, the device has to be made ready again."""
        def held():
            if not self.state.last or self.state.last.state != 'ENABLED':
                self.recover()
            return difference(self.measured.force, HELD) < CLOSE

        self.eventually(held, lambda: 'the force held: ' + self.diagnostics.last[FORCE].message)

    def await_no_force(self, killed, who, also=()):
        """Within a second, which is generous: how long it took is printed."""
        def gone():
            return all(norm(listener.force) < listener.close_to_none
                       for listener in (self.driven, self.felt, *also))

        self.eventually(gone, f'no force without a {who}', 1.0)
        for listener, what in ((self.driven, 'motor force'), (self.felt, 'force on the finger')):
            took = 1e3 * (listener.last_felt - killed).to_sec()
            print(f'{what} below {listener.close_to_none} N {took:.1f} ms after the {who} was killed')

    def test_commanded_force_reaches_the_finger(self):
        self.hold()
        self.await_held()
        self.eventually(lambda: difference(self.felt.force, HELD) < CLOSE, 'the force felt')
        self.assertEqual(self.measured.last.header.frame_id, 'hand_base')
        self.assertLess(abs((rospy.Time.now() - self.measured.last.header.stamp).to_sec()), 0.5)

    def test_workspace_is_shown_and_the_distances_to_its_rims_are_told(self):
        markers = rospy.wait_for_message('exoskeleton/workspace_markers', MarkerArray, WAIT).markers
        self.assertEqual([marker.header.frame_id for marker in markers],
                         ['world', 'hand_base', 'hand_base'])
        self.recover()
        for finger in ('index', 'thumb'):
            values = self.diagnostics.values(f'exoskeleton place of the {finger}')
            for rim, largest in (('what the fingertip reaches', 50.0), ('the workspace', 200.0)):
                distance = float(values[f'to the rim of {rim} (mm)'])
                self.assertGreater(distance, -largest)
                self.assertLess(distance, largest)
        self.assertEqual(self.diagnostics.next('exoskeleton weight').level, 0)

    def count_out_of_order(self):
        return int(self.diagnostics.values(FORCE)['commands dropped: out of order'])

    def test_forces_of_both_fingers_in_one_message(self):
        """Beside the same forces one by one, which are not counted as out of order."""
        publisher = rospy.Publisher('exoskeleton/servo_cf', ServoForces, queue_size=1,
                                    tcp_nodelay=True)
        self.addCleanup(publisher.unregister)
        thumb = Listener('thumb/measured_cf', WrenchStamped)
        self.addCleanup(thumb.close)
        forces = [ServoForce(force=HELD), ServoForce(force=Vector3(0.0, 0.0, 0.5 * HELD.z))]

        def reached():
            for force in forces:
                force.header.frame_id = 'hand_base'
                force.header.stamp = rospy.Time.now()
            publisher.publish(ServoForces(forces=forces))
            self.commander.publish(forces[0])
            time.sleep(0.003)
            if not self.state.last or self.state.last.state != 'ENABLED':
                self.recover()
            return (difference(self.measured.force, HELD) < CLOSE and
                    difference(thumb.force, forces[1].force) < CLOSE)

        self.eventually(reached, 'the forces of both fingers')
        out_of_order = self.count_out_of_order()
        messages = 500
        for _ in range(messages):
            reached()
        time.sleep(1.1)  # the next diagnostics
        # Not none: one may have come after the next message.
        self.assertLess(self.count_out_of_order() - out_of_order, messages // 10)

    def test_fingertip_is_where_tf_says(self):
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        pose = Listener('index/measured_cp', PoseStamped)
        twist = Listener('index/measured_cv', TwistStamped)
        joints = Listener('joint_states', JointState)
        for each in (pose, twist, joints):
            self.addCleanup(each.close)
        self.addCleanup(listener.unregister)

        def agree():
            if not pose.last or not buffer.can_transform('hand_base', 'index_tip', rospy.Time()):
                return False
            there = buffer.lookup_transform('hand_base', 'index_tip', rospy.Time())
            return difference(there.transform.translation, pose.last.pose.position) < 1e-3

        self.eventually(agree, 'the same place by tf and by measured_cp')
        self.eventually(lambda: twist.last and joints.last, 'velocity and joints')
        self.assertEqual(len(joints.last.name), 8)
        self.assertLess(norm(twist.last.twist.linear), 0.1)  # the hand rests
        for each in (pose, twist, joints):
            self.assertEqual(each.last.header.frame_id, 'hand_base')

    def test_no_force_after_the_commander_was_killed(self):
        commander = self.hold()
        self.await_held()
        self.assertGreater(norm(self.measured.force), CLOSE)
        killed = rospy.Time.now()
        commander.send_signal(signal.SIGKILL)
        self.await_no_force(killed, 'commander', [self.measured])
        self.assertGreater(int(self.diagnostics.values(FORCE)['watchdog trips']), 0)

    def test_knows_at_once_that_a_commander_that_listens_was_killed(self):
        key = 'commanders that have died'
        before = int(self.diagnostics.values(LOOP)[key])
        commander = self.hold(HELD, 'listen')
        self.await_held()
        killed = rospy.Time.now()
        commander.send_signal(signal.SIGKILL)
        self.await_no_force(killed, 'commander that listens', [self.measured])
        self.eventually(lambda: int(self.diagnostics.values(LOOP)[key]) == before + 1, 'its death')

    def test_a_driver_that_stood_still_does_not_say_that_the_device_was_switched_off(self):
        self.hold()
        self.await_held()
        driver = process_of('exoskeleton_driver')
        os.kill(driver, signal.SIGSTOP)
        self.addCleanup(os.kill, driver, signal.SIGCONT)
        self.eventually(lambda: norm(self.driven.force) < NO_FORCE, 'motors that are off', 1.0)
        time.sleep(4.0)  # longer than the pseudo-terminal holds states
        self.state.last = None
        os.kill(driver, signal.SIGCONT)
        self.eventually(lambda: self.state.last, 'a state')
        time.sleep(0.5)
        self.assertNotIn('switched off', self.state.last.fault)
        self.assertTrue(self.state.last.is_homed)
        self.await_held()

    def test_no_force_after_the_driver_was_killed_and_works_when_it_is_back(self):
        self.hold()
        self.await_held()
        driver = process_of('exoskeleton_driver')
        self.assertGreater(norm(self.felt.force), CLOSE)
        killed = rospy.Time.now()
        os.kill(driver, signal.SIGKILL)
        self.await_no_force(killed, 'driver')
        self.eventually(lambda: process_of('exoskeleton_driver') not in (None, driver),
                        'another driver')
        self.state.last = self.measured.last = None  # of the dead one
        self.recover()
        self.await_held()

    def test_drops_and_counts_bad_commands(self):
        bad = {'not finite': lambda: [command(Vector3(0.0, 0.0, number))
                                      for number in (NAN, INFINITY, -INFINITY)],
               'another frame': lambda: [command(HELD, frame='index_tip'), command(HELD, frame='')],
               'too large': lambda: [command(Vector3(1e308, 0.0, 0.0)),
                                     command(stiffness=-1e6), command(damping=1e300)],
               'stiffness or damping not positive semidefinite':
                   lambda: [command(stiffness=-1e3), command(damping=-1.0)],
               'too old': lambda: [command(HELD, age=1.0)],
               'from the future': lambda: [command(HELD, age=-1.0)],
               'out of order': lambda: [command(), command(HELD, age=0.01)]}
        self.eventually(lambda: self.commander.get_num_connections() > 0, 'a connection')
        before = self.diagnostics.values(FORCE)
        self.measured.largest = 0.0
        for messages in bad.values():
            for _ in range(20):
                for message in messages():
                    self.commander.publish(message)
                    time.sleep(0.002)
        after = self.diagnostics.values(FORCE)
        for reason in bad:
            key = f'commands dropped: {reason}'
            self.assertGreater(int(after[key]), int(before[key]), reason)
        self.assertTrue(after['why the last command was dropped'])
        self.assertLess(self.measured.largest, CLOSE)

    def test_says_why_there_is_no_force(self):
        key = 'why there is no force'
        self.eventually(lambda: 'command' in self.diagnostics.values(FORCE)[key], 'nobody commands')
        self.assertTrue(self.ask['pause']().success)
        self.eventually(lambda: 'paused' in self.diagnostics.values(FORCE)[key], 'paused')
        self.assertTrue(self.ask['disable']().success)
        self.eventually(lambda: 'disabled' in self.diagnostics.values(FORCE)[key], 'disabled')
        self.assertEqual(self.state.last.state, 'DISABLED')

    def test_diagnoses_link_and_loop(self):
        link, loop = self.diagnostics.values(LINK), self.diagnostics.values(LOOP)
        self.assertGreater(float(link['states received (1/s)']), 0.0)
        for key in ('states lost', 'corrupt frames', 'bytes of garbage', 'timeouts'):
            self.assertGreaterEqual(int(link[key]), 0)
        granted = loop['SCHED_FIFO']
        self.assertTrue(granted == 'granted' or granted.startswith('not granted: '), granted)
        for when in ('of the last second', 'since the start'):
            jitter = [float(loop[f'wake-up jitter {which} {when} (us)'])
                      for which in ('p50', 'p99', 'p99.9', 'max')]
            self.assertEqual(jitter, sorted(jitter))
            self.assertGreater(jitter[0], 0.0)

    def test_refuses_to_enable_a_device_that_was_switched_off(self):
        self.assertTrue(self.cycle_power().success)
        self.eventually(lambda: self.state.last.state == 'FAULT', 'a fault')
        self.assertTrue(self.state.last.fault)
        self.assertFalse(self.ask['enable']().success)
        self.granted('clear_fault')
        refusal = self.ask['enable']()
        self.assertFalse(refusal.success)
        self.assertTrue(refusal.message)
        self.eventually(lambda: not self.state.last.is_homed, 'not homed')

    def test_answers_others_while_it_homes(self):
        self.granted('disable')
        answers = []
        homing = threading.Thread(target=lambda: answers.append(self.ask['home']()))
        homing.start()
        self.eventually(lambda: self.state.last.is_busy, 'homing')
        for name in ('home', 'enable'):
            self.assertFalse(self.ask[name]().success)
            self.assertTrue(homing.is_alive())
        self.assertTrue(self.ask['disable']().success)
        homing.join(WAIT)
        self.assertFalse(answers[0].success)
        self.assertIn('ended by another request', answers[0].message)

    def suffer(self, faults, duration=0.4):
        """Faults while a force is commanded: both nodes live, the force stays safe and returns."""
        self.recover()
        self.await_held()
        self.felt.largest = self.driven.largest = 0.0
        for fault, direction, probability in faults:
            response = self.inject(fault, direction, probability, duration)
            self.assertTrue(response.success, response.message)
        time.sleep(duration + 0.1)
        self.assertLessEqual(self.felt.largest, 5.0, faults)
        self.assertLessEqual(self.driven.largest, 5.0, faults)
        self.assertEqual([process_of(node) for node in self.nodes], self.processes, faults)
        self.recover()
        self.await_held()

    nodes = ('exoskeleton_driver', 'exoskeleton_emulator')

    def test_force_stays_safe_under_every_fault(self):
        self.processes = [process_of(node) for node in self.nodes]
        self.hold()
        for fault in FRAME_FAULTS:
            self.suffer([(fault, 'both', 0.3)])
        for fault in ('stall', 'closed_port', 'saturated_sensor'):
            self.suffer([(fault, 'both', 1.0)])
        self.suffer([(fault, 'both', 0.1) for fault in FRAME_FAULTS])


if __name__ == '__main__':
    rospy.init_node('exoskeleton_test')
    rostest.rosrun('haptex', 'exoskeleton', Exoskeleton)
