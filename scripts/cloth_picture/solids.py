"""Rigid things beside the cloth: a scene's obstacles, and the hand with its exoskeleton."""
import pathlib
import xml.etree.ElementTree

import numpy as np
import roslib.packages
import yaml

from bag_report.bags import Refused
from tf.transformations import euler_matrix, quaternion_matrix, rotation_matrix

from .looks import FIGURE, FLOOR, Look
from .obj_file import Surface, read_obj

SKIN_GLOSS = 0.03, 0.45


def pose_of(turn, place):
    """@param turn homogeneous, as tf.transformations makes them; changed"""
    turn[:3, 3] = place
    return turn


def pose_of_message(turn, place):
    """@param turn, place of a geometry_msgs/Pose, or of a Transform"""
    return pose_of(quaternion_matrix([turn.x, turn.y, turn.z, turn.w]), [place.x, place.y, place.z])


def floats(text):
    return [float(word) for word in text.split()]


class Solid:
    """A sphere (sizes: radius), a box (whole edge lengths), a capsule or a cylinder (radius, length, along z), a level
    plane, or a surface. pose is 4 x 4, from its own axes into the world."""

    def __init__(self, kind, sizes, pose, look, surface=None):
        self.kind, self.sizes, self.pose, self.look = kind, sizes, pose, look
        self.surface = surface  # already in the world

    def corners(self):
        """m, of what it lies in, in the world."""
        if self.surface is not None:
            return self.surface.positions
        half = {'sphere': lambda: np.full(3, self.sizes[0]), 'box': lambda: 0.5 * np.array(self.sizes)}.get(
            self.kind, lambda: np.array([self.sizes[0], self.sizes[0], 0.5 * self.sizes[1]
                                         + (self.sizes[0] if self.kind == 'capsule' else 0.0)]))()
        signs = np.array(np.meshgrid(*3 * [(-1.0, 1.0)])).reshape(3, -1).T
        return signs * half @ self.pose[:3, :3].T + self.pose[:3, 3]


def floor(height):
    """@param height m"""
    return Solid('plane', [], pose_of(np.eye(4), [0.0, 0.0, height]), FLOOR)


class Obstacles:
    """Of a scene file (docs/scene_files.md)."""

    def __init__(self, text, scene_path):
        scene = yaml.safe_load(text)
        self.items = list(scene.get('obstacles') or []) if isinstance(scene, dict) else []
        self.folder = pathlib.Path(scene_path).parent
        self.meshes = {}

    def mesh(self, name):
        """In the obstacle's axes; where the scene was, or else the package's."""
        if name not in self.meshes:
            here = self.folder / name if '/' in name else self.folder.parent / 'meshes' / f'{name}.obj'
            package = pathlib.Path(roslib.packages.get_pkg_dir('haptex'), 'config', 'meshes')
            self.meshes[name] = read_obj(here if here.is_file() else package / f'{pathlib.Path(name).stem}.obj')
        return self.meshes[name]

    def at(self, time, bodies):
        """@param time s, simulated @param bodies haptex/ClothState's @throws Refused naming an obstacle that is
        none"""
        with_mass = iter(bodies)
        solids = []
        for item in self.items:
            try:
                solids.append(self.solid(item, pose_at(item, time, with_mass)))
            except (AttributeError, KeyError, TypeError, ValueError) as error:
                raise error if isinstance(error, Refused) else Refused(
                    f'recording/about of the bag: {item} is no obstacle of a scene file ({error})') from error
        return solids

    def solid(self, item, pose):
        if 'mesh' in item:
            mesh = self.mesh(item['mesh'])
            return Solid('mesh', [], pose, FIGURE,
                         Surface(mesh.positions @ pose[:3, :3].T + pose[:3, 3], mesh.triangles))
        if 'capsule' in item:
            return Solid('capsule', [item['capsule']['radius'], item['capsule']['length']], pose, FIGURE)
        return Solid('sphere', [item['sphere']], pose, FIGURE) if 'sphere' in item else \
            Solid('box', item['box'], pose, FIGURE)


def pose_at(item, time, with_mass):
    """Of an obstacle of a scene file. @param with_mass iterator over poses of those with mass"""
    turn, place = euler_matrix(*item.get('rpy', (0, 0, 0))), np.array(item['position'], float)
    if 'orbit' in item:
        orbit = item['orbit']
        centre = np.array(orbit['centre'], float)
        turned = rotation_matrix(2.0 * np.pi * time / orbit['period'], orbit['axis'])
        turn, place = turned @ turn, centre + turned[:3, :3] @ (place - centre)
    if 'velocity' in item:
        place = place + time * np.array(item['velocity'], float)
    body = next(with_mass, None) if 'body' in item else None
    if body is not None:
        return pose_of_message(body.orientation, body.position)
    return pose_of(turn, place)


def obstacles_of(about_text):
    """Of a bag's recording/about; none if that does not say the scene. @throws Refused if it cannot be read"""
    try:
        what = yaml.safe_load(about_text)
        if not isinstance(what, dict) or 'scene_file' not in what:
            return None
        return Obstacles(what['scene_file'], what.get('scene', ''))
    except yaml.YAMLError as error:
        raise Refused(f'recording/about of the bag is no YAML ({error})') from error


class Hand:
    """What urdf/hand_exoskeleton.urdf draws, link by link."""

    def __init__(self):
        path = pathlib.Path(roslib.packages.get_pkg_dir('haptex'), 'urdf', 'hand_exoskeleton.urdf')
        root = xml.etree.ElementTree.parse(path).getroot()
        self.colours = {material.get('name'): floats(material.find('color').get('rgba'))[:3]
                        for material in root.iter('material') if material.find('color') is not None}
        self.links = {link.get('name'): [self.visual(visual) for visual in link.findall('visual')]
                      for link in root.findall('link')}

    def visual(self, visual):
        origin, geometry = visual.find('origin'), visual.find('geometry')[0]
        pose = pose_of(euler_matrix(*floats(origin.get('rpy', '0 0 0'))), floats(origin.get('xyz', '0 0 0')))
        name = visual.find('material').get('name')
        # Colours of a URDF are those of a screen.
        linear = np.array(self.colours.get(name, (0.6, 0.6, 0.6))) ** 2.2
        look = Look(linear, *(SKIN_GLOSS if name == 'skin' else (0.1, 0.3)))
        sizes = {'box': lambda: floats(geometry.get('size')), 'sphere': lambda: [float(geometry.get('radius'))],
                 'cylinder': lambda: [float(geometry.get('radius')), float(geometry.get('length'))]}
        return geometry.tag, sizes[geometry.tag](), pose, look

    def at(self, frames):
        """@param frames poses in the world by name"""
        solids = []
        for name, pose in frames.items():
            for kind, sizes, own, look in self.links.get(name.split('/')[-1], []):
                solids.append(Solid(kind, sizes, pose @ own, look))
        return solids
