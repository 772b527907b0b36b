"""Puts cloth, what is beside it, a floor and an environment before a camera, and has them drawn."""
import os
import pathlib

import numpy as np

from bag_report.bags import Refused

from .camera import framing
from .solids import floor
from .weave import Cloth, Weave

BELOW = 0.2  # of its height, is the floor below cloth that hangs alone
NEAREST = 10.0  # %: so much of the cloth may be nearer than where it is as fine as the pixels
NEAR = 0.15  # times its extent, is what of a hand must be seen
LARGE = 5.0  # times the cloth's extent: what is larger need not be seen whole


class Scene:
    """surface of cloth, which of the fabrics each triangle is of, obstacles (or a body) and the hand's solids."""

    def __init__(self, surface, fabric_of, fabrics, obstacles=(), hand=()):
        self.surface, self.fabric_of, self.fabrics = surface, fabric_of, fabrics
        self.obstacles, self.hand = list(obstacles), list(hand)

    def seen(self):
        """m, places that must be in the picture: the cloth, what it lies on unless that is far larger, and of
        the hand what is near."""
        places = [self.surface.positions]
        extent = np.linalg.norm(np.ptp(self.surface.positions, axis=0))
        for solid in self.obstacles:
            corners = solid.corners()
            if np.linalg.norm(np.ptp(corners, axis=0)) < LARGE * extent:
                places.append(corners)
        low, high = self.surface.positions.min(axis=0), self.surface.positions.max(axis=0)
        for corners in (solid.corners() for solid in self.hand):
            if (np.abs(corners.mean(axis=0) - 0.5 * (low + high)) < 0.5 * (high - low) + NEAR * extent).all():
                places.append(corners)
        return np.concatenate(places)

    def ground(self):
        """m, height of the floor: below all that stands, or at a distance below cloth that hangs."""
        lowest = min(float(places[:, 2].min()) for places in
                     [self.surface.positions, *(solid.corners() for solid in [*self.obstacles, *self.hand])])
        return lowest if self.obstacles else lowest - BELOW * float(np.ptp(self.surface.positions[:, 2]))


def draw(renderer, scene, reliefs, camera, ground, size, environment, output):
    """@param renderer the module povray or cycles @param reliefs of the scene's fabrics, see relief_of()
    @param size pixels @param output path of a PNG"""
    pixel = float(np.percentile(camera.pixel(scene.surface.positions, size[0]), NEAREST))
    cloth = Cloth(scene.surface, scene.fabric_of,
                  [Weave(fabric, relief, pixel) for fabric, relief in zip(scene.fabrics, reliefs)])
    renderer.draw(camera, size, environment, [cloth, floor(ground), *scene.obstacles, *scene.hand], output)


def camera_for(scenes, size):
    """From which all of several moments are seen."""
    return framing(np.concatenate([scene.seen() for scene in scenes]), size)


def require_writable(output):
    path = pathlib.Path(output)
    if path.suffix != '.png':
        raise Refused(f'{output}: allowed are paths that end with .png')
    if not path.parent.is_dir() or not os.access(path.parent, os.W_OK):
        raise Refused(f'{output}: the folder {path.parent} is not there or cannot be written')
