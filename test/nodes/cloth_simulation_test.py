#!/usr/bin/python3
"""The promises of cloth_simulation's topics and services, and every request that it refuses."""
import os
import tempfile
import unittest

import numpy as np
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Point, Vector3
from haptex.msg import ClothMesh, ClothState, ContactForces, ExternalForces
from haptex.srv import (AttachParticles, GetJacobian, MoveParticles, QueryBudget, ReleaseParticles,
                        SaveState, SelectParticles, SetFabric, SetState, StepCloth)
from ros_fixtures import eventually
from rosgraph_msgs.msg import Log
from std_msgs.msg import Header
from std_srvs.srv import SetBool, Trigger
from visualization_msgs.msg import MarkerArray

WAIT = 20.0  # s
WORLD = Header(frame_id='world')
PARTICLES = 33 * 33
TRIANGLES = 2 * 32 * 32
TIME_STEP = 0.0125  # s, of config/scenes/wool_sample.yaml
CORNER, TOP_CORNER = 0, PARTICLES - 1
NAN, INFINITY = float('nan'), float('inf')


def message(topic, message_class):
    return rospy.wait_for_message(topic, message_class, WAIT)


def positions(state):
    return np.array([(p.x, p.y, p.z) for p in state.positions])


class ClothSimulation(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        services = {'reset': Trigger, 'pause': SetBool, 'step': StepCloth,
                    'set_fabric': SetFabric, 'attach': AttachParticles, 'move': MoveParticles,
                    'release': ReleaseParticles, 'get_jacobian': GetJacobian,
                    'query_budget': QueryBudget, 'set_state': SetState,
                    'save_state': SaveState, 'exclude': SelectParticles,
                    'include': SelectParticles}
        for name, service in services.items():
            rospy.wait_for_service('cloth/' + name, WAIT)
            setattr(cls, name, rospy.ServiceProxy('cloth/' + name, service))

    def setUp(self):
        self.assertTrue(self.pause(True).success)
        self.accepted(self.set_fabric('wool'))
        self.accepted(self.reset())

    def state(self):
        """The present state; a new subscriber gets it at once, also while paused."""
        return message('cloth/state', ClothState)

    def state_after(self, steps, excluded):
        """A busy machine may still deliver states of before."""
        for _ in range(20):
            state = self.state()
            if state.step == steps and len(state.excluded) == excluded:
                return state
        self.fail(f'no state after {steps} steps with {excluded} excluded particles')

    def accepted(self, response):
        self.assertTrue(response.success, response.message)
        return response

    def refused(self, call, *arguments, says):
        before = self.state()
        response = call(*arguments)
        self.assertFalse(response.success, f'accepted instead of refused: {says}')
        self.assertIn(says, response.message)
        after = self.state()
        for state in (before, after):
            state.header.seq = 0
        self.assertEqual(before, after)  # bit by bit, stamp and forces included
        return response

    def test_starts_from_the_scene(self):
        state = self.state()
        self.assertEqual((state.step, state.simulated_time), (0, 0.0))
        for array in (state.positions, state.velocities, state.forces):
            self.assertEqual(len(array), PARTICLES)
        self.assertEqual(state.header.frame_id, 'world')
        self.assertEqual(state.positions[TOP_CORNER], Point(0.0, 0.1, 0.0))
        self.assertEqual(list(state.attached), list(range(PARTICLES - 33, PARTICLES)))

    def test_mesh_reaches_late_subscribers(self):
        for _ in range(2):
            mesh = message('cloth/mesh', ClothMesh)
            self.assertEqual(mesh.fabrics, ['wool'])
            self.assertEqual(len(mesh.triangles), 3 * TRIANGLES)
            self.assertEqual(max(mesh.triangles), PARTICLES - 1)
            for array in (mesh.rest_weft_coordinates, mesh.rest_warp_coordinates, mesh.masses):
                self.assertEqual(len(array), PARTICLES)
            self.assertEqual(mesh.header.frame_id, 'world')

    def test_masses_sum_to_the_density_times_the_area(self):
        mesh = message('cloth/mesh', ClothMesh)
        self.accepted(self.set_fabric('linear'))
        linear = message('cloth/mesh', ClothMesh)
        self.assertEqual(linear.fabrics, ['linear'])
        self.assertAlmostEqual(sum(linear.masses), 0.1 * 0.2 * 0.2, delta=1e-12)  # kg
        self.assertNotAlmostEqual(sum(mesh.masses), sum(linear.masses), delta=1e-6)

    def test_markers_show_every_triangle(self):
        markers = message('cloth/markers', MarkerArray).markers
        cloth = [marker for marker in markers if marker.ns == 'cloth']
        self.assertEqual(len(cloth[0].points), 3 * TRIANGLES)
        self.assertTrue(any('%' in marker.text for marker in markers))

    def test_diagnostics_tell_rate_residual_and_size(self):
        self.accepted(self.pause(False))
        rospy.sleep(2.5)
        values = {item.key: item.value
                  for item in message('/diagnostics', DiagnosticArray).status[0].values}
        self.assertGreater(float(values['step rate (Hz)']), 0.0)
        self.assertGreater(float(values['real-time factor']), 0.0)
        self.assertLessEqual(float(values['largest residual']), float(values['tolerance']))
        self.assertEqual(int(values['triangles']), TRIANGLES)
        self.assertEqual(int(values['rejected steps']), 0)
        self.assertIn(values['linear solver'], ('Cholesky', 'conjugate gradient'))

    def sleeps(self):
        rospy.sleep(2.1)  # until diagnostics know
        status = message('/diagnostics', DiagnosticArray).status[0]
        return {item.key: item.value for item in status.values}['asleep']

    def test_cloth_at_rest_sleeps_until_something_changes(self):
        self.assertEqual(self.sleeps(), 'no')
        self.accepted(self.step(steps=1600))
        self.assertEqual(self.sleeps(), 'yes')
        before = self.state()
        self.accepted(self.step(steps=80))
        after = self.state()
        self.assertEqual(after.step, before.step + 80)
        self.assertAlmostEqual(after.simulated_time, before.simulated_time + 1.0, delta=1e-9)
        self.assertEqual((before.positions, before.velocities, before.forces, before.attached),
                         (after.positions, after.velocities, after.forces, after.attached))
        self.assertGreater(after.header.stamp, before.header.stamp)
        self.accepted(self.move(WORLD, [TOP_CORNER], Vector3(0.01, 0, 0), 0.1))
        self.accepted(self.step(steps=8))
        self.assertEqual(self.sleeps(), 'no')
        self.assertNotEqual(positions(after).tolist(), positions(self.state()).tolist())

    def test_runs_and_pauses(self):
        self.accepted(self.pause(False))
        subscriber_saw = message('cloth/state', ClothState).step
        later = message('cloth/state', ClothState).step
        self.assertGreater(later, subscriber_saw)
        self.accepted(self.pause(True))
        before = self.state()
        rospy.sleep(0.1)
        self.assertEqual(positions(before).tolist(), positions(self.state()).tolist())

    def test_takes_exactly_the_steps_asked_for(self):
        self.accepted(self.step(steps=7))
        state = self.state()
        self.assertEqual(state.step, 7)
        self.assertAlmostEqual(state.simulated_time, 7 * TIME_STEP, delta=1e-12)  # rounding

    def test_reset_restores_the_start(self):
        before = self.state()
        self.accepted(self.release([TOP_CORNER]))
        self.accepted(self.step(steps=10))
        self.assertNotEqual(positions(before).tolist(), positions(self.state()).tolist())
        self.accepted(self.reset())
        after = self.state()
        self.assertEqual((after.step, after.simulated_time), (0, 0.0))
        self.assertEqual(positions(before).tolist(), positions(after).tolist())
        self.accepted(self.move(WORLD, [TOP_CORNER], Vector3(), 0))  # attached again

    def test_fabric_changes_without_a_jump(self):
        self.accepted(self.step(steps=20))
        before = self.state()
        self.accepted(self.set_fabric('linear'))
        after = self.state()
        self.assertEqual(positions(before).tolist(), positions(after).tolist())
        self.assertEqual(before.velocities, after.velocities)
        self.assertNotEqual(before.forces, after.forces)
        self.accepted(self.step(steps=1))
        # Free fall for one step from rest moves g h^2 = 1.5 mm; nothing here may move faster.
        moved = np.linalg.norm(positions(self.state()) - positions(before), axis=1).max()
        self.assertLess(moved, 9.81 * TIME_STEP ** 2)

    def test_attached_particle_goes_where_it_is_told(self):
        self.accepted(self.attach(WORLD, [CORNER], [Point(0.01, -0.1, -0.19)]))
        self.accepted(self.step(steps=1))
        self.assertEqual(self.state().positions[CORNER], Point(0.01, -0.1, -0.19))

    def test_particle_is_attached_where_it_is(self):
        self.accepted(self.step(steps=5))
        place = self.state().positions[CORNER]
        self.accepted(self.attach(WORLD, [CORNER], []))
        self.accepted(self.step(steps=20))
        self.assertEqual(self.state().positions[CORNER], place)

    def test_move_ends_exactly_at_its_target(self):
        start = positions(self.state())[TOP_CORNER]
        displacement = np.array([0.02, 0.0, 0.01])
        self.accepted(self.move(WORLD, [TOP_CORNER], Vector3(*displacement), 10 * TIME_STEP))
        self.accepted(self.step(steps=5))
        half = positions(self.state())[TOP_CORNER]
        # A minimum-jerk path is half way after half of its time.
        np.testing.assert_allclose(half, start + displacement / 2, rtol=0, atol=1e-12)
        self.accepted(self.step(steps=6))
        self.assertEqual(positions(self.state())[TOP_CORNER].tolist(),
                         (start + displacement).tolist())

    def test_takes_steps_of_a_chosen_length(self):
        before = self.state().simulated_time
        self.accepted(self.step(steps=3, time_step=0.002))
        self.accepted(self.step(steps=1))
        self.assertAlmostEqual(self.state().simulated_time, before + 0.006 + TIME_STEP, places=12)
        for wrong in (-0.001, 1e-7, 11.0, float('nan'), float('inf')):
            self.refused(self.step, 1, wrong, says='allowed are 1e-06 to 10 s')

    def test_move_without_duration_is_made_in_one_step(self):
        start = positions(self.state())[TOP_CORNER]
        self.accepted(self.move(WORLD, [TOP_CORNER], Vector3(0.001, 0.0, 0.0), 0.0))
        self.accepted(self.step(steps=1))
        self.assertEqual(positions(self.state())[TOP_CORNER].tolist(),
                         (start + np.array([0.001, 0, 0])).tolist())

    def test_released_particle_falls(self):
        top = list(range(PARTICLES - 33, PARTICLES))
        self.accepted(self.release(top))
        self.accepted(self.step(steps=1))
        fallen = positions(self.state())[TOP_CORNER][2]
        # Backward Euler falls g h^2 in its first step from rest, strain-free as the cloth starts.
        self.assertAlmostEqual(fallen, -9.80665 * TIME_STEP ** 2, delta=1e-6)

    def test_jacobian_has_its_blocks_and_their_sum_is_zero(self):
        self.accepted(self.step(steps=5))
        response = self.accepted(self.get_jacobian([CORNER, 500]))
        self.assertEqual(set(response.rows), {CORNER, 500})
        blocks = len(response.rows)
        self.assertEqual(len(response.columns), blocks)
        self.assertEqual(len(response.by_position), 9 * blocks)
        self.assertEqual(len(response.by_velocity), 9 * blocks)
        self.assertEqual(response.header.frame_id, 'world')
        self.assertEqual(response.simulated_time, self.state().simulated_time)
        # Internal forces do not change when the whole cloth is displaced.
        matrix = np.array(response.by_position).reshape(blocks, 3, 3)
        for row in (CORNER, 500):
            own = matrix[np.array(response.rows) == row]
            self.assertLess(np.abs(own.sum(axis=0)).max(), 1e-9 * np.abs(own).max())
            self.assertGreater(np.abs(own).max(), 0.0)

    def contact_forces(self):
        """A push of 0.05 N along x on the middle of the first triangle, at the lower edge."""
        return ContactForces(header=Header(frame_id='world', stamp=rospy.Time.now()),
                             triangles=[0], barycentric=[0.25, 0.25, 0.5], positions=[Point()],
                             forces=[Vector3(0.05, 0.0, 0.0)], stiffness=[0.0] * 9)

    def contact_publisher(self):
        return self.publisher('cloth/contact_forces', ContactForces)

    def publisher(self, topic, message_class):
        publisher = rospy.Publisher(topic, message_class, queue_size=20, tcp_nodelay=True)
        deadline = rospy.Time.now() + rospy.Duration(WAIT)
        while publisher.get_num_connections() == 0 and rospy.Time.now() < deadline:
            rospy.sleep(0.01)
        self.assertEqual(publisher.get_num_connections(), 1)
        return publisher

    def push(self, publisher, contact, seconds):
        """For so long by the clock of the simulation, which may be slower than that of the wall."""
        states = []
        subscriber = rospy.Subscriber('cloth/state', ClothState, states.append)
        deadline = rospy.Time.now() + rospy.Duration(WAIT)
        rate = rospy.Rate(80)
        while not states or states[-1].simulated_time < states[0].simulated_time + seconds:
            self.assertLess(rospy.Time.now(), deadline)
            contact.header.stamp = rospy.Time.now()
            publisher.publish(contact)
            rate.sleep()
        subscriber.unregister()

    def test_contact_forces_move_the_cloth_until_they_fall_silent(self):
        publisher = self.contact_publisher()
        self.accepted(self.pause(False))
        # 0.05 N are nearly the weight of the whole sample: they lift its corner far out.
        self.push(publisher, self.contact_forces(), 1.0)
        self.accepted(self.pause(True))
        pushed = self.state()
        self.assertGreater(pushed.positions[CORNER].x, 0.01)
        rospy.sleep(0.2)
        self.accepted(self.step(steps=1))
        released = self.state()
        # The loads have ended, so the published forces lack them: internal forces sum to nothing,
        # and what remains along x is nothing but the bar's share.
        total = sum(force.x for force in released.forces)
        self.assertAlmostEqual(total, 0.0, delta=1e-9)
        self.accepted(self.reset())
        self.assertEqual(self.state().step, 0)
        publisher.unregister()

    def test_refuses_contact_forces_and_survives(self):
        publisher = self.contact_publisher()
        self.accepted(self.pause(False))
        spoiled = []
        for attribute, value in (('triangles', [TRIANGLES]), ('triangles', [0, 1]),
                                 ('barycentric', [NAN, 0.0, 1.0]), ('barycentric', [1.0]),
                                 ('positions', []), ('forces', [Vector3(INFINITY, 0, 0)]),
                                 ('stiffness', [NAN] * 9), ('stiffness', [-1.0] + [0.0] * 8),
                                 ('header', Header(frame_id='map'))):
            spoiled.append(self.contact_forces())
            setattr(spoiled[-1], attribute, value)
        before = self.state()
        for contact in spoiled:
            publisher.publish(contact)
            rospy.sleep(0.05)
        rospy.sleep(2.1)
        status = message('/diagnostics', DiagnosticArray).status[0]
        values = {item.key: item.value for item in status.values}
        self.assertEqual(int(values['contact forces refused']), len(spoiled))
        self.assertIn("allowed is 'world'", values['last contact forces refused for'])
        self.assertEqual(int(values['rejected steps']), 0)
        after = self.state()
        self.assertGreater(after.step, before.step)
        self.assertLess(abs(after.positions[CORNER].x), 1e-6)  # nothing has pushed it
        publisher.unregister()

    def test_external_forces_add_up_and_end(self):
        publisher = self.publisher('cloth/external_forces', ExternalForces)

        def push(source, newtons, lifetime):
            publisher.publish(ExternalForces(header=WORLD, source=source, particles=[CORNER],
                                             forces=[Vector3(newtons, 0, 0)], lifetime=lifetime))

        def pushed():
            """Newtons along x: all others are internal, and those of the bar, which is at x = 0."""
            self.accepted(self.step(steps=1))
            return sum(force.x for force in self.state().forces)

        def steps_until(newtons):
            """A message takes its time."""
            deadline = rospy.Time.now() + rospy.Duration(WAIT)
            while abs(pushed() - newtons) > 1e-9:
                self.assertLess(rospy.Time.now(), deadline)

        push('wind', 2e-3, 3600)
        steps_until(2e-3)
        push('wind', NAN, 3600)  # refused, and nobody minds
        publisher.publish(ExternalForces(source='wind'))  # of no frame
        push('magnet', 1e-3, 4 * TIME_STEP)
        steps_until(3e-3)
        for _ in range(3):
            self.assertAlmostEqual(pushed(), 3e-3, delta=1e-9)
        self.assertAlmostEqual(pushed(), 2e-3, delta=1e-9)
        push('wind', 0, 0)
        steps_until(0.0)
        status = message('/diagnostics', DiagnosticArray).status[0]
        values = {item.key: item.value for item in status.values}
        self.assertEqual(int(values['external forces refused']), 2)
        self.assertEqual(values['last external forces refused for'],
                         "header.frame_id = '': allowed is 'world'")
        publisher.unregister()

    def test_sets_states(self):
        self.accepted(self.step(steps=3))
        before = self.state()
        self.accepted(self.set_state(WORLD, [CORNER], [Point(0.01, -0.1, -0.19)], []))
        after = self.state()
        self.assertEqual(after.positions[CORNER], Point(0.01, -0.1, -0.19))
        self.assertEqual(after.positions[1:], before.positions[1:])
        self.assertEqual(after.velocities, before.velocities)
        self.assertNotEqual(after.forces, before.forces)
        self.assertGreater(after.header.stamp, before.header.stamp)
        self.accepted(self.step(steps=1))
        self.accepted(self.set_state(WORLD, [], before.positions, before.velocities))
        again = self.state()
        self.assertEqual((again.positions, again.velocities), (before.positions, before.velocities))

    def test_refuses_states(self):
        for header in (Header(), Header(frame_id='map')):
            self.refused(self.set_state, header, [CORNER], [Point()], [], says='header.frame_id')
        for particles, places, velocities, says in (
                ([CORNER], [], [], 'positions and velocities are empty'),
                ([PARTICLES], [Point()], [], f'particles[0] = {PARTICLES} does not exist'),
                ([CORNER], [Point(), Point()], [], 'positions has 2 elements and particles 1'),
                ([CORNER], [Point(NAN, 0, 0)], [], 'positions[0] = (nan, 0, 0) m'),
                ([CORNER], [], [Vector3(0, 0, INFINITY)], 'velocities[0] = (0, 0, inf) m/s'),
                ([TOP_CORNER], [Point()], [], f'particle {TOP_CORNER} is attached')):
            self.refused(self.set_state, WORLD, particles, places, velocities, says=says)

    def test_saves_states(self):
        self.accepted(self.step(steps=3))
        state = self.state()
        with tempfile.TemporaryDirectory() as directory:
            path = os.path.join(directory, 'three_steps.state')
            self.accepted(self.save_state(path))
            self.assertEqual(os.listdir(directory), ['three_steps.state'])
            with open(path, encoding='utf-8') as file:
                lines = file.read().splitlines()
            self.assertEqual(lines[:3], ['haptex cloth state', f'particles {PARTICLES}',
                                         f'time {state.simulated_time!r}'])
            numbers = np.loadtxt(path, skiprows=3)
            self.assertEqual(numbers[:, :3].tolist(), positions(state).tolist())
            self.assertEqual(numbers[:, 3:].tolist(),
                             [[v.x, v.y, v.z] for v in state.velocities])
            self.refused(self.save_state, os.path.join(directory, 'none', 'a.state'),
                         says='cannot be written: No such file or directory')
        self.refused(self.save_state, 'three_steps.state', says='allowed are absolute paths')

    def test_excludes_and_includes_particles(self):
        self.accepted(self.step(steps=20))
        start = self.state_after(20, 0)
        half = [i for i in range(PARTICLES) if i // 33 < 16]  # the lower rows
        answer = self.accepted(self.exclude([], [0.0, 0.2], [0.0, 0.2 * 15 / 32]))
        self.assertEqual(answer.message, f'{len(half)} particles of {PARTICLES} excluded')
        excluded = self.state_after(20, len(half))
        self.assertEqual(list(excluded.excluded), half)
        self.assertTrue(set(half) <= set(excluded.attached))
        self.assertEqual(excluded.positions, start.positions)
        self.accepted(self.step(steps=20))
        moved = self.state_after(40, len(half))
        self.assertEqual(moved.positions[:len(half)], start.positions[:len(half)])
        self.assertNotEqual(moved.positions[len(half):], start.positions[len(half):])
        self.accepted(self.include([CORNER], [], []))
        self.assertEqual(list(self.state_after(40, len(half) - 1).excluded), half[1:])
        self.accepted(self.include([], [], []))
        included = self.state_after(40, 0)
        self.assertEqual(included.positions, moved.positions)
        self.assertEqual(included.attached, start.attached)
        self.accepted(self.step(steps=20))
        self.assertNotEqual(self.state_after(60, 0).positions[CORNER], moved.positions[CORNER])

    def test_refuses_to_exclude(self):
        self.refuses_particles(lambda particles: self.exclude(particles, [], []))
        self.refused(self.include, [PARTICLES], [], [], says='does not exist')
        for weft, warp, says in (
                ([0.0], [0.0, 0.1], 'region: weft = [0] m: allowed are two finite numbers'),
                ([0.0, 0.1], [], 'region: warp = [] m'),
                ([0.0, NAN], [0.0, 0.1], 'region: weft = [0, nan] m'),
                ([0.1, 0.0], [0.0, 0.1], 'region: weft = [0.1, 0] m'),
                ([0.5, 0.6], [0.0, 0.1], 'no particle lies in the region'),
                ([0.0, 1.0], [0.0, 1.0], f'all {PARTICLES} particles would be excluded')):
            self.refused(self.exclude, [], weft, warp, says=says)
        self.accepted(self.exclude([CORNER, TOP_CORNER], [], []))
        for call in (lambda: self.release([TOP_CORNER]), lambda: self.attach(WORLD, [CORNER], []),
                     lambda: self.move(WORLD, [TOP_CORNER], Vector3(), 1)):
            self.refused(call, says='is excluded from the computation')

    def test_heartbeat_goes_on_while_paused(self):
        beats = []
        subscriber = rospy.Subscriber('cloth/heartbeat', Header, beats.append, tcp_nodelay=True)
        message('cloth/heartbeat', Header)
        count = len(beats)
        rospy.sleep(2.0)
        subscriber.unregister()
        # 400 beats; a busy machine may delay some.
        self.assertGreater(len(beats) - count, 200)
        self.assertLess(len(beats) - count, 440)
        self.assertEqual(beats[0].frame_id, 'world')

    def test_refuses_steps(self):
        self.refused(self.step, 0, 0.0, says='steps = 0: allowed are 1 to 100000')
        self.refused(self.step, 100001, 0.0, says='steps = 100001: allowed are 1 to 100000')
        self.accepted(self.pause(False))
        response = self.step(steps=1)
        self.assertFalse(response.success)
        self.assertIn('while it is paused', response.message)

    def test_refuses_fabrics(self):
        self.refused(self.set_fabric, 'tweed', says="there is no 'tweed'")
        self.refused(self.set_fabric, '', says="there is no ''")
        self.refused(self.set_fabric, '/no/such/fabric.yaml', says='/no/such/fabric.yaml')
        scene = rospy.get_param('/scene_path')
        self.refused(self.set_fabric, scene, says=scene)  # YAML, but not of a fabric
        self.assertEqual(message('cloth/mesh', ClothMesh).fabrics, ['wool'])

    def test_refusals_tell_nothing_of_a_file_of_another_kind(self):
        with open('/etc/passwd', encoding='utf-8') as file:
            words = [line.split(':')[-2] for line in file]  # home directories
        answer = self.refused(self.set_fabric, '/etc/passwd', says='must be a map with the keys')
        self.assertEqual([word for word in words if len(word) > 3 and word in answer.message], [])

    def test_refusals_repeat_at_most_two_hundred_characters(self):
        logged = []
        subscriber = rospy.Subscriber('/rosout', Log, lambda log: logged.append(log.msg))
        eventually(lambda: subscriber.get_num_connections() > 1, 'the log')  # this test and the node
        long = 'a' * 10_000_000
        says = f"there is no '{200 * 'a'}'... (10000000 characters)"
        answers = [
            self.refused(self.set_fabric, long, says=says),
            self.refused(self.set_state, Header(frame_id=long), [CORNER], [Point()], [],
                         says='(10000000 characters)')]
        eventually(lambda: any(says in text for text in logged), 'the refusal in the log')
        subscriber.unregister()
        self.assertLess(max(map(len, [*logged, *(answer.message for answer in answers)])), 1000)

    def refuses_particles(self, call):
        """`call` takes a list of particles."""
        self.refused(call, [], says='particles is empty')
        self.refused(call, [CORNER, PARTICLES],
                     says=f'particles[1] = {PARTICLES} does not exist: allowed are 0 to '
                          f'{PARTICLES - 1}')
        self.refused(call, [CORNER, CORNER], says='named twice')

    def refuses_frames(self, call):
        """`call` takes a header."""
        self.refused(call, Header(), says="header.frame_id = '': allowed is 'world'")
        self.refused(call, Header(frame_id='map'), says="header.frame_id = 'map'")

    def test_refuses_to_attach(self):
        self.refuses_particles(lambda particles: self.attach(WORLD, particles, []))
        self.refuses_frames(lambda header: self.attach(header, [CORNER], []))
        self.refused(self.attach, WORLD, [0, 1], [Point()], says='positions has 1 elements')
        self.refused(self.attach, WORLD, [0], [Point(), Point()], says='positions has 2 elements')
        for number in (NAN, INFINITY, -INFINITY, 101.0):
            self.refused(self.attach, WORLD, [0, 1], [Point(), Point(0, 0, number)],
                         says='positions[1] = ')
        self.accepted(self.step(steps=1))
        self.refused(self.release, [CORNER], says='is not attached')  # none has been attached

    def test_refuses_to_move(self):
        self.refuses_particles(lambda particles: self.move(WORLD, particles, Vector3(), 1))
        self.refuses_frames(lambda header: self.move(header, [TOP_CORNER], Vector3(), 1))
        self.refused(self.move, WORLD, [TOP_CORNER, CORNER], Vector3(), 1,
                     says='particles[1] = 0 is not attached')
        for number in (NAN, INFINITY):
            self.refused(self.move, WORLD, [TOP_CORNER], Vector3(number, 0, 0), 1,
                         says='displacement = ')
        self.refused(self.move, WORLD, [TOP_CORNER], Vector3(0, 0, 1000), 1,
                     says='the end of the path')
        for duration in (-1.0, NAN, INFINITY):
            self.refused(self.move, WORLD, [TOP_CORNER], Vector3(), duration, says='duration = ')
        place = positions(self.state())[TOP_CORNER].tolist()
        self.accepted(self.step(steps=5))
        self.assertEqual(positions(self.state())[TOP_CORNER].tolist(), place)

    def test_refuses_to_release(self):
        self.refuses_particles(self.release)
        self.refused(self.release, [TOP_CORNER, CORNER], says='particles[1] = 0 is not attached')
        self.accepted(self.release([TOP_CORNER]))  # so it had stayed attached

    def test_refuses_jacobians(self):
        self.refuses_particles(self.get_jacobian)
        self.assertEqual(len(self.get_jacobian([]).rows), 0)

    def test_refuses_to_tell_of_budgets_without_quality(self):
        self.refused(self.query_budget, 5.0, says='start it with ~quality or ~budget_ms')


if __name__ == '__main__':
    rospy.init_node('cloth_simulation_test')
    rostest.rosrun('haptex', 'topics_and_services', ClothSimulation)
