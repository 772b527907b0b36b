"""The picture of a demo: the cloth at the end of its phases, and forces against time."""
import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import LogNorm

from .recording import bar_forces
from .series import FINGERS, PHASES, WITH_CONTACT

STRAIN_SCALE = 0.01  # as the default of cloth_simulation
LIGHT = np.array([0.62, -0.52, 0.58]) / np.linalg.norm([0.62, -0.52, 0.58])


class Triangles:
    def __init__(self, mesh):
        self.indices = np.array(mesh.triangles).reshape(-1, 3)
        u, v = np.array(mesh.rest_weft_coordinates), np.array(mesh.rest_warp_coordinates)
        ua, ub, uc = u[self.indices].T
        va, vb, vc = v[self.indices].T
        d = ua * (vb - vc) + ub * (vc - va) + uc * (va - vb)
        self.areas = np.abs(d) / 2
        self.weft_weights = np.stack([vb - vc, vc - va, va - vb], axis=1) / d[:, None]
        self.warp_weights = np.stack([uc - ub, ua - uc, ub - ua], axis=1) / d[:, None]

    def directions(self, positions):
        """Images of the unit vectors along weft and warp, each (triangle, 3)."""
        corners = positions[self.indices]
        return (np.einsum('tk,tkx->tx', self.weft_weights, corners),
                np.einsum('tk,tkx->tx', self.warp_weights, corners))

    def principal_strain(self, positions):
        weft, warp = self.directions(positions)
        euu, evv = ((np.sum(weft * weft, axis=1) - 1) / 2, (np.sum(warp * warp, axis=1) - 1) / 2)
        euv = np.sum(weft * warp, axis=1) / 2
        return (euu + evv) / 2 + np.hypot((euu - evv) / 2, euv)

    def smooth(self, values):
        """Values of triangles, averaged at the particles as the markers do and back again."""
        sums, areas = np.zeros(self.indices.max() + 1), np.zeros(self.indices.max() + 1)
        for corner in self.indices.T:
            np.add.at(sums, corner, values * self.areas)
            np.add.at(areas, corner, self.areas)
        return (sums / areas)[self.indices].mean(axis=1)


def project(points):
    """Perspective view from the front, a little to the right and above: (right, up), depth."""
    azimuth, elevation, distance = np.radians(40), np.radians(10), 1.1
    forward = -np.array([np.cos(azimuth) * np.cos(elevation), np.sin(azimuth) * np.cos(elevation),
                         np.sin(elevation)])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    up = np.cross(right, forward)
    centred = points - np.array([0, 0, -0.1])
    depth = distance + centred @ forward
    return np.stack([centred @ right, centred @ up], axis=-1) * (distance / depth)[..., None], depth


def draw(axes, positions, triangles, norm):
    image, depth = project(positions)
    corners = positions[triangles.indices]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True) + 1e-300
    shade = 0.35 + 0.65 * np.abs(normals @ LIGHT)
    strain = triangles.smooth(triangles.principal_strain(positions))
    colours = plt.get_cmap('viridis')(norm(np.maximum(strain, 1e-300)))
    colours[:, :3] *= shade[:, None]
    order = np.argsort(-depth[triangles.indices].mean(axis=1))
    axes.add_collection(PolyCollection(image[triangles.indices][order], facecolors=colours[order],
                                       edgecolors=colours[order], linewidths=0.3))


def save_picture(recording, path):
    """The cloth at the end of each phase with contact, and the forces against time."""
    triangles = Triangles(recording.mesh)
    warp = np.array(recording.mesh.rest_warp_coordinates)
    bar = np.flatnonzero(warp > warp.max() - 1e-9)
    norm = LogNorm(1e-4 * STRAIN_SCALE, STRAIN_SCALE, clip=True)
    figure = plt.figure(figsize=(12, 9), layout='constrained')
    views, below, tactile = figure.subfigures(3, 1, height_ratios=[1, 1.15, 0.75])
    for axes, phase in zip(views.subplots(1, len(WITH_CONTACT)), WITH_CONTACT):
        end = recording.span(phase)[1]
        state = recording.states.values[np.searchsorted(recording.states.times, end) - 1]
        draw(axes, state[2], triangles, norm)
        ends, _ = project(state[2][bar[[0, -1]]])
        axes.plot(*ends.T, color='0.25', linewidth=5, solid_capstyle='round')
        axes.set(title=phase, aspect='equal', xlim=(-0.145, 0.145), ylim=(-0.135, 0.125))
        axes.axis('off')
    draw_forces(below.subplots(1, 1), recording)
    draw_tactile(tactile.subplots(1, 1), recording)
    figure.savefig(path, dpi=110)


def draw_forces(axes, recording):
    start = recording.begins[PHASES[0]]
    for finger, colour in zip(FINGERS, ['tab:blue', 'tab:orange']):
        contact, felt = recording.contact[finger], recording.felt[finger]
        axes.plot(contact.times - start, np.array(contact.values)[:, 0], color=colour,
                  linewidth=0.7, alpha=0.6, label=f'{finger}, rendered')
        axes.plot(felt.times - start, np.linalg.norm(felt.values, axis=1), color=colour,
                  label=f'{finger}, felt')
    axes.plot(recording.states.times - start, bar_forces(recording), color='black', label='bar')
    draw_phases(axes, recording)
    axes.set(ylabel='force (N)')
    # A bar that is torn must not hide the fingers: the table tells its largest force.
    largest = max(np.linalg.norm(recording.felt[f].values, axis=1).max() for f in FINGERS)
    axes.set_ylim(0.0, 1.25 * largest)
    axes.grid(alpha=0.3)
    axes.legend(loc='upper left')


def draw_phases(axes, recording):
    """The axis of time and where the phases begin."""
    start = recording.begins[PHASES[0]]
    for phase in PHASES[1:]:
        begin = recording.begins[phase] - start
        axes.axvline(begin, color='0.7', linewidth=0.8)
        axes.text(begin, 1.0, ' ' + phase, transform=axes.get_xaxis_transform(), va='bottom')
    # Before the fingers come nothing happens but homing.
    axes.set(xlabel='time (s)',
             xlim=(recording.begins['pinch'] - start - 2.0, recording.begins['end'] - start))


def draw_tactile(axes, recording):
    start = recording.begins[PHASES[0]]
    for finger, colour in zip(FINGERS, ['tab:blue', 'tab:orange']):
        series = recording.tactile[finger]
        means = np.array([amplitudes.mean(axis=0) for amplitudes, _ in series.values])
        for channel, (name, style) in enumerate([('40 Hz', '-'), ('320 Hz', ':')]):
            axes.plot(series.times - start, means[:, channel], style, color=colour, linewidth=1,
                      label=f'{finger}, {name}')
    draw_phases(axes, recording)
    axes.set(ylabel='mean amplitude (um)', yscale='log', ylim=(0.01, 100))
    axes.grid(alpha=0.3)
    axes.legend(loc='upper left')
