#!/usr/bin/python3
"""A demo is judged by what was felt: synthetic demos that are as the path asks, and some that are not."""
import io
import pathlib
import sys
import types
import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import Point, Vector3, WrenchStamped
from haptex.msg import ClothState, Contact
from std_msgs.msg import Header
from unit_fixtures import suite_of

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'scripts'))
from demo_report.holds import Hold, holds_of, load_holds  # noqa: E402
from demo_report.host import steal_of  # noqa: E402
from demo_report.judgement import judge, spells_below  # noqa: E402
from demo_report.recording import parse_contact, parse_state, parse_wrench  # noqa: E402
from demo_report.series import FINGERS, WITH_CONTACT, Series  # noqa: E402

START = 1000.0  # s since the epoch
HOLDS = [Hold('pinch', 0.5, 2.0, 1.0), Hold('rub', 0.0, 3.0, 0.5)]
BEGINS = {'pinch': START, 'rub': START + 10.0}


def series(begin, end, rate, value):
    result = Series()
    for time in np.arange(begin, end, 1.0 / rate):
        result.add(time, value(time - begin))
    result.close()
    return result


def concatenation(parts):
    result = Series([time for part in parts for time in part.times],
                    [value for part in parts for value in part.values])
    result.close()
    return result


class Demo(types.SimpleNamespace):
    """Felt and rendered at 1 kHz while it holds, as the path asks."""

    def __init__(self):
        super().__init__(begins=dict(BEGINS), felt={}, contact={}, dropped=Series([START], [0.0]),
                         operating=Series([START - 5.0, START - 4.0],
                                          [('FAULT', 'at the start'), ('ENABLED', '')]))
        for finger in FINGERS:
            self.feel(finger, lambda phase, time: 1.0)
            self.contact[finger] = concatenation(
                [series(begin, begin + 3.0, 1000.0, lambda _: 0) for begin in BEGINS.values()])

    def feel(self, finger, share):
        """share(phase, time since it began) of what the path presses with, in any direction."""
        direction = np.array([0.6, 0.0, 0.8])
        self.felt[finger] = concatenation([
            series(BEGINS[hold.phase], BEGINS[hold.phase] + hold.end, 1000.0,
                   lambda time, hold=hold: hold.pinch * share(hold.phase, time) * direction)
            for hold in HOLDS])

    def silence(self, series_of, finger, begin, length):
        """Takes messages away."""
        old = series_of[finger]
        kept = [(time, value) for time, value in zip(old.times, old.values)
                if not begin <= time < begin + length]
        series_of[finger] = Series(*zip(*kept))
        series_of[finger].close()


def drop(phase, begin, length, share):
    """For Demo.feel(): less for a while."""
    return lambda p, time: share if p == phase and begin <= time < begin + length else 1.0


