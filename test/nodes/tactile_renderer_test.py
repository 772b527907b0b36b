#!/usr/bin/python3
"""The promises of tactile_renderer alone: contacts and the cloth's fabric come from the test."""
import pathlib
import time

import roslib.packages
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus
from haptex.msg import ClothMesh, Contact, Tactile
from haptex.srv import SetSurface
from ros_fixtures import WAIT, Diagnostics, NodeTest, Repeated, await_connections, eventually
from std_msgs.msg import Header
from visualization_msgs.msg import MarkerArray

NAN = float('nan')
FINGERS = ('index', 'thumb')
STEP = 0.025  # s
CONTACTORS = 24
SURFACE, STEPS, INDEX = 'tactile surface', 'tactile steps', 'tactile array of the index'


def contact(**fields):
    """Slides along weft with 40 mm/s, pressed on with 0.48 N."""
    values = {'touching': True, 'normal_force': 0.48, 'fabric_position': [0.1, 0.1],
              'fabric_velocity': [0.04, 0.0], 'array_origin': [0.1, 0.1],
              'array_x': [1.0, 0.0], 'array_y': [0.0, 1.0],
              'contactor_forces': [0.02] * CONTACTORS}
    values.update(fields)
    return Contact(header=Header(frame_id='world', stamp=rospy.Time.now()), **values)


def no_contact():
    return Contact(header=Header(frame_id='world', stamp=rospy.Time.now()))


def contacts(publisher, make=contact):
    """What `make` makes at about 200 Hz until the end of the with statement."""
    return Repeated(publisher, make, 0.005)


def fabric_file(name):
    """The text of a fabric file of the package."""
    package = pathlib.Path(roslib.packages.get_pkg_dir('haptex'))
    return (package / 'config' / 'fabrics' / f'{name}.yaml').read_text()


class Arrived:
    """Messages of a topic since the construction."""

    def __init__(self, finger):
        self.messages = []
        self.subscriber = rospy.Subscriber(f'{finger}/tactile', Tactile, self.messages.append,
                                           tcp_nodelay=True)
        eventually(lambda: self.messages, f'{finger}/tactile')

    def clear(self):
        del self.messages[:]

    def close(self):
        self.subscriber.unregister()


def largest(message):
    return max(message.amplitudes_40 + message.amplitudes_320)


