"""Stiffness against stretch and shear, by strips that are held at both ends while a finger presses their
middle. Formulas: docs/evaluation_by_machine.md"""
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from .rater import Judgement

KES_LOAD = 490.3325  # N/m: 500 gf/cm, at which EMT is read
KES_SHEAR = np.radians((0.5, 2.5))  # between which G is the slope
THREAD_STRAINS = 0.004, 0.02  # at which the threads are stretched where the fabric is sheared so far
SMOOTH = 101  # samples that are averaged, over the tremor
LARGEST_FORCE = 1.6  # N: beyond, a strip slips off the fingertip
SAMPLES = 16


class Strip(NamedTuple):
    length: float  # m, between what holds it
    width: float  # m


class Contact:
    """How a strip under tension T (N/m) lies on a round fingertip that presses its middle: as a string on
    the pulp, whose pressure is its stiffness times its depth. In polar coordinates around the fingertip
    r'' = (r^2 + 2 r'^2 - m^3 q(r) r / (m T w)) / r, m^2 = r^2 + r'^2, where q (N/m) is the pressure over the
    width w, of it what points away from the middle. Tabled over depth and T."""

    DEPTHS = np.geomspace(2e-6, 5e-3, 120)  # m
    TENSIONS = np.geomspace(0.1, 1500.0, 160)  # N/m
    ANGLES = np.linspace(0.0, 1.45, 301)  # rad, of half the contact

    def __init__(self, strip, radius, pulp_stiffness):
        self._strip, self._radius = strip, radius
        self.length, self.width = strip
        places, weights = np.polynomial.legendre.leggauss(24)
        depths = np.linspace(0.0, 0.75 * radius, 400)
        away = np.hypot((radius - depths)[:, None], 0.5 * strip.width * places)
        shares = pulp_stiffness * np.maximum(radius - away, 0.0) * (radius - depths)[:, None] / away
        self._loads = depths, shares @ (0.5 * strip.width * weights)
        self._heights, self._slopes, self._strains = self._table()
        self._forces = 2.0 * self.TENSIONS * strip.width * np.sin(self._slopes)

    def _rates(self, state, tensions):
        radii, rises, _ = state
        paths = np.hypot(radii, rises)
        loads = np.interp(self._radius - np.minimum(radii, self._radius), *self._loads)
        curvature = loads * radii / (paths * tensions * self._strip.width)
        return np.array([rises, (radii ** 2 + 2.0 * rises ** 2 - curvature * paths ** 3) / radii,
                         paths])

    def _table(self):
        """Height of the finger, slope of the free strip and its strain, by depth and tension."""
        depths, tensions = (part.ravel() for part in
                            np.meshgrid(self.DEPTHS, self.TENSIONS, indexing='ij'))
        tables = np.full((3, len(depths)), np.nan)
        lanes = np.arange(len(depths))  # whose strip lies on the finger still
        state = np.array([self._radius - depths, np.zeros_like(depths), np.zeros_like(depths)])
        step = self.ANGLES[1]
        for angle in self.ANGLES[:-1]:
            first = self._rates(state, tensions)
            second = self._rates(state + 0.5 * step * first, tensions)
            third = self._rates(state + 0.5 * step * second, tensions)
            fourth = self._rates(state + step * third, tensions)
            after = state + step / 6.0 * (first + 2.0 * second + 2.0 * third + fourth)
            leaves = after[0] >= self._radius
            part = ((self._radius - state[0]) / (after[0] - state[0]))[leaves]
            _, rises, paths = state[:, leaves] + part * (after - state)[:, leaves]
            tables[:, lanes[leaves]] = self._free(angle + part * step, rises, paths)
            # No string is bent so much that it comes nearer to the middle.
            stays = ~leaves & (after[1] > -1e-12) & np.isfinite(after).all(axis=0)
            state, lanes, tensions = after[:, stays], lanes[stays], tensions[stays]
        return tables.reshape(3, len(self.DEPTHS), len(self.TENSIONS))

    def _free(self, angles, rises, paths):
        """@param angles rad, at which the strip leaves the finger @param paths m, until there"""
        half = 0.5 * self._strip.length
        slopes = angles - np.arctan2(rises, self._radius)
        reaches = half - self._radius * np.sin(angles)
        heights = reaches * np.tan(slopes) + self._radius * (1.0 - np.cos(angles))
        # Friction holds what lies on the finger, more or less: half of that counts as stretched.
        strains = (reaches / np.cos(slopes) + paths - half) / (half - 0.5 * paths)
        return heights, slopes, strains

    def stretch(self, height, force):
        """Tension (N/m) and strain by the height of the finger (m) and its force (N); NaN where no tension
        of the table has them."""
        forces = np.full(len(self.TENSIONS), np.nan)
        strains = forces.copy()
        for column, heights in enumerate(self._heights.T):
            known = np.isfinite(heights) & (self._slopes[:, column] > 0.0)
            if known.sum() > 2 and heights[known][0] <= height <= heights[known].max():
                forces[column] = np.interp(height, heights[known], self._forces[known, column])
                strains[column] = np.interp(height, heights[known], self._strains[known, column])
        known = np.isfinite(forces)
        if known.sum() < 2 or not forces[known][0] <= force <= forces[known][-1]:
            return np.nan, np.nan
        logarithms = np.log(self.TENSIONS[known])
        tension = np.interp(force, forces[known], logarithms)
        return np.exp(tension), np.interp(tension, logarithms, strains[known])