class Judging(unittest.TestCase):
    def failures(self, demo):
        return judge(demo, HOLDS).failures

    def assert_fails(self, demo, *words):
        failures = self.failures(demo)
        self.assertEqual(len(failures), 1, failures)
        for word in words:
            self.assertIn(word, failures[0])

    def test_a_demo_as_the_path_asks_passes(self):
        judgement = judge(Demo(), HOLDS)
        self.assertEqual(judgement.failures, [])
        self.assertEqual(judgement.held, {'pinch': True, 'rub': True})
        self.assertEqual(judgement.dips, [])
        self.assertEqual(judgement.longest_dip(), 0.0)
        self.assertAlmostEqual(judgement.medians['pinch', 'index'], 1.0)
        self.assertAlmostEqual(judgement.medians['rub', 'thumb'], 0.5)

    def test_a_dip_is_counted_with_its_length(self):
        demo = Demo()
        demo.feel('thumb', drop('rub', 1.0, 0.012, 0.7))
        judgement = judge(demo, HOLDS)
        self.assertEqual(judgement.held, {'pinch': True, 'rub': True})
        dip, = judgement.dips
        self.assertEqual((dip.phase, dip.finger), ('rub', 'thumb'))
        self.assertAlmostEqual(dip.begin, BEGINS['rub'] + 1.0, places=2)
        self.assertAlmostEqual(dip.length, 0.012, delta=0.0015)
        self.assert_fails(demo, 'rub', 'thumb', 'dips', '1 times', 'ms')

    def test_shallow_or_short_dips_are_none(self):
        for length, share in [(0.004, 0.0), (0.5, 0.81)]:
            demo = Demo()
            demo.feel('index', drop('pinch', 1.0, length, share))
            self.assertEqual(self.failures(demo), [])

    def test_dips_of_both_fingers_and_every_phase_are_counted(self):
        demo = Demo()
        for finger in FINGERS:
            demo.feel(finger, lambda phase, time: 0.6 if 1.0 <= time % 1.5 < 1.01 else 1.0)
        judgement = judge(demo, HOLDS)
        self.assertEqual(len(judgement.dips), 2 * 3)
        self.assertEqual(len(judgement.failures), 2 * 2)

    def test_outside_of_a_hold_nothing_has_to_be_felt(self):
        demo = Demo()
        demo.feel('index', drop('pinch', 0.0, 0.499, 0.0))
        self.assertEqual(self.failures(demo), [])

    def test_a_lost_pinch_is_no_hold(self):
        demo = Demo()
        demo.feel('index', drop('rub', 0.5, 2.5, 0.01))
        judgement = judge(demo, HOLDS)
        self.assertEqual(judgement.held, {'pinch': True, 'rub': False})
        self.assert_fails(demo, 'rub', 'pinch lost', 'index', '2.50 s')

    def test_a_pinch_that_is_lost_for_long_enough_to_drop_the_cloth_is_no_hold(self):
        for length, held in [(0.036, True), (0.042, False)]:
            demo = Demo()
            demo.feel('index', drop('rub', 0.5, length, 0.1))
            self.assertEqual(judge(demo, HOLDS).held['rub'], held)

    def test_a_weak_pinch_is_none(self):
        demo = Demo()
        demo.feel('thumb', lambda phase, time: 0.4)
        self.assertEqual(judge(demo, HOLDS).held, {'pinch': False, 'rub': False})

    def test_a_finger_that_is_not_measured_does_not_hold(self):
        demo = Demo()
        demo.silence(demo.felt, 'index', BEGINS['rub'], 3.0)
        self.assertEqual(judge(demo, HOLDS).held, {'pinch': True, 'rub': False})

    def test_a_dip_that_nobody_measured_to_its_end_lasts_until_the_next_measurement(self):
        demo = Demo()
        demo.feel('index', drop('rub', 1.0, 0.002, 0.5))
        demo.silence(demo.felt, 'index', BEGINS['rub'] + 1.0015, 0.01)
        self.assertAlmostEqual(judge(demo, HOLDS).longest_dip(), 0.0115, delta=0.0015)

    def test_a_silent_force_loop_is_said(self):
        demo = Demo()
        demo.silence(demo.contact, 'thumb', BEGINS['pinch'] + 1.0, 0.03)
        self.assert_fails(demo, 'pinch', 'silent', 'thumb', 'ms')

    def test_a_force_loop_that_never_came_back_is_said(self):
        demo = Demo()
        demo.silence(demo.contact, 'index', BEGINS['rub'] + 1.0, 100.0)
        self.assert_fails(demo, 'rub', 'silent', 'index')

    def test_dropped_cloth_is_said(self):
        demo = Demo()
        demo.dropped = Series([START, START + 1.0], [0.0, 0.25])
        self.assert_fails(demo, 'cloth dropped', '0.250 s')

    def test_latched_faults_are_said_though_they_were_cleared(self):
        demo = Demo()
        demo.operating.add(START, ('FAULT', 'the watchdog has tripped'))
        demo.operating.add(START + 0.1, ('FAULT', 'the watchdog has tripped'))
        demo.operating.add(START + 1.0, ('ENABLED', ''))
        self.assert_fails(demo, 'latched fault', 'the watchdog has tripped')


