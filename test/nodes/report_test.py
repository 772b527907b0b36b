#!/usr/bin/python3
"""A report says what its bag holds: synthetic bags with known rates, losses, dips, friction and strain,
bags that were cut off, and bags of others."""
import base64
import csv
import gzip
import io
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

import numpy as np
import rosbag
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from genpy.dynamic import generate_dynamic
from geometry_msgs.msg import Point, Vector3, WrenchStamped
from sensor_msgs.msg import Image
from std_msgs.msg import String

from haptex.msg import ClothMesh, ClothState, Contact, OperatingState, Tactile
from unit_fixtures import Folder, suite_of

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / 'scripts' / 'report'
sys.path.insert(0, str(ROOT / 'scripts'))
from bag_report import figures  # noqa: E402
from bag_report.mechanics import FabricFile  # noqa: E402

START = 1000.0  # s since the epoch
LENGTH = 4.0  # s
SIDE = 0.2  # m
WIDTH_STRAIN, FORCE = 0.02, 0.3  # of the pulled cloth along warp; N
FRICTION = 0.25
MODULUS = 75.0  # N/m
FABRIC = f'''name: plain
areal_density: {{value: 0.1, unit: kg/m2, provenance: measured, source: a balance}}
weft:
  elastic: {{unit: N/m, provenance: representative, source: assumed, modulus: 50}}
warp:
  elastic: {{unit: N/m, provenance: measured, source: a test, modulus: {MODULUS}}}
friction: {{provenance: representative, source: assumed, value: {FRICTION}}}
'''


def at(time):
    return rospy.Time.from_sec(START + time)


def stamped(message, time, sequence):
    message.header.stamp = at(time)
    message.header.seq = sequence
    return message


class Session:
    """Writes what a session of LENGTH publishes; subclasses leave out or change."""

    def write(self, path, compression='none'):
        with rosbag.Bag(path, 'w', compression=compression, chunk_threshold=40000) as bag:
            messages = sorted(self.messages(), key=lambda item: item[2])
            for topic, message, time in messages:
                bag.write(topic, message, at(time))

    def messages(self):
        yield '/recording/about', String('scene: sheet.yaml\nversion: 1.2.3\n'), 0.0
        yield '/haptex/cloth/mesh', self.mesh(), 0.0
        for i in range(int(80 * LENGTH)):
            yield '/haptex/cloth/state', stamped(self.state(i), i / 80, i), i / 80
        for i in range(int(1000 * LENGTH)):
            if i in (500, 501, 502):  # three are lost
                continue
            yield '/haptex/index/measured_cf', stamped(self.felt(i / 1000), i / 1000, i), i / 1000
        for i in range(int(250 * LENGTH)):
            yield '/haptex/index/contact', stamped(self.contact(i / 250), i / 250, i), i / 250
        for i in range(int(40 * LENGTH)):
            yield '/haptex/index/tactile', stamped(self.tactile(), i / 40, i), i / 40
        for time, state in ((0.0, 'DISABLED'), (1.0, 'ENABLED'), (2.0, 'ENABLED'), (3.0, 'FAULT')):
            message = OperatingState(state=state, fault='the hand opened' if time == 3.0 else '')
            yield '/haptex/exoskeleton/operating_state', message, time
        for time in (1.0, 2.0):
            status = DiagnosticStatus(level=1, name='cloth', message=f'late by {time} ms')
            yield '/diagnostics', DiagnosticArray(status=[status]), time

    @staticmethod
    def mesh():
        grid = [(u, v) for v in (0.0, SIDE) for u in (0.0, SIDE)]
        return ClothMesh(fabrics=['plain'], fabric_files=[FABRIC], triangles=[0, 1, 2, 1, 3, 2],
                         rest_weft_coordinates=[u for u, _ in grid],
                         rest_warp_coordinates=[v for _, v in grid], masses=[0.001] * 4)

    @staticmethod
    def state(step):
        strain, force = (WIDTH_STRAIN, FORCE) if step >= 160 else (0.0, 0.0)
        places = [Point(u, 0.0, v * (1.0 + strain)) for v in (0.0, SIDE) for u in (0.0, SIDE)]
        forces = [Vector3(0.0, 0.0, (1 if v else -1) * -0.5 * force)
                  for v in (0, 1) for _ in range(2)]
        return ClothState(step=step, simulated_time=step / 80, positions=places, forces=forces,
                          velocities=[Vector3()] * 4, attached=[2, 3])

    @staticmethod
    def felt(time):
        """1 N from the first second on, with a dip of 20 ms."""
        message = WrenchStamped()
        size = 0.0 if time < 1.0 else 0.1 if 2.5 <= time < 2.52 else 1.0
        message.wrench.force = Vector3(0.6 * size, 0.0, 0.8 * size)
        return message

    @staticmethod
    def contact(time):
        if time < 1.0:
            return Contact()
        way = 0 if time < 3.0 else 1 if time < 3.5 else -1  # it slides along weft, and back
        return Contact(touching=True, slipping=way != 0, normal_force=0.5,
                       force=Vector3(-way * FRICTION * 0.5, 0.0, -0.5), normal=Vector3(0.0, 0.0, 1.0),
                       sliding_velocity=Vector3(0.05 * way, 0.0, 0.0), fabric_velocity=[0.05 * way, 0.0],
                       fabric_position=[0.05 * max(0.0, 0.5 - abs(time - 3.5)), 0.1])

    @staticmethod
    def tactile():
        return Tactile(step_time=0.025, amplitudes_40=[8.0] * 24, amplitudes_320=[2.0] * 24,
                       velocity=[0.015, 0.0], normal_force=0.5)


