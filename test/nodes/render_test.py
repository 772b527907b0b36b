#!/usr/bin/python3
"""Pictures of cloth: what is read of OBJ files, bags and panoramas, where the camera stands, and that the same
input is the same picture. Pixels are looked at where POV-Ray or Blender is installed."""
import importlib.machinery
import importlib.util
import io
import os
import pathlib
import shutil
import sys
import unittest
from contextlib import redirect_stderr, redirect_stdout
from unittest import mock

import numpy as np
import rosbag
import rostest
import yaml
from geometry_msgs.msg import Pose, TransformStamped
from matplotlib.image import imread
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

from report_test import LENGTH, SIDE, Session, at
from unit_fixtures import Folder, suite_of

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'scripts'))
from bag_report.bags import Refused, open_bag  # noqa: E402
from cloth_picture import btf, camera, cycles, environment, looks, picture, povray, recorded, solids, weave  # noqa: E402
from cloth_picture.obj_file import read_obj  # noqa: E402

CLOTH = 'v 0 0 0\nv 0 0.2 0\nv 0 0 0.2\nvt 0 0\nvt 0.2 0\nvt 0 0.2\nf 1/1 2/2 3/3\n'
SCENE = '''fabric: plain
obstacles:
  - {name: ball, sphere: 0.05, position: [0.1, 0, 0], orbit: {centre: [0, 0, 0], axis: [0, 0, 2], period: 4}}
  - {name: box, box: [0.1, 0.2, 0.3], position: [0, 0, -0.5], rpy: [0, 0, 1.5707963267948966], velocity: [0, 0, 0.1]}
  - {name: heavy, sphere: 0.02, position: [9, 9, 9], body: {mass: 1, friction: 0}}
'''


def program():
    loader = importlib.machinery.SourceFileLoader('render', str(ROOT / 'scripts/render'))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


class Seen(Session):
    """With a scene, and a hand by tf."""

    def messages(self):
        yield from super().messages()
        about = {'scene': '/nowhere/scenes/sheet.yaml', 'scene_file': SCENE}
        yield '/recording/about', String(yaml.safe_dump(about)), 0.5
        for child, parent, place, time in (('hand_base', 'world', (0.0, 0.0, 1.0), 1.0),
                                           ('index_distal', 'hand_base', (0.1, 0.0, 0.0), 1.0),
                                           ('lost', 'nowhere', (0.0, 0.0, 0.0), 1.0)):
            transform = TransformStamped(child_frame_id=child)
            transform.header.frame_id = parent
            transform.transform.rotation.z = transform.transform.rotation.w = np.sqrt(0.5)  # a quarter turn
            transform.transform.translation.x, _, transform.transform.translation.z = place
            yield '/tf', TFMessage([transform]), time


class Runs(Folder):
    """Of the program, with a bag and a cloth."""

    def setUp(self):
        super().setUp()
        self.obj, self.picture = self.folder / 'cloth.obj', self.folder / 'picture.png'
        self.obj.write_text(CLOTH)

    def run_render(self, *arguments, expected=0):
        """@returns what it says"""
        out, err = io.StringIO(), io.StringIO()
        with mock.patch.object(sys, 'argv', ['render', *map(str, arguments)]), redirect_stdout(out), \
                redirect_stderr(err):
            try:
                program().main()
                status = 0
            except SystemExit as end:
                status = end.code
        self.assertEqual(status, expected, err.getvalue())
        return out.getvalue() if expected == 0 else err.getvalue()

    def bag(self):
        path = self.folder / 'session.bag'
        Seen().write(path)
        return path

    def assert_refused(self, words, *arguments):
        said = self.run_render(*arguments, expected=2)
        self.assertEqual(len(said.splitlines()), 1, said)
        for word in words:
            self.assertIn(word, said)
        self.assertFalse(self.picture.exists())