def heights_and_forces(record, radius, thickness):
    """How far (m) the fingertip has come beyond the middle of the flat strip, which faces along x, and its
    force (N), until it is the largest."""
    heights = radius + 0.5 * thickness - record.positions[:, 0, 0]
    window = np.ones(SMOOTH) / SMOOTH
    heights, forces = (np.convolve(values, window, 'valid')
                       for values in (heights, record.forces[:, 0, 0]))
    last = int(np.argmax(forces)) if forces.max() < LARGEST_FORCE else int(
        np.argmax(forces >= LARGEST_FORCE))
    return heights[:last + 1], forces[:last + 1]


def stretches(heights, forces, contact):
    """Tensions (N/m) and strains of SAMPLES of a record of heights_and_forces()."""
    some = np.unique(np.linspace(0, len(heights) - 1, SAMPLES).astype(int)) if len(heights) else ()
    found = np.array([contact.stretch(heights[i], forces[i]) for i in some]).reshape(-1, 2)
    return found[np.isfinite(found).all(axis=1)].T


def jackknife(estimate, *samples):
    """Of all samples; the deviation by leaving out each once."""
    count = len(samples[0])
    without = [estimate(*(np.delete(values, i) for values in samples)) for i in range(count)]
    return Judgement(float(estimate(*samples)),
                     float(np.sqrt((count - 1) * np.var(without))))


def tensile_stiffness(record, contact, radius, thickness):
    """N/m: 500 gf/cm over the strain that it takes, by a curve T = A (exp(b e) - 1) through what was felt."""
    heights, forces = heights_and_forces(record, radius, thickness)
    felt = forces > 0.4 * forces[-1]
    tensions, strains = stretches(heights[felt], forces[felt], contact)
    if len(tensions) < 8:
        raise ValueError(f'{len(tensions)} tensions were felt: allowed are 8 or more')

    def at_load(tensions, strains):
        scale = strains.max()
        def residuals(curve):
            bend = np.exp(curve[1])
            return curve[0] + np.log(np.expm1(bend * strains / scale) / np.expm1(bend) / tensions)
        curve = least_squares(residuals, (np.log(tensions.max()), 0.0),
                              bounds=((-10.0, -5.0), (20.0, 4.0))).x
        bend = np.exp(curve[1])
        emt = scale * np.log1p(KES_LOAD / np.exp(curve[0]) * np.expm1(bend)) / bend
        return KES_LOAD / emt
    return jackknife(at_load, tensions, strains)


def thread_compliance(record, contact, radius, thickness):
    """m/N: strain over tension where the strip is stretched little."""
    heights, forces = heights_and_forces(record, radius, thickness)
    # The height of a strip without a fingertip that has this strain.
    near = np.searchsorted(heights, 0.5 * contact.length * np.sqrt(2.0 * np.array(THREAD_STRAINS)))
    tensions, strains = stretches(heights[near[0]:near[1]], forces[near[0]:near[1]], contact)
    if len(tensions) < 4:
        raise ValueError(f'{len(tensions)} tensions of threads were felt: allowed are 4 or more')
    return float(np.median(strains / tensions))


def shear_stiffness(record, contact, radius, thickness, threads):
    """N/m: slope of the shear stress T/2 over the shear of a strip that is cut at 45 degrees, from 0.5 to
    2.5 degrees. Its strain is (shear + T/2 (1/E1 + 1/E2)) / 2, but near what holds it, as far as half its
    width, it is not sheared. @param threads m/N, 1/E1 + 1/E2, thread_compliance() of both"""
    heights, forces = heights_and_forces(record, radius, thickness)
    felt = heights > 6e-3
    tensions, strains = np.array([contact.stretch(*pair) for pair in
                                  zip(heights[felt][::40], forces[felt][::40])]).reshape(-1, 2).T
    sheared = 1.0 - contact.width / contact.length
    shears = (2.0 * strains - 0.5 * threads * tensions) / sheared
    between = (shears > KES_SHEAR[0]) & (shears < KES_SHEAR[1])
    if between.sum() < 8:
        raise ValueError(f'{between.sum()} shears between 0.5 and 2.5 degrees: allowed are 8 or more')
    return jackknife(lambda stress, shear: np.polyfit(shear, stress, 1)[0],
                     0.5 * tensions[between], shears[between])
