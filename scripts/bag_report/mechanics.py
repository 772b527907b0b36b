"""What the cloth's state says of its fabric: mean extension of its elements, and the force that its
attachments carry; and the fabric's own curve."""
import numpy as np
import yaml

TOUCHES = 1e-6  # m, of rest coordinates on one line


def corner_coordinates(message, rest, triangles):
    """m, (triangle, corner, 2) along weft and warp, each in its own panel. Bags of version 0.1 know none."""
    weft = getattr(message, 'corner_weft_coordinates', ())
    if len(weft) == 0:
        return rest[triangles]
    corners = np.column_stack([weft, message.corner_warp_coordinates])
    if len(corners) != triangles.size:
        raise ValueError('the mesh has not one rest coordinate for every corner')
    return corners.reshape(-1, 3, 2)


class ClothMechanics:
    """Of one mesh (haptex/ClothMesh)."""

    def __init__(self, message):
        rest = np.column_stack([message.rest_weft_coordinates, message.rest_warp_coordinates])
        self.triangles = np.array(message.triangles, dtype=int).reshape(-1, 3)
        if len(self.triangles) == 0 or self.triangles.max() >= len(rest):
            raise ValueError('the mesh names particles that are not there')
        corners = corner_coordinates(message, rest, self.triangles)
        first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        doubled = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
        if not (np.isfinite(doubled).all() and doubled.all()):
            raise ValueError('the mesh has triangles without an area')
        self.areas = 0.5 * np.abs(doubled)
        # Images of the unit vectors along weft and warp: U = P w_u, V = P w_v.
        self.weights = np.empty((2, len(self.triangles), 3))
        self.weights[0, :, 1], self.weights[0, :, 2] = second[:, 1] / doubled, -first[:, 1] / doubled
        self.weights[1, :, 1], self.weights[1, :, 2] = -second[:, 0] / doubled, first[:, 0] / doubled
        self.weights[:, :, 0] = -self.weights[:, :, 1] - self.weights[:, :, 2]
        self.rest = rest
        self.count = len(rest)
        self.mass = float(sum(message.masses))  # kg
        self.size = rest.max(axis=0) - rest.min(axis=0)  # m, weft and warp
        self.sides = [rest[:, axis] >= rest[:, axis].max() - TOUCHES for axis in range(2)]

    def strains(self, positions):
        """Engineering strain along weft and warp, mean over the area at rest."""
        if len(positions) != len(self.rest):
            raise ValueError('the state has not the particles of its mesh')
        corners = positions[self.triangles]
        stretches = [np.linalg.norm(np.einsum('tc,tcx->tx', weights, corners), axis=1)
                     for weights in self.weights]
        return tuple(float(np.average(stretch, weights=self.areas)) - 1.0 for stretch in stretches)

    def forces(self, forces, positions):
        """N, that the sides at the largest weft and warp coordinates carry, along the way from the
        cloth's middle to each side."""
        middle = positions.mean(axis=0)
        carried = []
        for side in self.sides:
            direction = positions[side].mean(axis=0) - middle
            length = np.linalg.norm(direction)
            # What is attached holds minus the force on it.
            force = -forces[side].sum(axis=0)
            carried.append(float(force.dot(direction) / length) if length > 0.0 else 0.0)
        return tuple(carried)

    def forces_per_width(self, forces, positions):
        """N/m: those forces over the width of the cloth at rest."""
        weft, warp = self.forces(forces, positions)
        return weft / self.size[1], warp / self.size[0]

    def held(self, attached):
        """Whether these particles hold more than half of the side at the largest weft, and warp
        coordinate: of a sheet that hangs from its upper edge the corners alone hold no other side."""
        particles = np.array([particle for particle in attached if particle < self.count], dtype=int)
        found = []
        for axis, side in enumerate(self.sides):
            along = self.rest[particles[side[particles]], 1 - axis]
            found.append(len(along) > 0 and bool(np.ptp(along) > 0.5 * self.size[1 - axis]))
        return tuple(found)

    def largest_strains(self, positions):
        """Per triangle, the larger of weft and warp."""
        corners = positions[self.triangles]
        return np.max([np.linalg.norm(np.einsum('tc,tcx->tx', weights, corners), axis=1)
                       for weights in self.weights], axis=0) - 1.0


class FabricFile:
    """What the report takes from the text of a fabric file (docs/fabric_files.md)."""

    def __init__(self, text):
        self.data = yaml.safe_load(text)
        if not isinstance(self.data, dict):
            raise ValueError('the text of the fabric file is no mapping')
        self.name = str(self.data.get('name', '?'))

    def friction(self):
        """Coefficient and provenance, or none."""
        friction = self.data.get('friction')
        try:
            return float(friction['value']), str(friction['provenance'])
        except (KeyError, TypeError, ValueError):
            return None

    def provenances(self):
        """By property, of those that state one."""
        found = {}
        for key, value in self.data.items():
            if not isinstance(value, dict):
                continue
            if 'provenance' in value:
                found[key] = value['provenance']
            for part, inner in value.items():
                if isinstance(inner, dict) and 'provenance' in inner:
                    found[f'{key} {part}'] = inner['provenance']
        return found

    def curve(self, direction, factor=1.0):
        """Engineering strains and forces per width (N/m) of the elastic curve of weft or warp, straight
        between the points of the file.
        @param factor on the stress (haptex/ClothMesh)"""
        elastic = self.data[direction]['elastic']
        if 'points' in elastic:
            points = np.array(elastic['points'], dtype=float)
            if (points[:, 0] > 0.0).all():
                points = np.concatenate([[[0.0, 0.0]], points])
            strains, stresses = points.T
            if elastic['quantity'] == 'force_per_width_over_engineering_strain':
                return strains, factor * stresses
        elif 'modulus' in elastic:
            strains = np.linspace(-0.4, 1.0, 701)
            stresses = float(elastic['modulus']) * strains
        else:
            strains, stresses = polynomial_curve(**elastic['polynomials'])
        stretches = np.sqrt(np.maximum(0.0, 1.0 + 2.0 * strains))
        return stretches - 1.0, factor * stretches * stresses

    def curve_between(self, direction, least, largest, factor=1.0):
        """The part of the curve from one engineering strain to another, as far as the file goes."""
        strains, forces = self.curve(direction, factor)
        shown = np.linspace(max(least, strains[0]), min(largest, strains[-1]), 200)
        return shown, np.interp(shown, strains, forces)


def polynomial_curve(knots, coefficients):
    strains, stresses = [], []
    knots = [float(knot) for knot in knots]
    for begin, end, row in zip(knots, knots[1:], coefficients):
        pieces = np.linspace(begin, end, 12)
        strains += list(pieces)
        stresses += list(np.polynomial.polynomial.polyval(pieces - begin,
                                                               [float(value) for value in row]))
    return np.array(strains), np.array(stresses)