class ObjFiles(Folder):
    def surface(self, text):
        path = self.folder / 'some.obj'
        path.write_text(text)
        return read_obj(path)

    def test_give_places_and_rest_coordinates(self):
        surface = self.surface('g front\n' + CLOTH)
        np.testing.assert_array_equal(surface.triangles, [[0, 1, 2]])
        np.testing.assert_array_equal(surface.rest, [[[0, 0], [0.2, 0], [0, 0.2]]])
        self.assertEqual(surface.positions[1].tolist(), [0.0, 0.2, 0.0])

    def test_may_count_from_their_end_and_have_no_rest_coordinates(self):
        surface = self.surface('v 0 0 0\nv 0 1 0\nv 0 0 1\nf -3 2//1 -1\n')
        np.testing.assert_array_equal(surface.triangles, [[0, 1, 2]])
        self.assertIsNone(surface.rest)
        self.assertIsNone(self.surface(CLOTH.replace('vt 0.2 0', 'vt 0 0')).rest)

    def test_are_refused_with_the_line(self):
        for text, words in (('v 0 0\n', 'line 1: v has 2 numbers'), ('v 0 0 nan\n', 'line 1: v has a number that'),
                            ('v 0 0 x\n', 'line 1'), ('v 0 0 0\nf 1 1 2\n', 'line 2: 2 names a v that is not there'),
                            ('v 0 0 0\nf 1/1 1 1\n', 'line 2: 1/1 names a vt'), ('v 0 0 0\nf 1 1 1 1\n', '4 corners'),
                            ('v 0 0 0\nf 0 1 1\n', 'names a v'), ('hello\n', 'no triangle')):
            with self.assertRaisesRegex(Refused, words, msg=text):
                self.surface(text)


class Environments(Folder):
    def test_light_a_white_surface_that_faces_the_sun_as_they_are_exposed(self):
        sky = environment.computed_sky()
        light = environment.light_on(sky.radiance, sky.sun) + sky.sunlight
        self.assertAlmostEqual(light.mean(), environment.EXPOSED, 12)
        self.assertAlmostEqual(sky.sunlight.mean() / environment.EXPOSED, environment.SUN_SHARE, 12)

    def test_of_one_radiance_show_it_from_every_side(self):
        for normal in np.eye(3):
            light = environment.light_on(np.ones((64, 128, 3)), normal)
            np.testing.assert_allclose(light, 1.0, rtol=1e-3)

    def write(self, radiance):
        path = self.folder / 'some.hdr'
        environment.write_hdr(radiance, path)
        return path

    def test_come_back_from_their_file_to_a_part_in_256(self):
        radiance = np.random.default_rng(1).uniform(0.1, 50.0, (16, 32, 3))
        largest = radiance.max(axis=2, keepdims=True)
        read = environment.read_hdr(self.write(radiance))
        self.assertLess((np.abs(read - radiance) / largest).max(), 1 / 256)

    def test_are_read_as_radiance_packs_them(self):
        path = self.folder / 'packed.hdr'
        row = bytes((2, 2, 0, 16)) + bytes((128 + 16, 128)) + bytes((8, *range(8), 128 + 8, 64)) \
            + bytes((128 + 16, 0)) + bytes((128 + 16, 129))
        path.write_bytes(b'#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n' + 8 * row)
        read = environment.read_hdr(path)
        np.testing.assert_allclose(read[:, 3], np.full((8, 3), [128.5, 3.5, 0.5]) / 128.0)
        np.testing.assert_allclose(read[:, 12, 1], 64.5 / 128.0)
        path.write_bytes(path.read_bytes()[:-5])
        with self.assertRaisesRegex(Refused, 'packed.hdr: .*cut off'):
            environment.read_hdr(path)

    def test_make_a_sun_of_what_is_far_brighter_and_lose_no_light(self):
        radiance = np.ones((64, 128, 3))
        radiance[16, 96] = 20000.0  # 3/4 of the way to the right: to the right of the middle, which is +x
        lit = environment.environment_of(self.write(radiance))
        self.assertGreater(lit.sun @ [0.0, -np.sin(np.pi / 4), np.cos(np.pi / 4)], 0.98)
        without = environment.environment_of(self.write(np.ones((64, 128, 3))))
        self.assertIsNone(without.sun)
        np.testing.assert_allclose(without.radiance, environment.EXPOSED, rtol=1e-2)

    def test_are_refused_by_name(self):
        path = self.folder / 'some.hdr'
        for content, words in ((b'hello', 'some.hdr: allowed are .hdr'), (b'#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 '
                               b'+X 8\n', '8 x 8 pixels'), (b'#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\nxx',
                                                           'damaged or cut off')):
            path.write_bytes(content)
            with self.assertRaisesRegex(Refused, words):
                environment.environment_of(path)
        with self.assertRaisesRegex(Refused, 'black'):
            environment.environment_of(self.write(np.zeros((8, 16, 3))))
        with self.assertRaisesRegex(Refused, 'none.hdr: cannot be read'):
            environment.environment_of(self.folder / 'none.hdr')