class Spells(unittest.TestCase):
    def test_last_until_the_next_value_that_is_not_below(self):
        times = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]
        self.assertEqual(spells_below(times, [0, 0, 2, 0, 2, 2], 1), [(0.0, 2.0), (3.0, 1.0)])

    def test_one_that_does_not_end_lasts_until_the_last_time(self):
        self.assertEqual(spells_below([0.0, 1.0, 2.0], [2, 0, 0], 1), [(1.0, 1.0)])

    def test_there_are_none_without_values_below(self):
        self.assertEqual(spells_below([0.0, 1.0], [1, 1], 1), [])


class Holds(unittest.TestCase):
    def test_every_phase_with_contact_of_the_demo_has_one(self):
        holds = load_holds(ROOT / 'config' / 'paths' / 'demo.yaml')
        self.assertEqual([hold.phase for hold in holds], WITH_CONTACT)
        # Read in config/paths/demo.yaml: from when the fingers are closed to when they open.
        spans = {hold.phase: (round(hold.begin, 6), round(hold.end, 6)) for hold in holds}
        self.assertEqual(spans, {'pinch': (1.5, 3.0), 'lift': (0.5, 3.5), 'stretch': (0.0, 4.5),
                                 'slide': (4.3, 6.3), 'rub': (0.0, 3.0)})

    def test_fingers_that_are_open_or_close_do_not_hold(self):
        def frame(time, gap, **others):
            return {'time': time, 'index': [gap, 0, 0], 'thumb': [0, 0, 0], **others}

        frames = [frame(0, 0.03, phase='pinch'), frame(1, 0.03), frame(2, 0.01), frame(3, 0.01),
                  frame(4, 0.012)]
        self.assertEqual(holds_of(frames), [Hold('pinch', 2, 3, 1.0)])


class Steal(unittest.TestCase):
    def test_is_the_eighth_number_of_a_line(self):
        self.assertAlmostEqual(steal_of('cpu0 1 2 3 4 5 6 7 250 9 10'), 2.5)

    def test_is_none_where_the_kernel_does_not_count_it(self):
        self.assertEqual(steal_of('cpu 1 2 3 4 5 6 7'), 0.0)


class Parsing(unittest.TestCase):
    """What is read by hand, because that is much faster, is what the messages' own classes say."""

    @staticmethod
    def serialized(message):
        message.header = Header(seq=3, stamp=rospy.Time(12, 500000000), frame_id='world')
        buffer = io.BytesIO()
        message.serialize(buffer)
        return buffer.getvalue()

    def test_states(self):
        state = ClothState(mesh=7, step=1 << 40, simulated_time=2.5, attached=[1], excluded=[],
                           positions=[Point(1.0, 2.0, 3.0), Point(4.0, 5.0, 6.0)],
                           velocities=[Vector3()] * 2, until_next=0.01,
                           forces=[Vector3(7.0, 8.0, 9.0), Vector3(-1.0, 0.0, 1.0)])
        stamp, step, time, positions, forces = parse_state(self.serialized(state))
        self.assertEqual((stamp, step, time), (12.5, 1 << 40, 2.5))
        self.assertEqual(positions.tolist(), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])
        self.assertEqual(forces.tolist(), [[7.0, 8.0, 9.0], [-1.0, 0.0, 1.0]])

    def test_contacts(self):
        contact = Contact(touching=True, slipping=True, force=Vector3(3.0, 0.0, 4.0),
                          normal_force=2.0, area=1e-4, sliding_velocity=Vector3(0.0, 0.3, 0.4),
                          fabric=2)
        stamp, values = parse_contact((None, self.serialized(contact)))
        self.assertEqual(stamp, 12.5)
        np.testing.assert_allclose(values, (5.0, 2.0, 1e-4, 0.5))

    def test_wrenches(self):
        wrench = WrenchStamped()
        wrench.wrench.force = Vector3(1.0, -2.0, 3.0)
        self.assertEqual(parse_wrench((None, self.serialized(wrench))), (12.5, (1.0, -2.0, 3.0)))


Tests = suite_of(Judging, Spells, Holds, Steal, Parsing)


if __name__ == '__main__':
    rostest.rosrun('haptex', 'demo_judgement', f'{__name__}.Tests')
