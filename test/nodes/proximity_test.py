#!/usr/bin/python3
"""The promises of proximity beside a real cloth_simulation, and every request that it refuses."""
import math
import os
import signal

import dynamic_reconfigure.client
import rospy
import rostest
from geometry_msgs.msg import Point, Quaternion, Transform, TransformStamped, Vector3
from haptex.msg import ClothState
from haptex.srv import QueryProximity
from haptex.srv import QueryProximityRequest as Request
from ros_fixtures import WAIT, Diagnostics, NodeTest, process_of
from std_msgs.msg import Header
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

NAN, INFINITY = float('nan'), float('inf')
QUERIES = 'proximity queries'  # name in the diagnostics
# The wool sample hangs in the plane x = 0, from z = 0 to -0.2 m.
BEFORE_THE_MIDDLE = Point(0.01, 0.0, -0.1)
HALF = math.sqrt(0.5)


def request(shape, points=(), radii=(), distance=0.03, frame='world', **fields):
    return Request(header=Header(frame_id=frame), shape=shape, points=list(points),
                   radii=list(radii), distance=distance, **fields)


def sphere(**fields):
    return request(Request.SPHERES, [BEFORE_THE_MIDDLE], [0.004], **fields)


def transform(parent, child, stamp, x):
    """A quarter turn about z, which takes x to y, and then a displacement along x."""
    return TransformStamped(header=Header(stamp=stamp, frame_id=parent), child_frame_id=child,
                            transform=Transform(translation=Vector3(x, 0.0, 0.0),
                                                rotation=Quaternion(0.0, 0.0, HALF, HALF)))