class Cameras(unittest.TestCase):
    def test_see_all_and_come_as_near_as_that_allows(self):
        for extent in ((0.01, 0.2, 0.2), (0.3, 0.3, 0.01), (0.2, 1.0, 1.7)):
            places = np.random.default_rng(2).uniform(-1, 1, (500, 3)) * extent + [3.0, -2.0, 1.0]
            taken = camera.framing(places, (1280, 720))
            right, up, forward = ((places - taken.eye) @ taken.axes().T).T
            across = np.tan(0.5 * taken.angle)
            filled = np.abs(right / forward).max() / across, np.abs(up / forward).max() / across * 1280 / 720
            self.assertAlmostEqual(max(filled), 1 / camera.MARGIN, 9)


class Solids(Folder):
    def obstacles(self, time):
        body = Pose()
        body.position.x, body.orientation.w = 0.7, 1.0
        return solids.obstacles_of(yaml.safe_dump({'scene_file': SCENE})).at(time, [body])

    def test_go_as_the_scene_says(self):
        ball, box, heavy = self.obstacles(1.0)  # a quarter of the orbit
        np.testing.assert_allclose(ball.pose[:3, 3], [0.0, 0.1, 0.0], atol=1e-12)
        np.testing.assert_allclose(heavy.pose[:3, 3], [0.7, 0.0, 0.0])
        low, high = box.corners().min(axis=0), box.corners().max(axis=0)
        np.testing.assert_allclose([low, high], [[-0.1, -0.05, -0.55], [0.1, 0.05, -0.25]], atol=1e-12)

    def test_are_refused_by_name(self):
        for item, words in (("{name: odd, position: [0, 0, 0]}", "odd.*is no obstacle"),
                            ("{name: odd, sphere: 1}", "position"), ("{name: odd, mesh: none, position: [0, 0, 0]}",
                                                                     "none.obj: cannot be read")):
            about = yaml.safe_dump({'scene_file': f'obstacles: [{item}]'})
            with self.assertRaisesRegex(Refused, words):
                solids.obstacles_of(about).at(0.0, [])

    def test_of_a_shipped_scene_are_found_where_the_bag_is_read(self):
        text = (ROOT / 'config/scenes/tshirt.yaml').read_text()
        figure, = solids.Obstacles(text, '/nowhere/scenes/tshirt.yaml').at(0.0, [])
        self.assertGreater(np.ptp(figure.corners()[:, 2]), 1.6)

    def test_of_a_bag_that_does_not_say_are_none(self):
        self.assertIsNone(solids.obstacles_of('scene: sheet.yaml\n'))


class Looks(Folder):
    def test_are_those_of_the_file(self):
        fabric = looks.Fabric('some', 'look: {warp: [0.1, 0.2, 0.3], weft: [0.3, 0.2, 0.1], gloss: 0.25, width: 0.5}')
        np.testing.assert_array_equal([fabric.look.warp, fabric.look.weft], [[0.1, 0.2, 0.3], [0.3, 0.2, 0.1]])
        self.assertEqual((fabric.look.gloss, fabric.look.width), (0.25, 0.5))
        np.testing.assert_array_equal(looks.Fabric('bare', 'name: bare').look.warp, looks.UNDYED)

    def test_of_all_shipped_fabrics_can_be_read(self):
        for name in looks.package_fabrics():
            looks.fabric_called(name)

    def test_are_refused_by_name(self):
        with self.assertRaisesRegex(Refused, 'no fabric velvet; allowed are .*denim'):
            looks.fabric_called('velvet')
        with self.assertRaisesRegex(Refused, 'none.yaml: cannot be read'):
            looks.fabric_called('./none.yaml')
        for text, words in (('look: {warp: [2, 0, 0], weft: [0, 0, 0], gloss: 0, width: 1}', 'look.warp'),
                            ('look: {warp: [0, 0, 0], weft: [0, 0, 0], gloss: .nan, width: 1}', 'gloss'),
                            ('look: {gloss: 0, width: 1}', 'warp'), ('[', 'cannot be read')):
            with self.assertRaisesRegex(Refused, words):
                looks.Fabric('some', text)


