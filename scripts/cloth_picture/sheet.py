"""All fabrics draped over the same ball, and on one sheet."""
import concurrent.futures
import os
import pathlib
import subprocess
import tempfile

import matplotlib
import numpy as np
import roslib.packages
import yaml

from bag_report.bags import Refused

from . import picture, povray
from .camera import Camera
from .looks import FIGURE, fabric_called, package_fabrics
from .obj_file import Surface, read_obj
from .solids import Solid
from .weave import relief_of

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402

RADIUS, SIDE = 0.08, 0.26  # m: of the ball, and of the square cloth, whose corners do not reach the floor
ABOVE = 0.004  # m, over the ball, is the cloth at first
EDGE = 0.006  # m, of the cloth's triangles
CUTS = 5  # of the ball's triangles into four
COLUMNS, PANEL, CLOSE, LABEL = 5, (480, 400), (150, 150), 40  # pixels
VIEW = Camera((0.57, 0.28, 0.36), (0.0, -0.024, 0.062))
CLOSE_VIEW = Camera((0.105, 0.048, 0.225), (0.028, 0.012, 0.158), np.radians(6.0))


def ball():
    """A closed surface that stands on z = 0: the faces of an octahedron, cut and put on the sphere."""
    places = np.concatenate([np.eye(3), -np.eye(3)])
    triangles = [(a, b, c) for a in (0, 3) for b in (1, 4) for c in (2, 5)]
    triangles = [triangle if np.linalg.det(places[list(triangle)]) > 0 else triangle[::-1] for triangle in triangles]
    places, middles = list(places), {}

    def middle(one, other):
        key = min(one, other), max(one, other)
        if key not in middles:
            middles[key] = len(places)
            places.append((places[one] + places[other]) / np.linalg.norm(places[one] + places[other]))
        return middles[key]
    for _ in range(CUTS):
        triangles = [small for a, b, c in triangles for small in (
            (a, middle(a, b), middle(c, a)), (b, middle(b, c), middle(a, b)),
            (c, middle(c, a), middle(b, c)), (middle(a, b), middle(b, c), middle(c, a)))]
    return Surface(RADIUS * (np.array(places) + [0.0, 0.0, 1.0]), np.array(triangles))


def garment_of(fabric):
    corners = [[0.0, 0.0], [SIDE, 0.0], [SIDE, SIDE], [0.0, SIDE]]
    edges = [{'line': [begin, end]} for begin, end in zip(corners, corners[1:] + corners[:1])]
    placement = {'position': [-0.5 * SIDE, -0.5 * SIDE, 2.0 * RADIUS + ABOVE], 'rpy': [0.0, 0.0, 0.0]}
    return {'source': 'one square', 'panels': [
        {'name': 'square', 'fabric': fabric, 'placement': placement, 'outline': edges}]}


def draped(fabric, folder):
    """Where a square of the fabric comes to rest on the ball, by drape_garment. @throws Refused if it does not"""
    programs = roslib.packages.find_node('haptex', 'drape_garment')
    if not programs:
        raise Refused('the program drape_garment is not built, or not found by rosrun')
    garment, body, out = folder / f'{fabric}.yaml', folder / 'ball.obj', folder / f'{fabric}.obj'
    garment.write_text(yaml.safe_dump(garment_of(fabric)))
    run = subprocess.run([programs[0], garment, out, '--body', body, '--edge', str(EDGE)], capture_output=True,
                         text=True)
    if run.returncode != 0:
        raise Refused(f'{fabric} does not come to rest on the ball: {" ".join(run.stderr.split())}')
    return read_obj(out)


def write_obj(surface, path):
    lines = ['v {:.9g} {:.9g} {:.9g}'.format(*place) for place in surface.positions]
    path.write_text('\n'.join(lines + ['f {} {} {}'.format(*triangle) for triangle in surface.triangles + 1]) + '\n')


def draw_fabric(name, folder, environment):
    """@returns paths of the pictures from afar and from near"""
    fabric = fabric_called(name)
    surface = draped(name, folder)
    body = Solid('mesh', [], np.eye(4), FIGURE, ball())
    scene = picture.Scene(surface, np.zeros(len(surface.triangles), dtype=int), [fabric], [body])
    paths = [folder / f'{name}_{which}.png' for which in ('far', 'near')]
    relief = relief_of(fabric)
    for path, camera, size in zip(paths, (VIEW, CLOSE_VIEW), (PANEL, CLOSE)):
        picture.draw(povray, scene, [relief], camera, 0.0, size, environment, path)
    return paths


def make_sheet(environment, output, fabrics=None):
    """@param fabrics names, those of config/fabrics if none are given @param output path of a PNG"""
    names = fabrics or [name for name, path in package_fabrics().items() if path.parent.name == 'fabrics']
    with tempfile.TemporaryDirectory(prefix='haptex_sheet_') as place, \
            concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        folder = pathlib.Path(place)
        write_obj(ball(), folder / 'ball.obj')
        drawn = [pool.submit(draw_fabric, name, folder, environment) for name in names]
        panels = []
        for name, pair in zip(names, drawn):
            panels.append([plt.imread(path)[..., :3] for path in pair.result()])
            print(name, flush=True)
    arrange(names, panels, output)


def arrange(names, panels, output):
    rows = -(-len(names) // COLUMNS)
    columns = min(COLUMNS, len(names))
    sheet = np.ones((rows * (PANEL[1] + LABEL), columns * PANEL[0], 3))
    for number, (far, near) in enumerate(panels):
        top, left = number // COLUMNS * (PANEL[1] + LABEL), number % COLUMNS * PANEL[0]
        sheet[top:top + PANEL[1], left:left + PANEL[0]] = far
        near = np.pad(near, ((2, 0), (0, 2), (0, 0)), constant_values=1.0)
        sheet[top + PANEL[1] - near.shape[0]:top + PANEL[1], left:left + near.shape[1]] = near
    figure = plt.figure(figsize=(sheet.shape[1] / 100, sheet.shape[0] / 100), dpi=100)
    figure.figimage(sheet)
    for number, name in enumerate(names):
        x = (number % COLUMNS + 0.5) * PANEL[0] / sheet.shape[1]
        y = 1.0 - ((number // COLUMNS + 1) * (PANEL[1] + LABEL) - 0.5 * LABEL) / sheet.shape[0]
        figure.text(x, y, name.replace('_', ' '), ha='center', va='center', fontsize=16)
    figure.savefig(output, dpi=100, metadata={'Software': None})
    plt.close(figure)
