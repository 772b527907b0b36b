#!/usr/bin/python3
"""The machine rater finds what was put into synthetic records of a device, and refuses what shows nothing."""
import pathlib
import sys
import tempfile
import unittest

import numpy as np
import rostest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'scripts'))
from machine_rater import rater  # noqa: E402
from machine_rater.records import DeviceRecord  # noqa: E402

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
            thickness, loaded, share = rater.compression(pinched, FINGERTIPS)
            first = gaps[np.argmax(forces > rater.FIRST_FORCE)]
            self.assertAlmostEqual(thickness.value, first, delta=1e-5)
            self.assertAlmostEqual(loaded.value, thin, delta=0.1 * thin)
            self.assertAlmostEqual(share.value, 1.0 - loaded.value / thickness.value, delta=1e-3)
        with self.assertRaisesRegex(ValueError, 'presses with up to 0 N'):
            rater.compression(record(vectors(), vectors()), FINGERTIPS)

    def test_two_spheres_press_a_linear_layer_with_the_force_of_hertz_s_foundation(self):
        # Pulps alone: p = k d / 2, so F = pi R k d^2 / 2.
        depth = 1e-3
        force = rater.pinch_force(-depth, 0.0, 0.0, FINGERTIPS)
        self.assertAlmostEqual(float(force), 0.5 * np.pi * FINGERTIPS.radius * 8e6 * depth ** 2,
                               delta=1e-3 * float(force))

    def test_stiffness_is_the_slope_until_the_force_falls(self):
        force = np.where(TIMES < 2.0, 0.25 * TIMES, 0.1)  # slips at 0.5 N
        drawn = record(vectors(z=-2e-3 * TIMES), vectors(x=1.0, z=0.5 * force))
        found = rater.stiffness(drawn, (0.0, 0.0, -1.0), 0.05, 0.3)
        self.assertAlmostEqual(found.value, 125.0, 6)
        with self.assertRaisesRegex(ValueError, 'for 0 samples'):
            rater.stiffness(record(vectors(), vectors()), (0.0, 0.0, -1.0), 0.05, 0.3)

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


if __name__ == '__main__':
    rostest.rosrun('haptex', 'machine_rater', Rating)
