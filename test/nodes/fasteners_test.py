#!/usr/bin/python3
"""cloth_simulation fastens and unfastens what the scene gathered_wool lists, and tells what opens by itself."""
import rospy
import rostest
from geometry_msgs.msg import Point, Vector3
from haptex.msg import ClothState, FastenerEvent, FastenerStates
from haptex.srv import (AttachParticles, AttachParticlesRequest, MoveParticles, MoveParticlesRequest,
                        ReleaseParticles, SelectFasteners, SetSheet, SetSheetRequest, SetState,
                        SetStateRequest, StepCloth)
from ros_fixtures import AnswersTest, Diagnostics, eventually
from std_srvs.srv import SetBool, Trigger

WAIT = 30.0  # s
CELLS = 32
START = {'hem': True, 'cuff': False, 'clasp': False}
CUFF_RELEASE = 4.0  # N


def particle(column, row):
    return row * (CELLS + 1) + column


class Fasteners(AnswersTest):
    @classmethod
    def setUpClass(cls):
        for name, kind in (('pause', SetBool), ('reset', Trigger), ('step', StepCloth),
                           ('attach', AttachParticles), ('move', MoveParticles),
                           ('release', ReleaseParticles), ('set_state', SetState),
                           ('set_sheet', SetSheet), ('fasten', SelectFasteners),
                           ('unfasten', SelectFasteners)):
            rospy.wait_for_service('cloth/' + name, WAIT)
            setattr(cls, name, rospy.ServiceProxy('cloth/' + name, kind))
        cls.states, cls.events = [], []
        cls.subscribers = [
            rospy.Subscriber('cloth/fasteners', FastenerStates, cls.states.append),
            rospy.Subscriber('cloth/fastener_events', FastenerEvent, cls.events.append)]
        eventually(lambda: all(one.get_num_connections() for one in cls.subscribers), 'the topics')
        cls.diagnostics = Diagnostics()

    def setUp(self):
        self.accepted(self.pause(True))
        self.accepted(self.reset())
        self.await_fastened(START)
        self.events.clear()

    def fastened(self):
        return {one.name: bool(one.fastened) for one in self.states[-1].fasteners}

    def await_fastened(self, expected):
        eventually(lambda: self.states and self.fastened() == expected,
                   lambda: f'{self.fastened()} instead of {expected}')

    def force_of(self, name):
        return next(one.force for one in self.states[-1].fasteners if one.name == name)

    def fold(self):
        """The right half over the left one, 2 mm in front of it, held by nothing."""
        state = rospy.wait_for_message('cloth/state', ClothState, WAIT)
        self.accepted(self.release(particles=state.attached))
        request = SetStateRequest(velocities=[Vector3()] * len(state.positions))
        request.header.frame_id = 'world'
        request.positions = [Point(0.002 if place.y > 0.0 else 0.0, -abs(place.y), place.z)
                             for place in state.positions]
        self.accepted(self.set_state(request))

    def test_the_latched_state_says_kind_and_force(self):
        last = rospy.wait_for_message('cloth/fasteners', FastenerStates, WAIT)
        self.assertEqual(last.header.frame_id, 'world')
        self.assertEqual([(one.name, one.kind) for one in last.fasteners],
                         [('hem', 'elastic'), ('cuff', 'button'), ('clasp', 'hook')])
        # 0.2 m wide, slack up to 0.12 m, 10 N/m
        self.assertAlmostEqual(last.fasteners[0].force, 0.8, 9)
        self.assertEqual([one.force for one in last.fasteners[1:]], [0.0, 0.0])

    def test_unfastens_and_fastens(self):
        self.assertEqual(self.accepted(self.unfasten(['hem'])).message, '3 fasteners of 3 open')
        self.await_fastened(dict(START, hem=False))
        self.assertEqual(self.force_of('hem'), 0.0)
        self.assertEqual(self.accepted(self.fasten(['hem'])).message, '2 fasteners of 3 open')
        self.await_fastened(START)
        self.accepted(self.unfasten([]))
        self.await_fastened(dict.fromkeys(START, False))
        self.assertEqual(self.events, [], 'what is opened by hand is no event')

    def test_an_elastic_band_gathers_the_hem(self):
        self.accepted(self.step(steps=80))
        eventually(lambda: 0.0 < self.force_of('hem') < 0.5, lambda: self.force_of('hem'))

    def test_refuses_unknown_names_and_places_that_are_too_far_apart(self):
        for service in (self.fasten, self.unfasten):
            self.refused(service(['hem', 'collar']),
                         "names[1] = 'collar' is no fastener: allowed are hem, cuff, clasp")
        self.refused(self.fasten(['cuff']), 'its places are 0.18 m apart; allowed are 0.008 m')
        self.refused(self.fasten([]), 'cannot be fastened')
        self.assertEqual(self.fastened(), START)

    def test_tells_what_opens_by_force_and_at_which(self):
        self.fold()
        self.accepted(self.unfasten(['hem']))
        self.accepted(self.fasten(['cuff', 'clasp']))
        self.await_fastened({'hem': False, 'cuff': True, 'clasp': True})
        before = int(self.diagnostics.values('cloth simulation')['fasteners opened by force'])
        corners = [[particle(column, row) for column in columns for row in range(4)]
                   for columns in (range(4), range(CELLS - 3, CELLS + 1))]
        for corner in corners:
            request = AttachParticlesRequest(particles=corner)
            request.header.frame_id = 'world'
            self.accepted(self.attach(request))
        request = MoveParticlesRequest(particles=corners[1], duration=1.0)
        request.header.frame_id = 'world'
        request.displacement.x = 0.015
        self.accepted(self.move(request))
        self.accepted(self.step(steps=100))
        eventually(lambda: self.events, 'an event')
        event = self.events[0]
        self.assertEqual(event.name, 'cuff')
        self.assertLess(abs(event.force / CUFF_RELEASE - 1.0), 0.02)
        self.assertEqual(event.header.frame_id, 'world')
        self.assertGreater(event.simulated_time, 0.0)
        eventually(lambda: not self.fastened()['cuff'], 'the cuff open')
        self.assertEqual(self.force_of('cuff'), 0.0)
        self.assertEqual([other.name for other in self.events].count('cuff'), 1)
        values = self.diagnostics.values('cloth simulation')
        self.assertEqual(int(values['fasteners opened by force']), before + len(self.events))
        self.assertTrue(values['open fasteners'].endswith(' of 3'), values['open fasteners'])

    def test_another_sheet_has_them_at_the_same_places(self):
        self.accepted(self.unfasten([]))
        self.accepted(self.set_sheet(SetSheetRequest(cells=[10, 10])))
        self.await_fastened(START)
        eventually(lambda: abs(self.force_of('hem') - 0.8) < 1e-9, lambda: self.force_of('hem'))
        self.accepted(self.step(steps=5))
        self.refused(self.set_sheet(SetSheetRequest(size=[0.1, 0.1])), 'within the cloth')
        self.accepted(self.set_sheet(SetSheetRequest()))


if __name__ == '__main__':
    rospy.init_node('fasteners_test')
    rostest.rosrun('haptex', 'fasteners', Fasteners)