class TactileRenderer(NodeTest):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service('tactile/set_surface', WAIT)
        cls.set_surface = staticmethod(rospy.ServiceProxy('tactile/set_surface', SetSurface))
        cls.contacts = {finger: rospy.Publisher(f'{finger}/contact', Contact, queue_size=10)
                        for finger in FINGERS}
        cls.meshes = rospy.Publisher('cloth/mesh', ClothMesh, queue_size=10, latch=True)
        cls.diagnostics = Diagnostics()
        await_connections(*cls.contacts.values(), cls.meshes)

    def setUp(self):
        self.arrived = {finger: Arrived(finger) for finger in FINGERS}
        self.wear('wool')
        self.assertTrue(self.set_surface('wool').success)

    def tearDown(self):
        for arrived in self.arrived.values():
            arrived.close()

    def wear(self, fabric, file=None):
        """The cloth gets a fabric, by default with its own file."""
        self.meshes.publish(ClothMesh(header=Header(frame_id='world'), fabrics=[fabric],
                                      fabric_files=[fabric_file(file or fabric)]))

    def eventually_strokes(self, fabric):
        def strokes():
            return self.diagnostics.next(SURFACE).message == f'strokes {fabric}'
        self.eventually(strokes, lambda: self.diagnostics.last[SURFACE].message)

    def eventually_vibrates(self, finger='index'):
        self.arrived[finger].clear()
        self.eventually(lambda: any(largest(message) > 0.0
                               for message in list(self.arrived[finger].messages)),
                   f'the {finger} vibrates')

    def eventually_silent(self, finger='index'):
        def silent():
            last = list(self.arrived[finger].messages)[-4:]
            return len(last) == 4 and not any(largest(message) for message in last)
        self.eventually(silent, f'the {finger} is silent')

    def test_tells_the_amplitudes_every_25_ms_also_without_contact(self):
        for finger in FINGERS:
            self.eventually_silent(finger)
            self.arrived[finger].clear()
        begin = time.monotonic()
        time.sleep(2.5)
        elapsed = time.monotonic() - begin
        for finger in FINGERS:
            messages = list(self.arrived[finger].messages)
            # A busy machine may delay steps, but none is ever early.
            self.assertGreater(len(messages), 0.5 * elapsed / STEP)
            self.assertLess(len(messages), 1.1 * elapsed / STEP + 5)
            self.assertEqual(messages[0].header.frame_id, f'{finger}_tactile')
            self.assertEqual(max(largest(message) for message in messages), 0.0)
            # Each says how long it took, and together they fill the time between first and last.
            span = (messages[-1].header.stamp - messages[0].header.stamp).to_sec()
            self.assertAlmostEqual(sum(message.step_time for message in messages[1:]), span,
                                   delta=0.2)
        place = self.arrived['index'].messages[0].places[0]
        self.assertAlmostEqual(place.x, -0.005)
        self.assertAlmostEqual(place.y, -0.003)

    def test_a_finger_that_slides_vibrates_and_the_other_does_not(self):
        with contacts(self.contacts['index']):
            self.eventually_vibrates('index')
            message = self.arrived['index'].messages[-1]
            self.assertEqual(largest(self.arrived['thumb'].messages[-1]), 0.0)
        self.assertAlmostEqual(message.velocity[0], 0.04)
        self.assertAlmostEqual(message.weft[0], 0.095)
        self.assertAlmostEqual(message.warp[0], 0.097)
        for amplitudes in (message.amplitudes_40, message.amplitudes_320):
            self.assertEqual(len(amplitudes), CONTACTORS)
        self.eventually_silent('index')

    def test_a_finger_that_rests_or_has_left_does_not_vibrate(self):
        for make in (lambda: contact(fabric_velocity=[0.0, 0.0]), no_contact):
            with contacts(self.contacts['index']):
                self.eventually_vibrates()
            with contacts(self.contacts['index'], make):
                self.eventually_silent()

    def test_zero_within_one_step_after_contacts_stop(self):
        with contacts(self.contacts['index']):
            self.eventually_vibrates()
        last = rospy.get_time()
        self.eventually_silent()
        late = [message for message in self.arrived['index'].messages
                if message.header.stamp.to_sec() > last and largest(message) > 0.0]
        # The step in which the last contact came ends after it; two more may, by as long as the
        # last contact was under way.
        self.assertLessEqual(len(late), 3, [m.header.stamp.to_sec() - last for m in late])

    def test_survives_contacts_that_are_not_numbers(self):
        before = int(self.diagnostics.values(INDEX)['contacts dropped'])
        for spoilt in ({'normal_force': NAN}, {'fabric_velocity': [NAN, 0.0]},
                       {'contactor_forces': [-1.0] * CONTACTORS}, {'array_x': [NAN, NAN]}):
            with contacts(self.contacts['index'], lambda: contact(**spoilt)):
                self.eventually(lambda: next(iter(spoilt)) in self.diagnostics.values(INDEX)
                           ['why the last contact was dropped'], f'{spoilt} is dropped')
            self.assertEqual(max(largest(m) for m in self.arrived['index'].messages[-4:]), 0.0)
        self.assertGreater(int(self.diagnostics.values(INDEX)['contacts dropped']), before)
        with contacts(self.contacts['index']):
            self.eventually_vibrates()

    def test_set_surface_tells_what_it_did_or_refuses_and_keeps_the_surface(self):
        response = self.set_surface('denim')
        self.assertTrue(response.success, response.message)
        self.assertIn('denim', response.message)
        for fabric, says in (('velvet', "there is no 'velvet'"), ('', "there is no ''"),
                             ('linear', 'needs the key surface'), ('/no/such.yaml', '/no/such')):
            response = self.set_surface(fabric)
            self.assertFalse(response.success)
            self.assertIn(says, response.message)
        self.eventually_strokes('denim')
        self.assertEqual(self.diagnostics.values(SURFACE)['chosen by'], 'tactile/set_surface')
        with contacts(self.contacts['thumb']):
            self.eventually_vibrates('thumb')

    def test_follows_the_fabric_of_the_cloth(self):
        self.wear('denim')
        self.eventually_strokes('denim')
        self.assertTrue(self.set_surface('wool').success)
        self.wear('denim')  # sent again, it is no other fabric
        self.eventually_strokes('wool')
        self.wear('linen')
        self.eventually_strokes('linen')

    def test_a_cloth_without_a_surface_is_silent_and_diagnostics_tell_what_it_needs(self):
        with contacts(self.contacts['index']):
            self.eventually_vibrates()
            self.wear('linear')
            self.eventually_silent()
            status = self.diagnostics.next(SURFACE)
            self.assertEqual(status.level, DiagnosticStatus.WARN)
            self.assertIn('needs the key surface', status.message)
            self.wear('velvet', 'linen')
            self.eventually(lambda: "'velvet'" in self.diagnostics.next(SURFACE).message,
                       'diagnostics that name the fabric')
            self.wear('wool')
            self.eventually_vibrates()

    def test_diagnostics_tell_surface_steps_and_arrays(self):
        values = self.diagnostics.values(SURFACE)
        self.assertEqual(values['fabric'], 'wool')
        self.assertTrue(values['file'].endswith('config/fabrics/wool.yaml'))
        for key in ('roughness SMD (um)', 'waves'):
            self.assertGreater(float(values[key]), 0.0, key)
        with contacts(self.contacts['index']):
            self.eventually_vibrates()
            computed = 'steps of a finger that were computed'
            before = self.diagnostics.values(STEPS)
            after = self.diagnostics.values(STEPS)
            for key in ('steps', computed):
                self.assertGreater(int(after[key]), int(before[key]), key)
            self.assertGreater(float(after['computing time p50 since the start (us)']), 0.0)
            print('computing time p99 since the start (us): '
                  + after['computing time p99 since the start (us)'])
            self.eventually(lambda: self.diagnostics.next(INDEX).message == 'touches', 'it touches')
        self.eventually(lambda: 'no contacts arrive' in self.diagnostics.next(INDEX).message,
                   'contacts that are missed')
        self.assertEqual(self.diagnostics.last[INDEX].level, DiagnosticStatus.WARN)
        self.diagnostics.next(STEPS)
        before, after = self.diagnostics.values(STEPS), self.diagnostics.values(STEPS)
        self.assertEqual(after[computed], before[computed], 'it is idle')

    def test_computes_nothing_for_nobody(self):
        computed = 'steps of a finger that were computed'
        with contacts(self.contacts['index']):
            self.eventually_vibrates()
            for arrived in self.arrived.values():
                arrived.close()
            self.diagnostics.next(STEPS)  # until the node knows
            before, after = self.diagnostics.values(STEPS), self.diagnostics.values(STEPS)
            self.assertEqual(after[computed], before[computed])
            self.assertEqual(self.diagnostics.next(INDEX).message, 'touches')
            self.arrived['index'] = Arrived('index')
            self.eventually_vibrates()

    def test_markers_show_pads_panels_and_captions(self):
        markers = rospy.wait_for_message('tactile/markers', MarkerArray, WAIT).markers
        self.assertEqual({marker.ns for marker in markers},
                         {'tactile_pads', 'tactile_panels', 'tactile_captions'})


if __name__ == '__main__':
    rospy.init_node('tactile_renderer_test')
    rostest.rosrun('haptex', 'tactile_arrays', TactileRenderer)