class Bags(Runs):
    def test_tell_where_everything_was(self):
        with open_bag(self.bag()) as opened:
            recording = recorded.Recording(opened)
            moment = recording.at(3.0)
            np.testing.assert_allclose(moment.surface.positions[3], [SIDE, 0.0, SIDE * 1.02])
            np.testing.assert_allclose(recording.at(1.0).surface.positions[3], [SIDE, 0.0, SIDE])
            np.testing.assert_allclose(moment.surface.rest[0], [[0, 0], [SIDE, 0], [0, SIDE]])
            self.assertEqual([fabric.name for fabric in moment.fabrics], ['plain'])
            self.assertEqual([solid.kind for solid in moment.solids[0]], ['sphere', 'box', 'sphere'])
            frames = recording.frames_at(1.5)
            np.testing.assert_allclose(frames['index_distal'][:3, 3], [0.0, 0.1, 1.0], atol=1e-12)
            self.assertNotIn('lost', frames)
            self.assertGreater(len(recording.at(1.5).solids[1]), 0)
            self.assertEqual(len(recording.at(0.5).solids[1]), 0)

    def test_without_cloth_are_refused(self):
        path = self.folder / 'none.bag'
        with rosbag.Bag(path, 'w') as bag:
            bag.write('/haptex/cloth/mesh', Session.mesh(), at(0.0))
        self.assert_refused(['none.bag', 'no cloth/state'], path, self.picture)


class Programs(Runs):
    def test_refuse_by_name_what_they_cannot_draw(self):
        bag = self.bag()
        (self.folder / 'text.obj').write_text('hello\n')
        (self.folder / 'text.bag').write_text('hello\n')
        for words, arguments in (
                (['none.obj: there is no such file'], ['none.obj', self.picture]),
                (['text.obj', 'no triangle'], [self.folder / 'text.obj', self.picture]),
                (['text.bag', 'no bag'], [self.folder / 'text.bag', self.picture]),
                (['picture.jpg', '.png'], [self.obj, self.folder / 'picture.jpg']),
                (['the folder', 'nowhere'], [self.obj, self.folder / 'nowhere' / 'picture.png']),
                (['no fabric velvet'], [self.obj, self.picture, '--fabric', 'velvet']),
                (['none.hdr'], [self.obj, self.picture, '--environment', 'none.hdr']),
                (['none.obj'], [self.obj, self.picture, '--body', 'none.obj']),
                (['--eye and --at'], [self.obj, self.picture, '--eye', 1, 0, 0]),
                (['not one above'], [self.obj, self.picture, '--eye', 0, 0, 1, '--at', 0, 0, 0]),
                (['--time', 'bags'], [self.obj, self.picture, '--time', '1']),
                (['--size 10', '16 to'], [self.obj, self.picture, '--size', '10x10']),
                (['at 60 s', '0.000 to 3.987'], [bag, self.picture, '--time', '60']),
                (['--time', 'finite'], [bag, self.picture, '--time', 'nan']),
                (['--time', 'two'], [bag, self.picture, '--time', '1', '2']),
                (['--time', 'two times'], [bag, self.picture, '--film', '5', '--time', '2', '1']),
                (['--film 0'], [bag, self.picture, '--film', '0'])):
            with self.subTest(arguments=arguments), mock.patch.object(povray, 'require'):
                self.assert_refused(words, *arguments)

    def test_say_how_to_install_what_is_missing(self):
        with mock.patch.dict(os.environ, PATH=str(self.folder)):
            self.assert_refused(['apt-get install povray'], self.obj, self.picture)
            self.assert_refused(['apt-get install blender'], self.obj, self.picture, '--renderer', 'cycles')

    def test_say_what_a_program_says_that_cannot_draw(self):
        path = self.folder / 'blender'
        path.write_text('#!/bin/sh\necho "some\nError: no kernel\nmore" >&2\nexit 1\n')
        path.chmod(0o755)
        with mock.patch.dict(os.environ, PATH=f'{self.folder}:{os.environ["PATH"]}'):
            self.assert_refused(['blender could not draw it: Error: no kernel'], self.obj, self.picture, '--renderer',
                                'cycles')


