#!/usr/bin/python3
"""Pictures show how a fabric's yarns lie, as light falls on them; the contact sheet shows all fabrics on one ball."""
import pathlib
import shutil
import sys
import tempfile
import unittest
from unittest import mock

import numpy as np
import rostest
from matplotlib.image import imread
from roslib.packages import find_node

from unit_fixtures import Folder, suite_of

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'scripts'))
from bag_report.bags import Refused  # noqa: E402
from cloth_picture import camera, cycles, environment, looks, povray, sheet, weave  # noqa: E402
from cloth_picture.obj_file import Surface, read_obj  # noqa: E402


def linear_of(drawn):
    return np.where(drawn <= 0.04045, drawn / 12.92, ((drawn + 0.055) / 1.055) ** 2.4)


class Weaves(unittest.TestCase):
    GREY = 'look: {warp: [0.6, 0.6, 0.6], weft: [0.6, 0.6, 0.6], gloss: 0, width: 1}'

    def wave(self, along_weft, along_warp, height=1e-3, size=(0.05, 0.03)):
        """A relief of one wave, and its slopes along weft and warp at rest coordinates."""
        size, places = np.array(size), (np.arange(64) + 0.5) / 64
        waves = 2.0 * np.pi * np.array([along_weft, along_warp])
        heights = height * np.sin(waves[0] * places + waves[1] * places[::-1, None])
        return weave.Relief(heights, np.ones((64, 64)), size), lambda u, v: height * np.cos(
            waves[0] * u / size[0] + waves[1] * v / size[1]) * (waves / size)[:, None, None]

    def test_lose_what_pixels_do_not_see_and_keep_their_mean(self):
        relief, _ = self.wave(1, 2)
        lifted = weave.Relief(relief.heights + 5e-3, relief.warp, relief.size)
        self.assertAlmostEqual(lifted.seen(1e-6).slopes() / relief.seen(1e-6).slopes(), 1.0, 9)
        pixel = 0.01
        waves = (1 / 0.05) ** 2 + (2 / 0.03) ** 2  # per square metre
        left = np.exp(-2.0 * (np.pi * weave.BLUR * pixel) ** 2 * waves)
        seen = lifted.seen(pixel).heights
        self.assertAlmostEqual(seen.mean(), 5e-3, 12)
        self.assertAlmostEqual(seen.std() / relief.heights.std(), left, 9)

    def test_from_afar_are_of_one_colour_by_the_share_of_the_warp(self):
        fabric = looks.Fabric('some', 'look: {warp: [0, 0.5, 1], weft: [1, 0.5, 0], gloss: 0, width: 1}')
        warp = np.zeros((8, 8))
        warp[:6] = 1.0
        relief = weave.Relief(np.zeros((8, 8)), warp, (0.001, 0.001))
        far, near = weave.Weave(fabric, relief, 0.01), weave.Weave(fabric, relief, 1e-5)
        np.testing.assert_allclose(far.even.warp, [0.25, 0.5, 0.75])
        self.assertIsNone(far.relief)
        np.testing.assert_allclose(near.colours()[[96, 224], 128], [fabric.look.warp, fabric.look.weft], atol=0.1)

    @unittest.skipUnless(shutil.which('povray'), 'POV-Ray is not installed')
    def test_of_povray_are_as_bright_as_their_slopes_make_them(self):
        drawn, exact, _ = self.drawn_wave(povray)
        # POV-Ray's slopes are differences from the sample before: half a sample is 1.4 degrees of the shorter
        # wave. Half a step of 8 bits is 0.003.
        self.assertLess(np.abs(drawn - exact).max(), 0.02)

    @unittest.skipUnless(shutil.which('blender'), 'Blender is not installed')
    def test_of_cycles_are_as_bright_as_their_slopes_make_them(self):
        drawn, exact, leaning = self.drawn_wave(cycles)
        # What leans to the light more than the triangle does is darkened as if facets shadowed each other (Chiang,
        # Li and Burley, Taming the shadow terminator, 2019).
        exact = exact * np.where(leaning < 1.0, leaning + leaning ** 2 - leaning ** 3, 1.0)
        # 64 places in 1.5 pixels, over which the brightness changes by 0.06 at most.
        self.assertLess(np.abs(drawn - exact).max(), 0.03)
        self.assertLess(np.sqrt(np.mean(np.square(drawn - exact))), 0.007)
        self.assertLess(abs((drawn - exact).mean()), 0.001)

    def test_of_several_fabrics_are_each_in_its_colour(self):
        colours = [(0.6, 0.05, 0.05), (0.05, 0.6, 0.05)]
        weaves = [weave.Weave(looks.Fabric('some', f'look: {{warp: {list(colour)}, weft: {list(colour)}, gloss: 0, '
                                           'width: 1}'), None, 1e-3) for colour in colours]
        places = np.array([[0.0, y, z] for y in (-1.0, 0.0, 1.0) for z in (-1.0, 1.0)])
        triangles = np.array([[0, 2, 1], [1, 2, 3], [2, 4, 3], [3, 4, 5]])
        cloth = weave.Cloth(Surface(places, triangles), np.array([1, 1, 0, 0]), weaves)
        white = environment.Environment(np.ones((8, 16, 3)), None, None)
        for renderer, name in ((povray, 'povray'), (cycles, 'blender')):
            if shutil.which(name) is None:
                continue
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder, 'two.png')
                renderer.draw(camera.Camera([9.0, 0.0, 0.0], [0.0, 0.0, 0.0], 0.1), (32, 32), white, [cloth], path)
                drawn = imread(path)[..., :3]
            for column, colour in ((8, colours[1]), (24, colours[0])):
                np.testing.assert_allclose(linear_of(drawn[8:24, column]).mean(axis=0), colour, atol=0.03, err_msg=name)

    def drawn_wave(self, renderer):
        """On a square that is turned and stretched. @returns what is drawn, linear, the cosine to the sun times the
        colour, and the triangle's cosine to the sun by the product of those of the wave to the sun and the triangle"""
        relief, slopes = self.wave(1, 2)
        fabric = looks.Fabric('grey', self.GREY)
        rest = np.array([[0.0, 0.0], [0.2, 0.0], [0.0, 0.2], [0.2, 0.2]])
        places = np.column_stack([np.zeros(4), 1.25 * (0.1 - rest[:, 1]), rest[:, 0] - 0.1])  # a quarter turn
        triangles = np.array([[0, 1, 2], [1, 3, 2]])
        cloth = weave.Cloth(Surface(places, triangles, rest[triangles]), np.zeros(2, dtype=int),
                            [weave.Weave(fabric, relief, 1e-5)])
        sun = np.array([0.6, -0.5, 0.4]) / np.linalg.norm([0.6, -0.5, 0.4])
        dark = environment.Environment(np.zeros((8, 16, 3)), sun, np.ones(3))
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, 'wave.png')
            renderer.draw(camera.Camera([1.0, 0.0, 0.0], [0.0, 0.0, 0.0], 0.16), (128, 128), dark, [cloth], path)
            drawn = imread(path)[..., 0]
        across = (2.0 * (np.arange(128) + 0.5) / 128 - 1.0) * np.tan(0.08)
        y, z = np.meshgrid(across, -across)
        along_weft, along_warp = slopes(z + 0.1, 0.1 - y / 1.25)
        normal = np.stack([np.ones_like(y), along_warp / 1.25, -along_weft])
        normal /= np.linalg.norm(normal, axis=0)
        cosine = np.clip(np.einsum('xrc,x->rc', normal, sun), 0.0, None)
        self.assertGreater(0.6 * cosine.std(), 0.03)
        return linear_of(drawn), 0.6 * cosine, sun[0] / (cosine * normal[0])


