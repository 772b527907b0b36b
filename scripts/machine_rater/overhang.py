"""Rigidity against bending, by a strip that reaches over a fingertip: Peirce's cantilever, felt. Formulas:
docs/evaluation_by_machine.md"""
import numpy as np
from scipy.linalg import solve_banded
from scipy.optimize import least_squares

from .rater import GRAVITY, Judgement

SEGMENTS = 100
SMOOTH = 201  # samples that are averaged, over the tremor
BEARS = (0.15, 0.4)  # of the strip's weight, by which it is judged: less steep than 50 degrees
SAMPLES = 8


def hanging_shape(rigidity, load, length, place, force):
    """Slopes (rad) and positions along x and z (m) of the ends of the segments of a strip that is clamped
    horizontally at 0: K t'' + n_z cos t - n_x sin t = 0, where n is the force of what is beyond on what is
    before. @param rigidity N m^2 @param load N/m, its weight @param place m along it, where a force
    (N; x, z) acts"""
    step = length / SEGMENTS
    nodes = np.linspace(0.0, length, SEGMENTS + 1)
    borne = np.clip((place - nodes) / step + 0.5, 0.0, 1.0)
    along, down = force[0] * borne, force[1] * borne - load * (length - nodes)
    stiff = rigidity / step ** 2
    slopes = np.zeros(SEGMENTS + 1)
    for _ in range(50):
        balance = down * np.cos(slopes) - along * np.sin(slopes)
        balance[1:-1] += stiff * (slopes[2:] - 2.0 * slopes[1:-1] + slopes[:-2])
        balance[-1] += 2.0 * stiff * (slopes[-2] - slopes[-1])
        balance[0] = 0.0
        if np.abs(balance).max() < 1e-9 * load * length:
            break
        bands = np.zeros((3, SEGMENTS + 1))
        bands[0, 2:] = bands[2, :-2] = stiff
        bands[1] = -2.0 * stiff - down * np.sin(slopes) - along * np.cos(slopes)
        bands[2, -2] = 2.0 * stiff
        bands[1, 0] = 1.0
        change = solve_banded((1, 1), bands, -balance)
        slopes += change * min(1.0, 0.3 / np.abs(change).max())
    middle = 0.5 * (slopes[1:] + slopes[:-1])
    x, z = (np.concatenate([[0.0], step * np.cumsum(part(middle))]) for part in (np.cos, np.sin))
    return nodes, slopes, x, z


def distance(rigidity, load, length, centre, offset, force):
    """m: of the strip, where it touches the fingertip's surface, above that surface. @param centre m, x and
    z of the fingertip's middle @param offset m, from there to the strip's middle"""
    place = centre[0]
    for _ in range(12):
        nodes, slopes, x, z = hanging_shape(rigidity, load, length, place, force)
        slope = np.interp(place, nodes, slopes)
        error = centre[0] - offset * np.sin(slope) - np.interp(place, nodes, x)
        if abs(error) < 1e-6:
            break
        place = min(max(place + error / max(np.cos(slope), 0.3), 1e-3), length)
    slope = np.interp(place, nodes, slopes)
    return np.interp(place, nodes, z) - (centre[1] + offset * np.cos(slope))


def bending(record, strip, fingertips, thickness, weight):
    """Rigidity (N m) of a strip that the index finger lowers, by the forces and places while it bears little
    of it. @param weight kg/m^2, as judged @param thickness m, likewise"""
    radius = fingertips.index_radius
    load = weight * GRAVITY * strip.width
    positions, forces = record.positions[:, 0], -record.forces[:, 0]
    if weight <= 0.0:
        raise ValueError(f'the sample weighs {weight:.3g} kg/m2: allowed are > 0')
    share = np.convolve(forces[:, 2], np.ones(SMOOTH) / SMOOTH, 'same') / (load * strip.length)
    if not (share > BEARS[1]).any():
        raise ValueError(f'the finger bears up to {share.max():.2g} of the strip: allowed is more than '
                         f'{BEARS[1]}')
    begin, end = (int(np.flatnonzero(share > part)[-1]) for part in reversed(BEARS))
    samples = []
    for part in np.array_split(np.arange(begin, end), SAMPLES):
        force, centre = (values[part].mean(axis=0)[[0, 2]] for values in (forces, positions))
        depth = np.sqrt(np.hypot(*force) / (np.pi * radius * fingertips.pulp_stiffness))
        samples.append((centre, radius + 0.5 * thickness - depth, force))

    def distances(logarithm):
        return [1e3 * distance(np.exp(logarithm[0]), load, strip.length, *sample)
                for sample in samples]
    found = least_squares(distances, (np.log(load * 0.018 ** 3),), diff_step=1e-3, xtol=1e-4)
    rigidity = float(np.exp(found.x[0]) / strip.width)
    spread = np.sqrt(2.0 * found.cost / (SAMPLES - 1) / float(found.jac.T @ found.jac))
    return Judgement(rigidity, rigidity * float(spread))