class Proximity(NodeTest):
    @classmethod
    def setUpClass(cls):
        for name in ('proximity/query', 'cloth/pause', 'cloth/reset'):
            rospy.wait_for_service(name, WAIT)
        cls.query = staticmethod(rospy.ServiceProxy('proximity/query', QueryProximity))
        cls.pause = staticmethod(rospy.ServiceProxy('cloth/pause', SetBool))
        cls.reset = staticmethod(rospy.ServiceProxy('cloth/reset', Trigger))
        cls.diagnostics = Diagnostics()
        cls.start = rospy.Time.now()
        cls.static_transforms = rospy.Publisher('/tf_static', TFMessage, latch=True, queue_size=1)
        cls.static_transforms.publish([transform('world', 'finger', cls.start, 0.1),
                                       transform('island', 'palm', cls.start, 0.1)])
        cls.transforms = rospy.Publisher('/tf', TFMessage, latch=True, queue_size=1)
        cls.transforms.publish([transform('world', 'tracker', cls.start, 0.1),
                                transform('world', 'tracker', cls.start + rospy.Duration(1), 0.3)])

    def setUp(self):
        self.assertTrue(self.pause(True).success)
        self.assertTrue(self.reset().success)

        def answers_from_the_start():
            response = self.query(sphere())
            return response.success and response.step == 0

        self.eventually(answers_from_the_start, 'an answer from the start')

    def accepted(self, asked, query=None):
        """The answer, as soon as the node has the cloth and the transforms."""
        answers = []

        def answered():
            answers.append((query or self.query)(asked))
            return answers[-1].success

        self.eventually(answered, answers and answers[-1].message)
        return answers[-1]

    def refused(self, asked, *says):
        response = self.query(asked)
        self.assertFalse(response.success, f'accepted instead of refused: {says}')
        for text in says:
            self.assertIn(text, response.message)
        self.assertEqual((response.distance, response.elements), (INFINITY, []))

    def test_every_shape_has_its_exact_distance(self):
        beside = Point(0.02, 0.01, -0.1)
        for shape, points, radii, distance in (
                (Request.POINT, [BEFORE_THE_MIDDLE], [], 0.01),
                (Request.SPHERES, [beside, BEFORE_THE_MIDDLE], [0.001, 0.004], 0.006),
                (Request.SPHERES, [BEFORE_THE_MIDDLE], [0.015], -0.005),  # goes through
                (Request.CAPSULE, [BEFORE_THE_MIDDLE, beside], [0.003], 0.007),
                (Request.TAPERED_CAPSULE, [BEFORE_THE_MIDDLE, beside], [0.004, 0.004], 0.006)):
            response = self.accepted(request(shape, points, radii))
            # Rounding of coordinates below 1 m.
            self.assertAlmostEqual(response.distance, distance, delta=1e-15)
            nearest = response.elements[0]
            self.assertEqual(nearest.distance, response.distance)
            self.assertAlmostEqual(sum(nearest.barycentric), 1.0, delta=1e-15)
            self.assertAlmostEqual(abs(nearest.normal.x), 1.0, delta=1e-15)
            self.assertAlmostEqual(nearest.point.x, 0.0, delta=1e-15)
            self.assertAlmostEqual(nearest.point.z, -0.1, delta=1e-15)
            distances = [element.distance for element in response.elements]
            self.assertEqual(distances, sorted(distances))
            self.assertLessEqual(distances[-1], 0.03)
        self.assertEqual(self.query(request(Request.SPHERES, [beside, BEFORE_THE_MIDDLE],
                                            [0.001, 0.004])).elements[0].part, 1)

    def test_nearest_elements_are_the_first_of_all(self):
        everything = self.accepted(sphere()).elements
        self.assertGreater(len(everything), 10)
        self.assertEqual(self.accepted(sphere(nearest=5)).elements, everything[:5])

    def test_nothing_in_range_is_an_empty_answer_at_infinite_distance(self):
        response = self.accepted(request(Request.POINT, [Point(1.0, 0.0, 0.0)], distance=0.012))
        self.assertEqual(response.message, 'no element within 0.012 m')
        self.assertEqual((response.distance, response.elements), (INFINITY, []))

    def test_answer_carries_the_stamp_of_its_state(self):
        state = rospy.wait_for_message('cloth/state', ClothState, WAIT)
        self.eventually(lambda: self.query(sphere()).header.stamp == state.header.stamp,
                        'the stamp of the state')
        response = self.query(sphere())
        self.assertEqual(response.header.frame_id, 'world')
        self.assertEqual(response.step, state.step)
        self.assertTrue(self.pause(False).success)
        self.eventually(lambda: self.query(sphere()).step > state.step, 'a later state')

    def test_takes_points_in_a_tf_frame(self):
        # The quarter turn takes (0, 0.09) to (-0.09, 0).
        there = request(Request.SPHERES, [Point(0.0, 0.09, -0.1)], [0.004], frame='finger')
        response = self.accepted(there)
        self.assertAlmostEqual(response.distance, 0.006, delta=1e-15)
        self.assertEqual(response.header.frame_id, 'world')
        self.assertAlmostEqual(response.elements[0].point.z, -0.1, delta=1e-15)

    def test_takes_the_transform_of_the_stamp(self):
        here = Point(0.0, 0.0, -0.1)  # in the origin of the tracker, at its height
        for seconds, place in ((0.0, 0.1), (0.5, 0.2), (1.0, 0.3)):
            asked = request(Request.POINT, [here], distance=1.0, frame='tracker')
            asked.header.stamp = self.start + rospy.Duration(seconds)
            self.assertAlmostEqual(self.accepted(asked).distance, place, delta=1e-9)  # ns stamps
        latest = request(Request.POINT, [here], distance=1.0, frame='tracker')
        self.assertAlmostEqual(self.accepted(latest).distance, 0.3, delta=1e-15)
        for seconds in (-0.1, 1.1):
            latest.header.stamp = self.start + rospy.Duration(seconds)
            self.refused(latest, "'tracker'", 'at the time header.stamp', 'stamp 0')

    def test_persistent_connection_answers_again_and_again(self):
        query = rospy.ServiceProxy('proximity/query', QueryProximity, persistent=True)
        self.accepted(sphere(), query)
        self.assertTrue(self.pause(False).success)  # states arrive meanwhile
        for _ in range(200):
            self.assertTrue(query(sphere()).success)
        bad = query(sphere(frame=''))  # a refusal does not end the connection
        self.assertFalse(bad.success)
        self.assertTrue(query(sphere()).success)
        query.close()

    def test_tells_what_is_near_the_obstacles(self):
        for name, distance in (('table', 0.01), ('ball', 0.02), ('post', 0.005), ('shelf', 0.01)):
            response = self.accepted(request(Request.OBSTACLE, obstacle=name, frame=''))
            # What RigidObstacle promises.
            self.assertAlmostEqual(response.distance, distance, delta=1e-9, msg=name)

    def test_refuses_frames(self):
        self.accepted(sphere())
        self.refused(sphere(frame=''), "header.frame_id = ''", "'world' or one that tf connects")
        self.refused(sphere(frame='moon'), "header.frame_id = 'moon'", 'publish that transform')
        self.accepted(sphere(frame='finger'))  # so the other static transforms are there too
        self.refused(sphere(frame='palm'), "header.frame_id = 'palm'", 'does not connect')
        self.refused(sphere(frame='/world'), "header.frame_id = '/world'")
        self.refused(request(Request.OBSTACLE, obstacle='ball', frame='moon'), "'moon'")

    def test_refuses_numbers(self):
        for number in (NAN, INFINITY, -INFINITY, 1e10):
            self.refused(request(Request.POINT, [Point(0.0, number, 0.0)]), 'points[0] = ')
            self.refused(request(Request.SPHERES, [Point()], [number]), 'radii[0] = ')
            self.refused(sphere(distance=number), 'distance = ')
        self.refused(request(Request.SPHERES, [Point()], [-0.01]), 'radii[0] = -0.01')
        self.refused(sphere(distance=-0.01), 'distance = -0.01')

    def test_refuses_shapes(self):
        self.refused(request(5), 'shape = 5')
        self.refused(request(Request.POINT), 'points has 0 elements')
        self.refused(request(Request.SPHERES, [Point()]), 'radii has 0 elements')
        self.refused(request(Request.CAPSULE, [Point()], [0.1]), 'points has 1 elements')
        self.refused(request(Request.TAPERED_CAPSULE, [Point(), Point()], [0.1]),
                     'radii has 1 elements')
        self.refused(request(Request.OBSTACLE, [Point()], obstacle='ball'), 'points has 1')

    def test_refuses_obstacles(self):
        self.refused(request(Request.OBSTACLE, obstacle='chair'), "obstacle = 'chair'",
                     'ball post shelf table')
        self.refused(sphere(obstacle='ball'), 'leave it empty')

    def test_paused_cloth_stays_fresh(self):
        received = []
        subscriber = rospy.Subscriber('cloth/state', ClothState, received.append)
        self.eventually(lambda: len(received) >= 10, 'ten states of a paused cloth')
        self.assertEqual({state.step for state in received}, {0})
        subscriber.unregister()

    def test_stopped_cloth_is_stale_until_it_goes_on(self):
        self.accepted(sphere())
        process = process_of('cloth_simulation')
        os.kill(process, signal.SIGSTOP)
        try:
            self.eventually(lambda: not self.query(sphere()).success, 'a refusal')
            self.refused(sphere(), 'the cloth is stale', 'allowed are 5 s',
                         'is cloth_simulation running?')
            self.eventually(lambda: 'stale' in self.diagnostics.next(QUERIES).message, 'an error')
        finally:
            os.kill(process, signal.SIGCONT)
        self.accepted(sphere())

    def test_diagnostics_tell_what_was_answered_and_refused(self):
        self.accepted(sphere())
        self.refused(sphere(frame=''), 'header.frame_id')
        why = 'why the last query was refused'
        self.eventually(lambda: 'header.frame_id' in self.diagnostics.values(QUERIES)[why],
                        'the refusal')
        values = self.diagnostics.values(QUERIES)
        self.assertEqual(int(values['triangles']), 2048)
        self.assertEqual(int(values['hierarchies built']), 1)
        self.assertEqual(int(values['messages dropped']), 0)
        for name in ('states received', 'queries answered', 'queries refused',
                     'computing time of the last refit (ms)',
                     'computing time of the last answer (ms)'):
            self.assertGreater(float(values[name]), 0.0, name)

    def test_markers_show_the_answer_the_volumes_and_the_obstacles(self):
        seen = {}  # by namespace and id

        def take(array):
            seen.update({(marker.ns, marker.id): marker for marker in array.markers})

        def shown(key):
            return key in seen and seen[key].action == Marker.ADD

        client = dynamic_reconfigure.client.Client('proximity', timeout=WAIT)
        subscriber = rospy.Subscriber('proximity/markers', MarkerArray, take)
        self.eventually(lambda: shown(('obstacles', 3)), 'obstacles')
        self.assertFalse(shown(('volumes', 0)))
        elements = len(self.accepted(sphere()).elements)
        self.eventually(lambda: shown(('cursor', 0)), 'a cursor')
        self.assertEqual(len(seen['near_elements', 0].points), 2 * 3 * elements)
        client.update_configuration({'volume_level': 3})
        self.eventually(lambda: shown(('volumes', 0)) and shown(('volumes', 1)), 'volumes')
        self.assertEqual(len({(c.r, c.g, c.b) for c in seen['volumes', 0].colors}), 2 ** 3)
        client.update_configuration({'volume_level': -2, 'tested_volumes': True})
        self.eventually(lambda: shown(('volumes/0', 0)) and shown(('volumes/8', 0)) and
                        shown(('tested_volumes', 0)), 'all levels and those that are tested')
        client.update_configuration({'volume_level': -1, 'tested_volumes': False})
        self.eventually(lambda: not any(shown((name, 0)) for name in (
            'volumes', 'volumes/0', 'volumes/8', 'tested_volumes')), 'no volumes')
        subscriber.unregister()


if __name__ == '__main__':
    rospy.init_node('proximity_test')
    rostest.rosrun('haptex', 'proximity_queries', Proximity)
