"""Draws cloth by the bidirectional texture functions of its fabrics, which fabric_btf writes. POV-Ray finds what light comes
to it, with shadows and what is reflected from elsewhere, and draws all else; what cloth makes of that light the
program btf_radiance says, for what is seen at SIDE x SIDE places of every pixel."""
import os
import pathlib
import subprocess
import tempfile

import numpy as np
import roslib.packages
from matplotlib.image import imsave

from bag_report.bags import Refused

from . import povray, programs, raster
from .weave import Cloth

SIDE = 2  # places along a side of a pixel
AROUND = 4  # directions at each place, which what comes from all around is taken from
FLATTEST = 0.02  # of views, over the cloth: flatter ones are those of facets that a smooth surface has not
SPREAD = 3  # pixels, how far light is taken from beside an edge


def frames_of(cloth, seen, places, eye):
    """Of places that are seen: axes along weft, along warp and out of the face towards the eye (place, 3, 3), and
    the direction to the eye in these (place, 3). Both sides of cloth have the same yarns.
    @param places in space"""
    surface = cloth.surface
    corners = surface.triangles[seen.triangle]
    to_eye = eye - places
    to_eye /= np.linalg.norm(to_eye, axis=1, keepdims=True)
    normals = seen.mean(surface.normals()[corners])
    normals *= np.where(np.einsum('px,px->p', normals, to_eye) < 0.0, -1.0, 1.0)[:, None]
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    axes = cloth.axes(np.arange(len(surface.triangles)))[seen.triangle]
    weft = axes[:, 0] - np.einsum('px,px->p', axes[:, 0], normals)[:, None] * normals
    weft /= np.maximum(np.linalg.norm(weft, axis=1, keepdims=True), 1e-30)
    warp = np.cross(normals, weft)
    warp *= np.where(np.einsum('px,px->p', axes[:, 1], warp) < 0.0, -1.0, 1.0)[:, None]
    frames = np.stack([weft, warp, normals], axis=1)
    views = np.einsum('pax,px->pa', frames, to_eye)
    views[:, 2] = np.maximum(views[:, 2], FLATTEST)
    return frames, views


class Function:
    """What a file of fabric_btf says."""

    def __init__(self, path):
        if not os.path.isfile(path):
            raise Refused(f'{path}: there is no such file')
        self.path = path
        found = roslib.packages.find_node('haptex', 'btf_radiance')
        if not found:
            raise Refused('the program btf_radiance is not built, or not found by rosrun')
        self.program = found[0]

    def radiance(self, *requests):
        """1/sr, red, green and blue, for an irradiance of 1 perpendicular to each light. One start of the program,
        which reads the whole file. @param requests (place, 9): see requests_of() @returns an array for each"""
        with tempfile.TemporaryDirectory(prefix='haptex_btf_') as name:
            asked, values = pathlib.Path(name, 'requests'), pathlib.Path(name, 'values')
            np.vstack(requests).astype(np.float32).tofile(asked)
            run = subprocess.run([self.program, self.path, asked, values], capture_output=True, text=True)
            if run.returncode != 0:
                raise Refused(run.stderr.strip())
            radiance = np.fromfile(values, np.float32).reshape(-1, 3).astype(float)
            return np.split(radiance, np.cumsum([len(part) for part in requests])[:-1])


def requests_of(views, lights, places, widths):
    return np.hstack([views, lights, places, widths[:, None]])


def lights_around(count):
    """AROUND arrays (count, 3) of directions by the cosine, each in its part of the circle below."""
    random = np.random.default_rng(1)
    lights = []
    for part in range(AROUND):
        turn = 2.0 * np.pi * (part + random.random(count)) / AROUND
        across = np.sqrt(random.random(count))
        up = np.sqrt(np.maximum(1.0 - across ** 2, 1e-6))
        lights.append(np.column_stack([across * np.cos(turn), across * np.sin(turn), up]))
    return lights


def by_both(function, views, places, widths, to_sun):
    """@param to_sun (place, 3), 0 without a sun
    @returns radiance by the sun where nothing hides it, for an irradiance of pi perpendicular to it, and radiance
      where the same comes from everywhere, by its part of what a white surface would show"""
    lit = to_sun[:, 2] > 0.0
    around = lights_around(len(views))
    of_lit, *of_around = function.radiance(requests_of(views[lit], to_sun[lit], places[lit], widths[lit]),
                                           *(requests_of(views, lights, places, widths) for lights in around))
    by_sun = np.zeros((len(views), 3))
    by_sun[lit] = np.pi * of_lit
    return by_sun, sum(np.pi * values / lights[:, 2:] for values, lights in zip(of_around, around)) / AROUND