@unittest.skipUnless(find_node('haptex', 'fabric_relief'), 'fabric_relief is not built')
class Fabrics(Folder):
    def test_of_the_package_show_their_repeat(self):
        relief = weave.relief_of(looks.fabric_called('denim'))
        # 3/1 twill of 0.4 and 0.55 mm: whole repeats, three quarters of warp and more, lines up to the right.
        np.testing.assert_allclose(relief.size / [1.6e-3, 2.2e-3], np.round(relief.size / [1.6e-3, 2.2e-3]), rtol=1e-12)
        self.assertTrue(0.75 < relief.warp.mean() < 0.85)
        yarn = np.round(np.array(relief.warp.shape) * [5.5e-4, 4e-4] / relief.size[::-1]).astype(int)
        up, down = (np.roll(relief.warp, (-way * yarn[0], yarn[1]), (0, 1)) for way in (1, -1))
        self.assertLess(np.abs(up - relief.warp).mean(), 0.25 * np.abs(down - relief.warp).mean())

    def test_without_a_surface_have_no_yarns(self):
        self.assertIsNone(weave.relief_of(looks.fabric_called('linear')))

    def test_that_are_not_sound_are_refused_by_name(self):
        with self.assertRaisesRegex(Refused, 'fabric odd: .*areal_density'):
            weave.relief_of(looks.Fabric('odd', 'surface: {}'))