class Drawn:
    """What pictures show, whatever draws them."""

    SIZE = 160, 90

    def draw(self, *arguments):
        self.run_render(*arguments, '--renderer', self.RENDERER, '--size', 'x'.join(map(str, self.SIZE)))

    def test_of_the_same_bag_are_the_same_to_the_last_byte(self):
        bag, other = self.bag(), self.folder / 'other.png'
        self.draw(bag, self.picture, '--time', 3.0)
        with mock.patch.object(os, 'sched_getaffinity', return_value={0}):  # by one thread
            self.draw(bag, other, '--time', 3.0)
        self.assertEqual(self.picture.read_bytes(), other.read_bytes())
        self.draw(bag, other, '--time', 1.0)
        self.assertNotEqual(self.picture.read_bytes(), other.read_bytes())

    def test_show_the_fabric_in_its_colour_before_the_floor(self):
        fabric = self.folder / 'green.yaml'
        fabric.write_text('look: {warp: [0.05, 0.6, 0.05], weft: [0.05, 0.6, 0.05], gloss: 0, width: 1}')
        self.draw(self.obj, self.picture, '--fabric', fabric)
        drawn = imread(self.picture)[..., :3]
        self.assertEqual(drawn.shape[:2], self.SIZE[::-1])
        green = drawn[..., 1] > drawn[..., 0] + 0.2
        self.assertTrue(0.15 < green.mean() < 0.5, green.mean())
        self.assertFalse(green[:, 0].any() or green[:, -1].any())

    def test_have_every_part_of_the_sky_where_its_map_says(self):
        colours = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], dtype=float)
        radiance = np.repeat(np.repeat(colours[None], 32, axis=0), 16, axis=1)  # quarters by azimuth from +x
        radiance[:8] = [1.0, 1.0, 0.0]
        sky = environment.Environment(radiance, None, None)
        for target, colour in (*zip(((1, 1, 0.3), (-1, 1, 0.3), (-1, -1, 0.3), (1, -1, 0.3)), colours),
                               ((0.1, 0.1, 1), (1, 1, 0)), ((0.2, 1, 0.3), (1, 0, 0)), ((-0.2, 1, 0.3), (0, 1, 0))):
            self.MODULE.draw(camera.Camera((0, 0, 0), target, 0.1), (32, 18), sky, [solids.floor(-10.0)], self.picture)
            np.testing.assert_allclose(imread(self.picture)[9, 16, :3], colour, atol=0.06, err_msg=str(target))

    def test_show_every_solid_where_it_is(self):
        """Against a ray through every pixel, seen from +x before a black sky."""
        dark = environment.Environment(np.zeros((8, 16, 3)), np.array([1.0, 0.0, 0.0]), np.ones(3))
        turned = solids.pose_of(solids.euler_matrix(0.5 * np.pi, 0.0, 0.0), [0.0, 0.0, 0.02])  # z to -y
        y, z = np.meshgrid((2.0 * (np.arange(160) + 0.5) / 160 - 1.0) * np.tan(0.08) * 100.0,
                           (1.0 - 2.0 * (np.arange(90) + 0.5) / 90) * np.tan(0.08) * 100.0 * 90 / 160)
        z -= 0.02
        edge = 0.2  # m, two pixels
        for kind, sizes, outside in (  # how far, in m
                ('sphere', [2.0], np.hypot(y, z) - 2.0),
                ('box', [1.0, 2.0, 6.0], np.maximum(np.abs(y) - 3.0, np.abs(z) - 1.0)),
                ('cylinder', [1.0, 6.0], np.maximum(np.abs(y) - 3.0, np.abs(z) - 1.0)),
                ('capsule', [1.0, 6.0], np.hypot(np.maximum(np.abs(y) - 3.0, 0.0), z) - 1.0)):
            solid = solids.Solid(kind, sizes, turned, looks.FIGURE)
            self.MODULE.draw(camera.Camera((100, 0, 0), (0, 0, 0), 0.16), self.SIZE, dark, [solid], self.picture)
            drawn = imread(self.picture)[..., 0]
            self.assertGreater(drawn[outside < -edge].min(), 0.1, kind)
            self.assertEqual(drawn[outside > edge].max(), 0.0, kind)

    def test_are_lit_by_a_panorama(self):
        red = np.ones((16, 32, 3)) * [1.0, 0.05, 0.05]
        environment.write_hdr(red, self.folder / 'red.hdr')
        self.draw(self.obj, self.picture, '--environment', self.folder / 'red.hdr')
        drawn = imread(self.picture)[..., :3]
        self.assertGreater((drawn[..., 0] - drawn[..., 1]).mean(), 0.2)

    def test_of_a_film_are_numbered(self):
        said = 'picture.mp4' if shutil.which('ffmpeg') else 'ffmpeg is not installed'
        out = self.run_render(self.bag(), self.picture, '--renderer', self.RENDERER, '--film', 2, '--time', 1, 2,
                              '--size', '64x36')
        self.assertIn(said, out)
        self.assertEqual(sorted(path.name for path in self.folder.glob('*.png')),
                         [f'picture_{number:04}.png' for number in (1, 2, 3)])


