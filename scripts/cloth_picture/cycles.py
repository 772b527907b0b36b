"""Has what is seen drawn by Cycles, the path tracer of Blender. Blender is a program that runs cycles_scene.py; what
that builds is handed to it as scene.json, and arrays.npz, to whose arrays the former refers by name."""
import json
import os
import pathlib
import tempfile

import numpy as np

from . import programs
from .environment import SUN_WIDTH, panorama
from .weave import Cloth

SAMPLES = 64  # of every pixel
SCRIPT = pathlib.Path(__file__).with_name('cycles_scene.py')


class Arrays:
    """By the names that they get."""

    def __init__(self):
        self.known = {}

    def name(self, values):
        name = f'array_{len(self.known)}'
        self.known[name] = np.asarray(values)
        return name


def material(look):
    return {'colour': look.warp.tolist(), 'gloss': look.gloss, 'width': look.width}


def slopes_of(relief):
    """(row, column, 3): along weft and warp, per m of either, and 0."""
    steps = 2.0 * relief.size / relief.heights.shape[::-1]
    differences = [np.roll(relief.heights, way, axis) - np.roll(relief.heights, -way, axis)
                   for way, axis in ((-1, 1), (1, 0))]
    return np.stack([differences[0] / steps[0], differences[1] / steps[1], np.zeros_like(relief.heights)], axis=-1)


def yarns(weave, arrays):
    return {'colours': arrays.name(weave.colours()), 'slopes': arrays.name(slopes_of(weave.relief)),
            'gloss': weave.look.gloss, 'width': weave.look.width}


def mesh(surface, arrays):
    return {'kind': 'mesh', 'positions': arrays.name(surface.positions), 'normals': arrays.name(surface.normals()),
            'triangles': arrays.name(surface.triangles)}


def cloth_object(cloth, arrays):
    """With texture coordinates of pieces of fabric (of every corner, how many along weft and warp), and how fast rest
    coordinates grow in space (of every triangle, two vectors in its plane)."""
    count = len(cloth.surface.triangles)
    materials, pieces, growth = [], np.zeros((count, 3, 2)), np.zeros((count, 2, 3))
    for number, weave in enumerate(cloth.weaves):
        if cloth.has_yarns(number):
            mine, size = cloth.weave_of == number, weave.relief.size
            # Whole pieces from zero: of numbers of 32 bits, little is left for where in its piece a yarn is.
            rest = cloth.surface.rest[mine] / size
            pieces[mine] = rest - np.floor(rest.min(axis=1, keepdims=True))
            growth[mine] = np.linalg.pinv(cloth.axes(mine)).swapaxes(1, 2)
        materials.append(yarns(weave, arrays) if cloth.has_yarns(number) else material(weave.even))
    return {**mesh(cloth.surface, arrays), 'materials': materials, 'material_of': arrays.name(cloth.weave_of),
            'pieces': arrays.name(pieces), 'weft': arrays.name(growth[:, 0]), 'warp': arrays.name(growth[:, 1])}


def solid_object(solid, arrays):
    if solid.surface is not None:
        return {**mesh(solid.surface, arrays), 'materials': [material(solid.look)]}
    return {'kind': solid.kind, 'sizes': solid.sizes, 'pose': solid.pose.tolist(), 'materials': [material(solid.look)]}


def camera_pose(camera):
    """4 x 4: Blender's cameras look along -z, and up is y."""
    right, up, forward = camera.axes()
    pose = np.eye(4)
    pose[:3] = np.column_stack([right, up, -forward, camera.eye])
    return pose


def sun(environment):
    if environment.sun is None:
        return None
    # A white surface that faces it shows the share 1 / pi of its light from every side.
    return {'direction': environment.sun.tolist(), 'irradiance': (np.pi * environment.sunlight).tolist(),
            'width': SUN_WIDTH}


def require():
    programs.require('blender')


def at_once():
    """Pictures of a film that are drawn at a time: each is drawn by a thread per processor."""
    return 1


def draw(camera, size, environment, things, output):
    """As povray.draw(). @throws Refused with what Blender says"""
    require()
    arrays = Arrays()
    scene = {'size': size, 'samples': SAMPLES, 'threads': len(os.sched_getaffinity(0)), 'picture': programs.PICTURE,
             'camera': {'pose': camera_pose(camera).tolist(), 'angle': float(camera.angle)},
             'sky': arrays.name(panorama(environment.radiance)), 'sun': sun(environment),
             'objects': [cloth_object(thing, arrays) if isinstance(thing, Cloth) else solid_object(thing, arrays)
                         for thing in things]}
    with tempfile.TemporaryDirectory(prefix='haptex_render_') as folder:
        np.savez(pathlib.Path(folder, 'arrays.npz'), **arrays.known)
        pathlib.Path(folder, 'scene.json').write_text(json.dumps(scene))
        programs.draw(['blender', '--background', '--factory-startup', '-noaudio', '--python-exit-code', '1',
                       '--python', str(SCRIPT)], folder, output)
