"""Triangles of Wavefront OBJ files, as drape_garment and preposition write them and scenes read them."""
import numpy as np

from bag_report.bags import Refused


class Surface:
    """Triangles in space."""

    def __init__(self, positions, triangles, rest=None):
        self.positions = positions  # m, (particle, 3), world frame
        self.triangles = triangles  # particles, (triangle, 3)
        self.rest = rest  # m, (triangle, corner, 2) along weft and warp, or none

    def normals(self):
        """Of every particle: the mean of its triangles' by area."""
        corners = self.positions[self.triangles]
        areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals = np.zeros_like(self.positions)
        for corner in range(3):
            np.add.at(normals, self.triangles[:, corner], areas)
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        return np.where(lengths > 0.0, normals / np.maximum(lengths, 1e-30), [0.0, 0.0, 1.0])


def numbers_of(words, count, what):
    if len(words) < count:
        raise ValueError(f'{what} has {len(words)} numbers, allowed are {count}')
    values = [float(word) for word in words[:count]]
    if not np.isfinite(values).all():
        raise ValueError(f'{what} has a number that is not finite')
    return values


def corner_of(word, positions, textures):
    """Numbers from 0 of a corner's position and texture coordinate, the second -1 where it has none."""
    parts = word.split('/')
    found = []
    for text, count, what in ((parts[0], positions, 'v'), (parts[1] if len(parts) > 1 else '', textures, 'vt')):
        if not text and what == 'vt':
            found.append(-1)
            continue
        number = int(text)
        number = number - 1 if number > 0 else count + number
        if not 0 <= number < count:
            raise ValueError(f'{word} names a {what} that is not there, of {count} so far')
        found.append(number)
    return found


def read_obj(path):
    """Rest coordinates only if every triangle has some, and an area in them. @throws Refused naming file and line"""
    positions, textures, faces = [], [], []
    try:
        with open(path, encoding='utf-8', errors='replace') as file:
            for number, line in enumerate(file, 1):
                kind, *words = line.split('#')[0].split() or ['']
                try:
                    if kind == 'v':
                        positions.append(numbers_of(words, 3, 'v'))
                    elif kind == 'vt':
                        textures.append(numbers_of(words, 2, 'vt'))
                    elif kind == 'f':
                        if len(words) != 3:
                            raise ValueError(f'a face has {len(words)} corners, allowed are triangles')
                        faces.append([corner_of(word, len(positions), len(textures)) for word in words])
                except ValueError as error:
                    raise Refused(f'{path}: line {number}: {error}; allowed are OBJ files of triangles') \
                        from error
    except OSError as error:
        raise Refused(f'{path}: cannot be read ({error.strerror})') from error
    if not faces:
        raise Refused(f'{path}: there is no triangle in it; allowed are OBJ files of triangles')
    corners = np.array(faces)
    rest = np.array(textures)[corners[:, :, 1]] if (corners[:, :, 1] >= 0).all() else None
    if rest is not None and not (np.linalg.det(rest[:, 1:] - rest[:, :1]) != 0.0).all():
        rest = None  # triangles without an area lie nowhere on the fabric
    return Surface(np.array(positions), corners[:, :, 0], rest)
