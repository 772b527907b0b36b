#!/usr/bin/python3
"""The machine rater finds what was put into synthetic records of a device, and refuses what shows nothing."""
import argparse
import contextlib
import io
import pathlib
import sys
import tempfile
import unittest
import unittest.mock

import numpy as np
import rostest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / 'scripts'), str(ROOT / 'test' / 'nodes')]
from machine_rater import overhang, pressed_strips, rater, study, units  # noqa: E402
from machine_rater.records import DeviceRecord  # noqa: E402
from unit_fixtures import suite_of  # noqa: E402

FINGERTIPS = rater.Fingertips(7.5e-3, 9e-3, 8e6)
TIMES = np.arange(4000) * 1e-3  # s


def record(places, forces):
    """Of two fingers that face each other along x. @param forces (n, axis) on each, along x opposite"""
    opposite = np.array([-1.0, 1.0, 1.0])
    gap = np.zeros_like(places) + [8.25e-3, 0.0, 0.0]
    return DeviceRecord(TIMES, np.stack([places + gap, places - gap], axis=1),
                        np.stack([forces, forces * opposite], axis=1))


def line(*ends):
    return np.linspace(*ends, len(TIMES))


def vectors(x=0.0, y=0.0, z=0.0):
    return np.column_stack([np.zeros(len(TIMES)) + part for part in (x, y, z)])


class Rating(unittest.TestCase):
    def test_weight_is_what_both_fingers_carry(self):
        swing = 0.002 * np.sin(2.0 * np.pi * 5.0 * TIMES)
        hanging = record(vectors(), vectors(x=0.5, z=-0.5 * 0.2 * 9.80665 * 0.04 + swing))
        weight = rater.weight(hanging)
        self.assertAlmostEqual(weight.value, 0.2, 6)
        self.assertLess(weight.uncertainty, 1e-3)

    def test_friction_is_that_of_the_part_of_the_way_where_it_slides(self):
        force = vectors(x=line(0.3, 0.4), z=0.21 * line(0.3, 0.4))
        force[:400, 2] = 0.0  # not yet on its way
        sliding = record(vectors(z=line(0.0, -0.05)), force)
        self.assertAlmostEqual(rater.friction(sliding).value, 0.21, 9)
        with self.assertRaisesRegex(ValueError, 'slide for 0 samples'):
            rater.friction(record(vectors(), force))

    def test_thickness_of_the_fabric_that_is_pinched(self):
        for thick, thin in ((0.4e-3, 0.3e-3), (2e-3, 1.3e-3)):
            gaps = line(thick + 2e-4, -1.4e-3)
            forces = rater.pinch_force(gaps, thick, thick - thin, FINGERTIPS)
            pinched = record(vectors(), vectors(x=forces))
            pinched.positions[:, 0, 0] = 0.5 * gaps + 8.25e-3
            pinched.positions[:, 1, 0] = -0.5 * gaps - 8.25e-3
            thickness, loaded, share = rater.compression(pinched, FINGERTIPS, 10.0)
            first = gaps[np.argmax(forces > rater.FIRST_FORCE)]
            self.assertAlmostEqual(thickness.value, first, delta=1e-5)
            self.assertAlmostEqual(loaded.value, thin, delta=0.1 * thin)
            self.assertAlmostEqual(share.value, 1.0 - loaded.value / thickness.value, delta=1e-3)
        with self.assertRaisesRegex(ValueError, 'presses with up to 0 N'):
            rater.compression(record(vectors(), vectors()), FINGERTIPS, 10.0)

    def test_compression_goes_from_T0_to_Tm_with_its_linearity(self):
        low, high = rater.KES_PRESSURES
        pressures = np.geomspace(low, high, 2000)
        shares = rater.compressed_share(pressures)
        self.assertAlmostEqual(shares[0], 0.0, 12)
        self.assertAlmostEqual(shares[-1], 1.0, 12)
        work = np.sum(0.5 * (pressures[1:] + pressures[:-1]) * np.diff(shares))
        self.assertAlmostEqual(work / (0.5 * high), rater.LINEARITY, delta=1e-4)

    def test_two_spheres_press_a_linear_layer_with_the_force_of_hertz_s_foundation(self):
        # Pulps alone: p = k d / 2, so F = pi R k d^2 / 2.
        depth = 1e-3
        force = rater.pinch_force(-depth, 0.0, 0.0, FINGERTIPS)
        self.assertAlmostEqual(float(force), 0.5 * np.pi * FINGERTIPS.radius * 8e6 * depth ** 2,
                               delta=1e-3 * float(force))

    def test_what_one_finger_feels_alone_is_no_thickness(self):
        gaps = line(6e-4, -1.4e-3)
        forces = rater.pinch_force(gaps, 4e-4, 1e-4, FINGERTIPS)
        pinched = record(vectors(), vectors(x=forces))
        pinched.positions[:, 0, 0] = 0.5 * gaps + 8.25e-3
        pinched.positions[:, 1, 0] = -0.5 * gaps - 8.25e-3
        alike = rater.compression(pinched, FINGERTIPS, 10.0)
        pinched.forces[:, 0, 0] += 1e-3  # the fabric is pushed aside by the index finger
        self.assertEqual(rater.compression(pinched, FINGERTIPS, 10.0)[0], alike[0])

    def test_each_pinch_is_judged(self):
        gaps = np.concatenate([np.linspace(6e-4, -1.4e-3, 1900), np.linspace(-1.4e-3, 6e-4, 100)] * 2)
        forces = rater.pinch_force(gaps, 4e-4, 1e-4, FINGERTIPS)
        forces[2000:] = rater.pinch_force(gaps[2000:], 5e-4, 1e-4, FINGERTIPS)
        pinched = record(vectors(), vectors(x=forces))
        pinched.positions[:, 0, 0] = 0.5 * gaps + 8.25e-3
        pinched.positions[:, 1, 0] = -0.5 * gaps - 8.25e-3
        thickness = rater.compression(pinched, FINGERTIPS, 2.0)[0]
        self.assertAlmostEqual(thickness.uncertainty, 0.05e-3, delta=0.01e-3)

    def test_a_coarse_device_is_late_and_rounds(self):
        rising = record(vectors(), vectors(x=0.1 * TIMES)).limited(quantum=0.005, delay=0.003)
        self.assertEqual(rising.forces[0, 0, 0], 0.0)
        late = 0.1 * (TIMES[1000] - 0.003)
        self.assertAlmostEqual(rising.forces[1000, 0, 0], 0.005 * round(late / 0.005), 12)

    def test_records_are_read_and_cut_files_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / 'wool_drag_1.f32'
            np.arange(26, dtype=np.float32).tofile(path)
            read = DeviceRecord.read(path)
            self.assertEqual(read.forces[1, 1, 2], 25.0)
            self.assertEqual(read.positions[0, 0, 0], 1.0)
            path.write_bytes(path.read_bytes()[:-4])
            with self.assertRaisesRegex(ValueError, 'has 25 numbers'):
                DeviceRecord.read(path)