class Bags(Folder):
    def setUp(self):
        super().setUp()
        self.bag = self.folder / 'session.bag'

    def report(self, bag, expected=0):
        """The page, or what was said on standard error."""
        output = self.folder / 'report.html'
        run = subprocess.run([PROGRAM, str(bag), str(output)], capture_output=True, text=True)
        self.assertEqual(run.returncode, expected, run.stderr)
        if expected == 0:
            return output.read_text()
        self.assertFalse(output.exists())
        self.assertEqual(len(run.stderr.strip().splitlines()), 1, run.stderr)
        return run.stderr

    def numbers(self, page, name):
        """Rows of a CSV of the page, as dictionaries."""
        link = re.search(f'download="{name}.csv(.gz)?" href="data:[^,]*,([^"]*)"', page)
        self.assertIsNotNone(link, name)
        data = base64.b64decode(link.group(2))
        text = (gzip.decompress(data) if link.group(1) else data).decode()
        return list(csv.DictReader(io.StringIO(text)))


class Reports(Bags):
    def test_have_the_numbers_of_the_session(self):
        Session().write(self.bag)
        page = self.report(self.bag)
        rates = {row['topic']: row for row in self.numbers(page, 'rates')}
        state, felt = rates['/haptex/cloth/state'], rates['/haptex/index/measured_cf']
        self.assertAlmostEqual(float(state['rate (Hz)']), 80.0, 3)
        self.assertEqual([state['lost'], felt['lost'], felt['gaps']], ['0', '3', '0'])
        self.assertAlmostEqual(float(felt['longest (ms)']), 4.0, 3)
        dip, = self.numbers(page, 'dips')
        self.assertAlmostEqual(float(dip['begin (s)']), 2.5, 6)
        self.assertAlmostEqual(float(dip['length (ms)']), 20.0, 3)
        self.assertAlmostEqual(float(dip['least (N)']), 0.1, 6)
        rubbed, = self.numbers(page, 'friction')
        self.assertAlmostEqual(float(rubbed['median']), FRICTION, 6)
        self.assertEqual(rubbed['fabric'], 'plain')
        loop = {round(float(row['time (s)']), 3): row for row in self.numbers(page, 'friction_index')}
        self.assertEqual([float(loop[time]['along weft (N)']) for time in (3.2, 3.8)],
                         [0.5 * FRICTION, -0.5 * FRICTION])
        self.assertEqual(float(loop[3.2]['along warp (N)']), 0.0)
        drawn = self.numbers(page, 'extension')[-1]
        self.assertAlmostEqual(float(drawn['warp strain']), WIDTH_STRAIN, 9)
        self.assertAlmostEqual(float(drawn['warp force (N/m)']), FORCE / SIDE, 9)
        speed, = self.numbers(page, 'tactile_by_speed')
        self.assertEqual([float(speed[key]) for key in ('from (mm/s)', '40 Hz (um)', '320 Hz (um)')],
                         [10.0, 8.0, 2.0])
        states = [row['state'] for row in self.numbers(page, 'states')]
        self.assertEqual(states, ['DISABLED', 'ENABLED', 'FAULT: the hand opened'])
        warning, = self.numbers(page, 'warnings')
        self.assertEqual([warning['times'], warning['what']], ['2', 'late by 2.0 ms'])

    def test_say_what_ran_and_what_is_missing(self):
        Session().write(self.bag, 'lz4')
        page = self.report(self.bag)
        for text in ('sheet.yaml', '1.2.3', 'plain', 'forces of the thumb', 'No camera', 'lz4',
                     'a pull along weft'):
            self.assertIn(text, page)
        self.assertNotIn('src="http', page)

    def test_show_pictures_of_cameras(self):
        class Filmed(Session):
            def messages(self):
                yield from super().messages()
                for time in range(4):
                    yield '/camera', Image(height=2, width=3, step=9, encoding='rgb8',
                                           data=bytes(18)), float(time)
        Filmed().write(self.bag)
        self.assertIn('alt="/camera at 3.0 s"', self.report(self.bag))

    def test_survive_numbers_that_are_none_and_states_without_their_mesh(self):
        class Odd(Session):
            def messages(self):
                yield from super().messages()
                broken = self.felt(2.0)
                broken.wrench.force.x = float('nan')
                yield '/haptex/index/measured_cf', stamped(broken, 2.0001, 0), 2.0001
                yield '/haptex/cloth/state', ClothState(mesh=7, positions=[Point()]), 2.0
                yield '/haptex/cloth/state', ClothState(positions=[Point()]), 2.0
                lost = self.state(0)
                lost.positions[0].x = float('nan')
                yield '/haptex/cloth/state', stamped(lost, 0.001, 0), 0.001
                yield '/camera', Image(height=5, width=3, step=9, encoding='rgb8'), 1.0
                yield '/depth', Image(height=1, width=1, step=2, encoding='16UC1', data=bytes(2)), 1.0
                for time in (1.1, 1.2):
                    yield '/other/cloth/mesh', ClothMesh(mesh=9, triangles=[0, 1, 2],
                                                         rest_weft_coordinates=[0.0] * 3,
                                                         rest_warp_coordinates=[0.0] * 3), time
        Odd().write(self.bag)
        page = self.report(self.bag)
        missing = page[page.index('>What is missing</h2>'):]
        for topic, text in (('/haptex/cloth/state', '1 messages could not be read'),
                            ('/haptex/cloth/state', '1 messages with numbers that are not finite'),
                            ('/haptex/index/measured_cf', '1 messages with numbers that are'),
                            ('/camera', '1 messages could not be read'),
                            ('/depth', '1 messages could not be read: pictures are drawn of rgb8'),
                            ('/other/cloth/mesh', '2 messages could not be read: the mesh has')):
            self.assertIn(f'<td>{topic}</td><td>{text}', missing)

    def test_read_what_they_know_of_messages_of_another_version(self):
        Session().write(self.bag)
        other = self.folder / 'older.bag'
        of_state = generate_dynamic('haptex/ClothState', 'uint64 step')['haptex/ClothState']
        with rosbag.Bag(self.bag) as bag, rosbag.Bag(other, 'w') as older:
            for topic, message, time in bag:
                older.write(topic, of_state(step=1) if topic == '/haptex/cloth/state' else message, time)
        page = self.report(other)
        self.assertIn(f'{int(80 * LENGTH)} messages could not be read: they are of another version', page)
        self.assertEqual(len(self.numbers(page, 'dips')), 1)

    def test_follow_sheets_and_factors_that_change(self):
        class Changed(Session):
            def messages(self):
                yield from super().messages()
                mesh = self.mesh()
                mesh.factors = [1.0, 2.0, 1.0, 1.0, 1.0]
                yield '/haptex/cloth/mesh', mesh, 1.0
                yield '/haptex/cloth/mesh', mesh, 1.5  # says the same again
                wide = self.mesh()
                wide.mesh, wide.rest_weft_coordinates = 1, [0.0, 2 * SIDE] * 2
                yield '/haptex/cloth/mesh', wide, LENGTH
                state = self.state(320)
                state.mesh = 1
                yield '/haptex/cloth/state', stamped(state, LENGTH, 320), LENGTH
        Changed().write(self.bag)
        page = self.report(self.bag)
        rows = self.numbers(page, 'extension')
        self.assertEqual([row['cloth'] for row in rows], 80 * ['0.0'] + 240 * ['1.0'] + ['2.0'])
        self.assertAlmostEqual(float(rows[-2]['warp force (N/m)']), FORCE / SIDE, 9)
        self.assertAlmostEqual(float(rows[-1]['warp force (N/m)']), FORCE / (2 * SIDE), 9)
        self.assertIn('<td>factors from 1.0 s</td><td>warp 2</td>', page)

    def test_do_without_any_topic_but_one(self):
        with rosbag.Bag(self.bag, 'w') as bag:
            bag.write('/other/thumb/contact', Contact(), at(0.0))
        page = self.report(self.bag)
        self.assertIn('cloth/mesh', page)
        self.assertIn('No finger slid', page)

    def test_of_bags_that_were_cut_off_end_there(self):
        Session().write(self.bag)
        data = self.bag.read_bytes()
        cut = self.folder / 'killed.bag.active'
        shares, spans = (0.3, 0.6, 0.95), []
        for share in shares:
            cut.write_bytes(data[:int(share * len(data))])
            page = self.report(cut)
            self.assertIn('cut off', page)
            spans.append(float(self.numbers(page, 'extension')[-1]['time (s)']))
            self.assertEqual(len(cut.read_bytes()), int(share * len(data)), 'the bag was changed')
        self.assertEqual(spans, sorted(spans))
        self.assertGreater(spans[0], 0.15 * LENGTH)
        self.assertGreater(spans[-1], 0.7 * LENGTH)

    def test_of_damaged_bags_end_where_the_damage_is(self):
        Session().write(self.bag)
        data = bytearray(self.bag.read_bytes())
        middle = data.index(b'op=\x02', len(data) // 2)  # the header of a message
        data[middle:middle + 2] = b'xx'
        self.bag.write_bytes(data)
        page = self.report(self.bag)
        self.assertIn('the bag is damaged', page)
        end = float(self.numbers(page, 'extension')[-1]['time (s)'])
        self.assertGreater(end, 0.3 * LENGTH)
        self.assertLess(end, 0.7 * LENGTH)

    def test_do_not_replace_their_bag(self):
        Session().write(self.bag)
        data = self.bag.read_bytes()
        run = subprocess.run([PROGRAM, self.bag, self.bag], capture_output=True, text=True)
        self.assertEqual(run.returncode, 2)
        self.assertIn('that is the bag itself', run.stderr)
        self.assertEqual(self.bag.read_bytes(), data)

    def test_are_refused_clearly(self):
        other, empty, text = (self.folder / name for name in ('other', 'empty', 'text'))
        with rosbag.Bag(other, 'w') as bag:
            bag.write('/chatter', String('hello'), at(0.0))
        with rosbag.Bag(empty, 'w'):
            pass
        text.write_text('no bag\n')
        self.assertIn('/chatter', self.report(other, 2))
        self.assertIn('no message', self.report(empty, 2))
        self.assertIn('no bag', self.report(text, 2))
        self.assertIn('no such file', self.report(self.folder / 'none', 2))
        shutil.copy(text, self.folder / 'short')
        Session().write(self.bag)
        (self.folder / 'short').write_bytes(self.bag.read_bytes()[:5000])
        self.assertIn('cut off', self.report(self.folder / 'short', 2))


class Figures(unittest.TestCase):
    def test_a_dip_is_only_where_the_cloth_is_touched(self):
        times = np.arange(0.0, 2.0, 1e-3)
        forces = np.where((times > 1.0) & (times < 1.05), 0.0, 1.0)
        self.assertEqual(len(figures.dips(times, forces)), 1)
        self.assertEqual(figures.dips(times, forces, (np.array([0.0]), np.array([False]))), [])

    def test_curves_of_files_are_force_per_width_over_elongation(self):
        text = FABRIC.replace('modulus: 50', 'quantity: force_per_width_over_engineering_strain, '
                              'points: [[0, 0], [0.1, 5]]')
        fabric = FabricFile(text)
        strains, forces = fabric.curve('weft')
        self.assertEqual([strains[-1], forces[-1]], [0.1, 5.0])
        polynomials = FabricFile(FABRIC.replace(
            'modulus: 50', 'polynomials: {knots: [0, 0.1, 0.3], coefficients: [[0, 50, 0, 0], '
                           '[5, 50, 100, 0]]}'))
        strains, forces = polynomials.curve('weft', 2.0)  # stress 5 + 50 x + 100 x^2, x = strain - 0.1
        self.assertAlmostEqual(strains[-1], np.sqrt(1.6) - 1.0, 12)
        self.assertAlmostEqual(forces[-1], 2.0 * np.sqrt(1.6) * (5.0 + 10.0 + 4.0), 9)
        strains, forces = fabric.curve('warp')  # stress = modulus times Green strain
        np.testing.assert_allclose(
            forces, (1.0 + strains) * MODULUS * 0.5 * ((1.0 + strains) ** 2 - 1.0), atol=1e-9)

    def test_curves_are_drawn_where_the_cloth_was(self):
        strains, forces = FabricFile(FABRIC).curve_between('warp', 0.0, 1e-4)
        self.assertEqual([strains[0], strains[-1]], [0.0, 1e-4])
        np.testing.assert_allclose(forces, MODULUS * strains, rtol=5e-3)


Tests = suite_of(Reports, Figures)


if __name__ == '__main__':
    rostest.rosrun('haptex', 'report', f'{__name__}.Tests')