class Sheets(Folder):
    def test_stand_on_a_closed_ball(self):
        ball = sheet.ball()
        edges = np.concatenate([ball.triangles[:, [0, 1]], ball.triangles[:, [1, 2]], ball.triangles[:, [2, 0]]])
        self.assertEqual({tuple(edge) for edge in edges}, {tuple(edge[::-1]) for edge in edges})
        self.assertEqual(len({tuple(edge) for edge in edges}), len(edges))
        corners = ball.positions[ball.triangles]
        volume = np.einsum('tx,tx->', corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0
        self.assertAlmostEqual(volume / (4.0 / 3.0 * np.pi * sheet.RADIUS ** 3), 1.0, 2)
        self.assertAlmostEqual(ball.positions[:, 2].min(), 0.0, 12)
        path = self.folder / 'ball.obj'
        sheet.write_obj(ball, path)
        np.testing.assert_allclose(read_obj(path).positions, ball.positions, atol=1e-9)

    @unittest.skipUnless(find_node('haptex', 'drape_garment'), 'drape_garment is not built')
    def test_show_cloth_that_lies_on_the_ball(self):
        with mock.patch.object(sheet, 'EDGE', 0.02):
            sheet.write_obj(sheet.ball(), self.folder / 'ball.obj')
            surface = sheet.draped('silk_habutae', self.folder)
        distances = np.linalg.norm(surface.positions - [0.0, 0.0, sheet.RADIUS], axis=1)
        self.assertGreater(distances.min(), sheet.RADIUS)
        self.assertLess(distances.min(), sheet.RADIUS + 1e-3)  # less than a layer above it
        self.assertTrue(0.0 < surface.positions[:, 2].min() < 0.06)
        np.testing.assert_allclose(np.ptp(surface.rest.reshape(-1, 2), axis=0), sheet.SIDE)

    def test_that_do_not_come_to_rest_are_refused_by_name(self):
        with self.assertRaisesRegex(Refused, 'velvet does not come to rest'):
            sheet.draped('velvet', self.folder)

    def test_hold_each_fabric_with_its_name_below(self):
        grey, path = np.full((*sheet.PANEL[::-1], 3), 0.5), self.folder / 'sheet.png'
        close = np.zeros((*sheet.CLOSE[::-1], 3))
        sheet.arrange(['one', 'two'], [(grey, close), (grey, close)], path)
        drawn = imread(path)[..., :3]
        width, height = sheet.PANEL
        self.assertEqual(drawn.shape, (height + sheet.LABEL, 2 * width, 3))
        np.testing.assert_allclose(drawn[:height // 2], 0.5, atol=1 / 255)
        np.testing.assert_array_equal(drawn[height - 10:height, width:width + 100], 0.0)
        for left in (0, width):
            label = drawn[height:, left:left + width].min(axis=(0, 2))
            self.assertTrue(label[200:280].min() < 0.5 < label[:150].min())


Tests = suite_of(Weaves, Fabrics, Sheets)


if __name__ == '__main__':
    rostest.rosrun('haptex', 'fabric_pictures', f'{__name__}.Tests')