@unittest.skipUnless(shutil.which('povray'), 'POV-Ray is not installed')
class PovrayPictures(Drawn, Runs):
    RENDERER, MODULE = 'povray', povray


@unittest.skipUnless(shutil.which('blender'), 'Blender is not installed')
class CyclesPictures(Drawn, Runs):
    RENDERER, MODULE = 'cycles', cycles


COLOUR = 0.3, 0.5, 0.2


def btf_of_even_fabric(colour=COLOUR):
    """A file as docs/appearance.md describes it: flat and matt, so that no light goes between its texels."""
    texels, columns = 16, 81 * 81 * 3
    text = b'HAPTBTF1' + np.array([4, 4, 1, 1, 1], '<u4').tobytes()
    text += np.array([0.01, 0.01, *colour, *colour, 0.0, 1.0], '<f8').tobytes()
    text += np.zeros(texels, '<f4').tobytes() + bytes([1] * texels)  # heights, and all is warp
    text += np.zeros(2 * columns + 3, '<f4').tobytes()  # mean, one component, offset, axis and scale of one cluster
    text += bytes(texels) + np.zeros(texels, '<i2').tobytes()
    total = 0xcbf29ce484222325
    for byte in text:
        total = (total ^ byte) * 0x100000001b3 % 2 ** 64
    return text + total.to_bytes(8, 'little')


