"""Draws cloth by the bidirectional texture function of its fabric, which fabric_btf writes. POV-Ray finds what light comes
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
from .looks import Look
from .weave import Cloth

SIDE = 2  # places along a side of a pixel
AROUND = 4  # directions at each place, which what comes from all around is taken from
FLATTEST = 0.02  # of views, over the cloth: flatter ones are those of facets that a smooth surface has not
SPREAD = 3  # pixels, how far light is taken from beside an edge


def frames_of(cloth, seen, eye):
    """Of places that are seen: axes along weft, along warp and out of the face towards the eye (place, 3, 3), and
    the direction to the eye in these (place, 3). Both sides of cloth have the same yarns."""
    surface = cloth.surface
    corners = surface.triangles[seen.triangle]
    places = seen.mean(surface.positions[corners])
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
        self.path = path
        found = roslib.packages.find_node('haptex', 'btf_radiance')
        if not found:
            raise Refused('the program btf_radiance is not built, or not found by rosrun')
        self.program = found[0]

    def radiance(self, views, lights, places, widths):
        """1/sr, red, green and blue, for an irradiance of 1 perpendicular to each light."""
        with tempfile.TemporaryDirectory(prefix='haptex_btf_') as name:
            requests, values = pathlib.Path(name, 'requests'), pathlib.Path(name, 'values')
            np.hstack([views, lights, places, widths[:, None]]).astype(np.float32).tofile(requests)
            run = subprocess.run([self.program, self.path, requests, values], capture_output=True, text=True)
            if run.returncode != 0:
                raise Refused(run.stderr.strip())
            return np.fromfile(values, np.float32).reshape(-1, 3).astype(float)


def by_sun(function, frames, views, places, widths, environment):
    """Radiance by the sun where nothing hides it, and the cosine of its light."""
    lights = frames @ environment.sun
    lit = lights[:, 2] > 0.0
    radiance = np.zeros((len(views), 3))
    radiance[lit] = function.radiance(views[lit], lights[lit], places[lit], widths[lit])
    return np.pi * environment.sunlight * radiance, np.maximum(lights[:, 2], 0.0)


def by_all_around(function, views, places, widths):
    """Radiance where the same comes from everywhere, by its part of what a white surface would show."""
    random = np.random.default_rng(1)
    total = np.zeros((len(views), 3))
    for part in range(AROUND):
        # By the cosine: in parts of the circle below, as many as there are directions.
        turn = 2.0 * np.pi * (part + random.random(len(views))) / AROUND
        across = np.sqrt(random.random(len(views)))
        up = np.sqrt(np.maximum(1.0 - across ** 2, 1e-6))
        lights = np.column_stack([across * np.cos(turn), across * np.sin(turn), up])
        total += np.pi * function.radiance(views, lights, places, widths) / up[:, None]
    return total / AROUND


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
        """@param path of a file of fabric_btf"""
        if path is None:
            raise Refused('--renderer btf: a file of fabric_btf is needed: --btf FABRIC.btf')
        if not os.path.isfile(path):
            raise Refused(f'{path}: there is no such file')
        self.path = path

    @staticmethod
    def require():
        povray.require()

    @staticmethod
    def at_once():
        return 1

    def draw(self, camera, size, environment, things, output):
        cloth = next(thing for thing in things if isinstance(thing, Cloth))
        if len(cloth.weaves) != 1 or cloth.surface.rest is None:
            raise Refused('--renderer btf: allowed is cloth of one fabric (--fabric) with rest coordinates')
        matt = Look(cloth.weaves[0].even.warp)
        with_light, sunlit, share = povray.draw_light(camera, size, environment, things, matt)
        seen = raster.seen(cloth.surface, camera, size, SIDE)
        function = Function(self.path)
        frames, views = frames_of(cloth, seen, camera.eye)
        places = seen.mean(cloth.surface.rest[seen.triangle])
        in_space = seen.mean(cloth.surface.positions[cloth.surface.triangles[seen.triangle]])
        # As wide as a pixel, so that places of neighbours overlap, and yarns as fine as pixels make no patterns.
        widths = camera.pixel(in_space, size[0]) / np.sqrt(views[:, 2])
        shape = size[1], size[0], 3
        sun, bare = np.zeros(shape), np.zeros(shape)  # of cloth; of what is white, by the sun
        if environment.sun is not None:
            of_places, cosines = by_sun(function, frames, views, places, widths, environment)
            # What hides the sun is known by pixel.
            cosine = seen.by_pixel(cosines[:, None])[..., 0] * share
            visible = np.clip(sunlit / np.maximum(cosine, 1e-6), 0.0, 1.0)
            sun = visible[..., None] * seen.by_pixel(of_places)
            bare = (sunlit / np.maximum(share, 1e-6))[..., None] * environment.sunlight
        around = np.maximum(with_light / np.maximum(matt.warp, 1e-3) - bare, 0.0)  # what a white surface would show by all else
        around = spread(around, share > 0.99)
        drawn = sun + around * seen.by_pixel(by_all_around(function, views, places, widths))
        others = with_light - share[..., None] * matt.warp * (bare + around)
        picture = np.where(share[..., None] > 0.0,
                           np.maximum(others, 0.0) * (share < 0.99)[..., None] + share[..., None] * drawn, with_light)
        with tempfile.TemporaryDirectory(prefix='haptex_render_') as name:
            path = pathlib.Path(name, programs.PICTURE)
            imsave(path, srgb(picture))
            pathlib.Path(output).write_bytes(programs.without_time(path.read_bytes()))