def spread(field, known):
    """Where it is not known, the mean of what is beside it, as far as SPREAD pixels."""
    for _ in range(SPREAD):
        padded = np.pad(np.where(known[..., None], field, 0.0), ((1, 1), (1, 1), (0, 0)))
        counts = np.pad(known.astype(float), 1)
        windows = [(slice(row, row + known.shape[0]), slice(column, column + known.shape[1]))
                   for row in range(3) for column in range(3)]
        count = sum(counts[window] for window in windows)
        mean = sum(padded[window] for window in windows) / np.maximum(count, 1.0)[..., None]
        field, known = np.where(known[..., None], field, mean), known | (count > 0.0)
    return field


def srgb(linear):
    """Bytes, of linear red, green and blue."""
    values = np.clip(linear, 0.0, 1.0)
    return np.round(255.0 * np.where(values <= 0.0031308, 12.92 * values,
                                     1.055 * np.maximum(values, 1e-9) ** (1.0 / 2.4) - 0.055)).astype(np.uint8)


class Renderer:
    """As the modules povray and cycles."""

    def __init__(self, path):
        """@param path of a file of fabric_btf, or of a folder that has FABRIC.btf of every fabric"""
        if path is None:
            raise Refused('--renderer btf: a file of fabric_btf is needed, or a folder of them: --btf FABRIC.btf')
        self.path = path

    @staticmethod
    def require():
        povray.require()

    @staticmethod
    def at_once():
        return 1

    def functions(self, cloth):
        """Of its weaves."""
        if os.path.isdir(self.path):
            return [Function(pathlib.Path(self.path, f'{weave.fabric}.btf')) for weave in cloth.weaves]
        if len(cloth.weaves) != 1:
            raise Refused(f'--btf {self.path}: cloth of several fabrics needs a folder that has FABRIC.btf of each')
        return [Function(self.path)]

    def draw(self, camera, size, environment, things, output):
        cloth = next(thing for thing in things if isinstance(thing, Cloth))
        if cloth.surface.rest is None:
            raise Refused('--renderer btf: allowed is cloth with rest coordinates')
        functions = self.functions(cloth)
        with_light, sunlit, share = povray.draw_light(camera, size, environment, things)
        seen = raster.seen(cloth.surface, camera, size, SIDE)
        in_space = seen.mean(cloth.surface.positions[cloth.surface.triangles[seen.triangle]])
        frames, views = frames_of(cloth, seen, in_space, camera.eye)
        places = seen.mean(cloth.surface.rest[seen.triangle])
        # As wide as a pixel, so that places of neighbours overlap, and yarns as fine as pixels make no patterns.
        widths = camera.pixel(in_space, size[0]) / np.sqrt(views[:, 2])
        to_sun, strength = np.zeros((len(views), 3)), np.zeros(3)
        if environment.sun is not None:
            to_sun, strength = frames @ environment.sun, environment.sunlight
        by_sun, by_all_around = np.zeros((2, len(views), 3))
        weaves = cloth.weave_of[seen.triangle]
        for number, function in enumerate(functions):
            mine = weaves == number
            by_sun[mine], by_all_around[mine] = by_both(function, views[mine], places[mine], widths[mine], to_sun[mine])
        matt = seen.by_pixel(np.array([weave.even.warp for weave in cloth.weaves])[weaves])
        # What hides the sun is known by pixel.
        cosine = seen.by_pixel(np.maximum(to_sun[:, 2:], 0.0))[..., 0] * share
        visible = np.clip(sunlit / np.maximum(cosine, 1e-6), 0.0, 1.0)
        sun = visible[..., None] * strength * seen.by_pixel(by_sun)
        bare = (sunlit / np.maximum(share, 1e-6))[..., None] * strength  # of what is white, by the sun
        around = np.maximum(with_light / np.maximum(matt, 1e-3) - bare, 0.0)  # what a white surface would show by all else
        around = spread(around, share > 0.99)
        drawn = sun + around * seen.by_pixel(by_all_around)
        others = with_light - share[..., None] * matt * (bare + around)
        picture = np.where(share[..., None] > 0.0,
                           np.maximum(others, 0.0) * (share < 0.99)[..., None] + share[..., None] * drawn, with_light)
        with tempfile.TemporaryDirectory(prefix='haptex_render_') as name:
            path = pathlib.Path(name, programs.PICTURE)
            imsave(path, srgb(picture))
            programs.keep(path, output)