STRIP = pressed_strips.Strip(0.2, 0.012)
RADIUS = FINGERTIPS.index_radius


def pressing(heights, forces):
    """The index finger comes along -x, with a fabric without thickness."""
    made = record(vectors(), vectors(x=forces))
    made.positions[:, 0, 0] = RADIUS - heights
    return made


class Pressing(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.contact = pressed_strips.Contact(STRIP, RADIUS, 8e6)

    def stretched(self, heights, tension_of):
        """Forces at heights (m) that a strip has whose tension (N/m) is that function of its strain."""
        forces = np.zeros_like(heights)
        for i, height in enumerate(heights):
            low, high = 0.0, 20.0
            for _ in range(25):  # the tension falls with the strain, so that it rises with the force
                force = 0.5 * (low + high)
                tension, strain = self.contact.stretch(height, force)
                if np.isnan(tension):
                    high = force
                elif tension < tension_of(strain):
                    low = force
                else:
                    high = force
            forces[i] = force
        return forces

    def test_a_string_lies_on_a_hard_fingertip_as_an_arc(self):
        hard = pressed_strips.Contact(STRIP, RADIUS, 1e8)
        slope = 0.2
        reach = 0.1 - RADIUS * np.sin(slope)
        height = reach * np.tan(slope) + RADIUS * (1.0 - np.cos(slope))
        tension, strain = hard.stretch(height, 2.0 * 50.0 * STRIP.width * np.sin(slope))
        self.assertAlmostEqual(tension, 50.0, delta=1.0)
        arc = RADIUS * slope
        self.assertAlmostEqual(strain, (reach / np.cos(slope) + arc - 0.1) / (0.1 - 0.5 * arc),
                               delta=0.03 * strain)

    def test_tension_and_slope_bear_the_force(self):
        # A deep pulp: then the strip is flatter than a triangle to the fingertip's surface.
        tension, strain = self.contact.stretch(0.03, 1.5)
        self.assertGreater(tension, 1.5 / (2.0 * STRIP.width * np.sin(np.arctan(0.3))))
        self.assertLess(strain, 1.0 / np.cos(np.arctan(0.3)) - 1.0)

    def test_what_no_strip_can_do_is_not_judged(self):
        self.assertTrue(np.isnan(self.contact.stretch(0.02, 1e3)).all())

    def test_stiffness_to_the_load_of_kes(self):
        heights = np.linspace(1e-3, 0.035, len(TIMES))
        some = np.linspace(0, len(TIMES) - 1, 20).astype(int)
        emt = 0.05
        forces = np.interp(heights, heights[some], self.stretched(
            heights[some], lambda strain: 490.3325 * np.expm1(strain / emt) / np.expm1(1.0)))
        found = pressed_strips.tensile_stiffness(pressing(heights, forces), self.contact, RADIUS, 0.0)
        self.assertAlmostEqual(found.value, 490.3325 / emt, delta=0.03 * found.value)
        with self.assertRaisesRegex(ValueError, 'tensions were felt'):
            pressed_strips.tensile_stiffness(pressing(heights, 0.0 * forces), self.contact, RADIUS, 0.0)

    def test_shear_of_a_strip_cut_at_45_degrees(self):
        shear, threads = 50.0, 1e-3
        heights = np.linspace(1e-3, 0.03, len(TIMES))
        some = np.linspace(0, len(TIMES) - 1, 20).astype(int)
        sheared = 1.0 - STRIP.width / STRIP.length
        forces = np.interp(heights, heights[some], self.stretched(
            heights[some], lambda strain: 4.0 * strain / (sheared / shear + threads)))
        found = pressed_strips.shear_stiffness(pressing(heights, forces), self.contact, RADIUS, 0.0,
                                               threads)
        self.assertAlmostEqual(found.value, shear, delta=0.02 * shear)

    def test_compliance_of_threads_that_are_stretched_little(self):
        heights = np.linspace(1e-3, 0.03, len(TIMES))
        some = np.linspace(0, len(TIMES) - 1, 20).astype(int)
        forces = np.interp(heights, heights[some],
                           self.stretched(heights[some], lambda strain: 400.0 * strain))
        self.assertAlmostEqual(pressed_strips.thread_compliance(
            pressing(heights, forces), self.contact, RADIUS, 0.0), 1.0 / 400.0, delta=5e-5)


class Overhanging(unittest.TestCase):
    def test_a_stiff_strip_hangs_as_a_cantilever(self):
        rigidity, load, length = 1e-6, 1e-4, 0.1
        *_, z = overhang.hanging_shape(rigidity, load, length, 0.05, (0.0, 0.0))
        self.assertAlmostEqual(z[-1], -load * length ** 4 / (8.0 * rigidity), delta=2e-3 * 0.00125)
        *_, z = overhang.hanging_shape(rigidity, 1e-9, length, length, (0.0, -1e-5))
        self.assertAlmostEqual(z[-1], -1e-5 * length ** 3 / (3.0 * rigidity), delta=1e-2 * 3.3e-3)

    def test_a_heavy_strip_hangs_as_the_elastica(self):
        # Tip drop over reach by w g L^3 / B: Romero et al. 2021 (doi 10.1145/3450626.3459939).
        for ratio, drop in ((1.0, 0.124562), (10.0, 1.066802), (100.0, 5.888105)):
            length = 0.1
            _, _, x, z = overhang.hanging_shape(length ** 3 / ratio, 1.0, length, 0.05, (0.0, 0.0))
            self.assertAlmostEqual(-z[-1] / x[-1], drop, delta=3e-3 * drop)

    def test_the_rigidity_of_a_strip_that_is_lowered(self):
        strip, weight, rigidity = pressed_strips.Strip(0.03, 0.02), 0.2, 1.2e-5
        load = weight * rater.GRAVITY * strip.width
        # The finger bears less and less of the strip, and follows it down.
        shares = line(0.6, 0.05)
        heights = []
        some = np.linspace(0, len(TIMES) - 1, 40).astype(int)
        for share in shares[some]:
            force = share * load * strip.length
            offset = RADIUS - np.sqrt(force / (np.pi * RADIUS * 8e6))
            low, high = -0.05, 0.01
            for _ in range(40):
                height = 0.5 * (low + high)
                above = overhang.distance(rigidity * strip.width, load, strip.length, (0.02, height),
                                          offset, (0.0, force))
                low, high = (height, high) if above > 0.0 else (low, height)
            heights.append(height)
        lowered = record(vectors(), vectors(z=-shares * load * strip.length))
        lowered.positions[:, 0] = np.column_stack([0.02 + 0.0 * TIMES, 0.0 * TIMES,
                                                   np.interp(TIMES, TIMES[some], heights)])
        found = overhang.bending(lowered, strip, FINGERTIPS, 0.0, weight)
        self.assertAlmostEqual(found.value, rigidity, delta=0.02 * rigidity)
        with self.assertRaisesRegex(ValueError, 'bears up to 0'):
            overhang.bending(record(vectors(), vectors()), strip, FINGERTIPS, 0.0, weight)


class Judging(unittest.TestCase):
    def test_what_a_record_does_not_show_is_left_out(self):
        contact = pressed_strips.Contact(STRIP, RADIUS, 8e6)
        hand = study.Hand(FINGERTIPS, 4.0, contact, contact, pressed_strips.Strip(0.03, 0.02))
        nothing = record(vectors(), vectors())
        self.assertEqual(set(study.judge(lambda name: nothing, hand, 2e-6, 'nothing')),
                         {'roughness', 'weight'})


def printed_by(work, arguments=None, lines=()):
    with contextlib.redirect_stdout(io.StringIO()) as out, \
            unittest.mock.patch('sys.stdin', io.StringIO(''.join(line + '\n' for line in lines))):
        work(arguments)
    return out.getvalue()


class Units(unittest.TestCase):
    def test_a_record_is_read_back_as_it_was(self):
        judged = {'weight': rater.Judgement(0.1 + 0.2, 1e-300), 'drape': rater.Judgement(1.0 / 3.0, 0.0)}
        coarse = {'weight': rater.Judgement(np.float64(0.1), 2.5e-7)}
        text = units.record_of('wool', 7, judged, coarse)
        self.assertEqual(text, 'wool\t7\tweight\t0.30000000000000004\t1e-300\tdrape\t0.3333333333333333\t0.0'
                         '\tcoarse/weight\t0.1\t2.5e-07')
        self.assertEqual(units.parse(text), ('wool', 7, judged, coarse))
        for other in ('', 'wool', 'wool\tone', 'wool\t7\tweight\t0.1', 'wool\t7\tweight\t0.1\tmuch'):
            with self.assertRaisesRegex(SystemExit, 'is no result of an evaluation'):
                units.parse(other)

    def test_fabrics_come_in_turn_and_are_judged_by_both_devices(self):
        fabrics = study.fabric_names()
        def judge_record(_directory, _hand, fabric, stroke, seed, quality, limits):
            self.assertEqual((fabric, stroke, quality), (fabrics[1], 5.0, study.FINEST))
            return {'weight': rater.Judgement(float(seed), 1.0 if limits else 0.0)}
        with unittest.mock.patch.object(study, 'run_hand', return_value=(None, [{fabrics[1]: 5.0}])) as hand, \
                unittest.mock.patch.object(study, 'judge_record', judge_record):
            text = printed_by(units.run, argparse.Namespace(cases=2, seed=8, unit=len(fabrics) + 1))
        self.assertEqual(text, f'{fabrics[1]}\t9\tweight\t9.0\t0.0\tcoarse/weight\t9.0\t1.0\n')
        self.assertEqual(hand.call_args[0][1:], ([fabrics[1]], [(9, study.FINEST)]))

    def test_the_summary_is_that_of_the_evaluation_and_of_all_seeds(self):
        fabrics = ['acrylic_knit', 'cotton_poplin', 'cotton_rep', 'denim', 'wool']
        files = {fabric: study.values_of(fabric) for fabric in fabrics}
        weights = sorted(files[fabric]['weight'] for fabric in fabrics)
        exact = [files[fabric]['weight'] for fabric in fabrics]
        swapped = [weights[[1, 0, 2, 3, 4][weights.index(weight)]] for weight in exact]
        turned = [weights[4 - weights.index(weight)] for weight in exact]
        def runs(*of_seeds):
            return [{fabric: {'weight': rater.Judgement(weight, 0.1)} for fabric, weight in zip(fabrics, of_seed)}
                    for of_seed in of_seeds]
        def summary(judged):
            return printed_by(units.summary, lines=[units.record_of(fabric, seed, run[fabric], run[fabric])
                                                    for seed, run in enumerate(judged) for fabric in fabrics])
        two = runs(exact, swapped)
        def evaluate(_):
            study.print_judgements(fabrics, two[0], files)
            study.print_ranks(fabrics, two, two[0], files)
        self.assertEqual(summary(two), printed_by(evaluate))
        self.assertIn('evaluate/weight/spearman\t1.0000\t', summary(two))
        self.assertIn('evaluate/weight/repeat\t0.9000\n', summary(two))
        # Between the last two.
        self.assertIn('evaluate/weight/repeat\t-1.0000\n', summary(runs(swapped, exact, turned)))
        self.assertNotIn('repeat', summary(runs(exact)))


Tests = suite_of(Rating, Pressing, Overhanging, Judging, Units)

if __name__ == '__main__':
    rostest.rosrun('haptex', 'machine_rater', f'{__name__}.Tests')