@unittest.skipUnless(shutil.which('povray'), 'POV-Ray is not installed')
class BtfPictures(Runs):
    def setUp(self):
        super().setUp()
        self.btf, self.fabric = self.folder / 'even.btf', self.folder / 'even.yaml'
        self.btf.write_bytes(btf_of_even_fabric())
        self.fabric.write_text(f'look: {{warp: {list(COLOUR)}, weft: {list(COLOUR)}, gloss: 0, width: 1}}')

    def test_of_an_even_matt_fabric_are_those_of_povray(self):
        """From in front, from behind, from the side of the sun's shadow, and with a body that hides a part."""
        body = self.folder / 'body.obj'
        body.write_text('v 0.05 0.02 0\nv 0.05 0.06 0\nv 0.05 0.04 0.1\nf 1 2 3\n')
        for view in ([], ['--eye', -0.6, 0.3, 0.3, '--at', 0, 0.07, 0.07], ['--eye', 0.5, 0.6, 0.2, '--at', 0, 0.07, 0.07],
                     ['--body', body]):
            with self.subTest(view=view):
                pictures = []
                for how in ([], ['--renderer', 'btf', '--btf', self.btf]):
                    self.run_render(self.obj, self.picture, '--fabric', self.fabric, '--size', '160x90', *view, *how)
                    pictures.append(255.0 * imread(self.picture)[..., :3])
                off = np.abs(pictures[1] - pictures[0]).max(axis=2)
                is_cloth = pictures[0][..., 1] > pictures[0][..., 0] + 20.0
                self.assertGreater(is_cloth.mean(), 0.05)
                self.assertLess(off[is_cloth].mean(), 2.0)
                self.assertLess(np.percentile(off, 99.0), 6.0)

    def test_of_two_fabrics_have_the_function_of_each(self):
        colours = {'green': COLOUR, 'red': (0.6, 0.1, 0.1)}
        self.obj.write_text(CLOTH + 'v 0 0.2 0.2\nvt 0.2 0.2\nf 2/2 4/4 3/3\n')
        fabrics = []
        for name, colour in colours.items():
            (self.folder / f'{name}.btf').write_bytes(btf_of_even_fabric(colour))
            fabrics.append(looks.Fabric(name, f'look: {{warp: {list(colour)}, weft: {list(colour)}, gloss: 0, width: 1}}'))
        scene = picture.Scene(read_obj(self.obj), np.array([0, 1]), fabrics)
        drawn = []
        for renderer in (povray, btf.Renderer(self.folder)):
            picture.draw(renderer, scene, [None, None], camera.Camera((0.6, 0.1, 0.1), (0.0, 0.1, 0.1)), scene.ground(),
                         (160, 90), environment.computed_sky(), self.picture)
            drawn.append(255.0 * imread(self.picture)[..., :3])
        off = np.abs(drawn[1] - drawn[0]).max(axis=2)
        for mine in (drawn[0][..., 1] > drawn[0][..., 0] + 20.0, drawn[0][..., 0] > drawn[0][..., 1] + 60.0):
            self.assertGreater(mine.mean(), 0.02)
            self.assertLess(off[mine].mean(), 3.0)
        (self.folder / 'red.btf').unlink()
        with self.assertRaisesRegex(Refused, 'red.btf: there is no such file'):
            btf.Renderer(self.folder).functions(weave.Cloth(scene.surface, scene.fabric_of, [
                weave.Weave(fabric, None, 1e-3) for fabric in fabrics]))

    def test_are_the_same_to_the_last_byte(self):
        drawn = []
        for _ in range(2):
            self.run_render(self.obj, self.picture, '--renderer', 'btf', '--btf', self.btf, '--size', '64x36')
            drawn.append(self.picture.read_bytes())
        self.assertEqual(drawn[0], drawn[1])

    def test_need_a_file_and_cloth_that_has_it(self):
        (self.folder / 'bare.obj').write_text('v 0 0 0\nv 0 0.2 0\nv 0 0 0.2\nf 1 2 3\n')
        self.btf.write_bytes(self.btf.read_bytes()[:-1])
        for words, arguments in (
                (['--btf FABRIC.btf'], [self.obj, self.picture, '--renderer', 'btf']),
                (['none.btf: there is no such file'], [self.obj, self.picture, '--renderer', 'btf', '--btf', 'none.btf']),
                (['--btf is of --renderer btf'], [self.obj, self.picture, '--btf', self.btf]),
                (['rest coordinates'], [self.folder / 'bare.obj', self.picture, '--renderer', 'btf', '--btf', self.btf]),
                (['even.btf', 'bytes'], [self.obj, self.picture, '--renderer', 'btf', '--btf', self.btf, '--size', '32x18'])):
            with self.subTest(arguments=arguments):
                self.assert_refused(words, *arguments)


Tests = suite_of(ObjFiles, Environments, Cameras, Solids, Looks, Bags, Programs, PovrayPictures, CyclesPictures,
                 BtfPictures)


if __name__ == '__main__':
    rostest.rosrun('haptex', 'render', f'{__name__}.Tests')
