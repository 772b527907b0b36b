"""Judges a fabric by what a device measured, and by nothing else: neither by the fabric's file nor by
the cloth's state. The rater knows the sample's size and its own fingertips. Formulas:
docs/evaluation_by_machine.md"""
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

GRAVITY = 9.80665  # m/s^2
AREA = 0.04  # m^2, of the sample
BLOCKS = 8  # that means are taken over, for their deviation
KES_PRESSURE = 50 * 98.0665  # Pa, under which Tm is measured
FIRST_FORCE = 3e-5  # N, of a pinch
EXPONENT = 0.2  # of a compression curve, for a linearity LC = 2 EXPONENT / (1 + EXPONENT) of 1/3


class Judgement(NamedTuple):
    value: float
    uncertainty: float  # standard deviation


class Fingertips(NamedTuple):
    index_radius: float  # m
    thumb_radius: float  # m
    pulp_stiffness: float  # Pa/m, of each

    @property
    def radius(self):
        """Of a sphere that presses a plane as both press each other."""
        return 1.0 / (1.0 / self.index_radius + 1.0 / self.thumb_radius)


def of_blocks(values, combine=np.mean):
    """The value of all and the standard deviation of it, by blocks in time."""
    blocks = [combine(block) for block in np.array_split(values, BLOCKS)]
    return Judgement(float(combine(values)), float(np.std(blocks, ddof=1) / np.sqrt(BLOCKS)))


def weight(record):
    """kg/m^2: of a sample that hangs from the fingertips alone."""
    carried, deviation = of_blocks(-record.sums[:, 2])
    return Judgement(carried / (GRAVITY * AREA), deviation / (GRAVITY * AREA))


def friction(record, begin=0.006):
    """Coefficient: friction of both fingers, which face each other along x and slide along z, over what
    they press with. @param begin m of the way, before which the fabric may stick"""
    way = np.abs(record.places[:, 2] - record.places[0, 2])
    slides = way > begin
    if slides.sum() < 100:
        raise ValueError(f'the fingers slide for {slides.sum()} samples: allowed are 100 or more')
    pairs = np.column_stack([record.sums[slides, 2],
                             np.abs(record.forces[slides, :, 0]).sum(axis=1)])
    return of_blocks(pairs, lambda part: abs(part[:, 0].mean()) / part[:, 1].mean())


def pinch_force(gap, thickness, compressed, fingertips):
    """N, of two spheres whose surfaces are the gap (m) apart with fabric in between whose thickness falls
    by `compressed` (p / 50 gf/cm^2)^EXPONENT under the pressure p, with the pulps in series. Each ring of
    the contact has the pressure of its gap: F = 2 pi R integral of p over the gap."""
    pressures = KES_PRESSURE * np.linspace(0.0, 1.0, 400) ** 2 * 4.0
    shares = pressures / KES_PRESSURE
    gaps = thickness - compressed * shares ** EXPONENT - 2.0 * pressures / fingertips.pulp_stiffness
    integral = (compressed * EXPONENT / (EXPONENT + 1.0) * KES_PRESSURE * shares ** (EXPONENT + 1.0)
                + pressures ** 2 / fingertips.pulp_stiffness)
    forces = 2.0 * np.pi * fingertips.radius * integral
    return np.interp(gap, gaps[::-1], forces[::-1], right=0.0)


def compression(record, fingertips, pinch_seconds):
    """Thickness without pressure, thickness under 50 gf/cm^2 (m) and compressibility (T0 - Tm) / T0: means
    over pinches of pinch_seconds each. The first force that both fingers feel is felt at T0; then the fabric
    is the one whose pinch_force() is that of the record."""
    apart = record.positions[:, 0] - record.positions[:, 1]
    distance = np.linalg.norm(apart, axis=1)
    along = apart / distance[:, None]
    gap = distance - fingertips.index_radius - fingertips.thumb_radius
    # What one finger feels alone pushes the fabric aside.
    force = np.minimum(np.einsum('ni,ni->n', record.forces[:, 0], along),
                       -np.einsum('ni,ni->n', record.forces[:, 1], along))
    if force.max() < 0.02:
        raise ValueError(f'the pinch presses with up to {force.max() + 0.0:.3g} N: allowed are 0.02 N or more')
    numbers = np.floor((record.times - record.times[0]) / pinch_seconds)
    pinches = [judge_pinch(gap[numbers == number], force[numbers == number], fingertips)
               for number in np.unique(numbers)]
    return [Judgement(float(value), float(deviation)) for value, deviation in
            zip(np.mean(pinches, axis=0),
                np.std(pinches, axis=0, ddof=min(1, len(pinches) - 1)) / np.sqrt(len(pinches)))]


def judge_pinch(gap, force, fingertips):
    """T0, Tm and (T0 - Tm) / T0 of samples of a pinch, while it closes."""
    closed = int(np.argmin(gap)) + 1
    pressed = force[:closed] > FIRST_FORCE
    gap, force = gap[:closed][pressed], force[:closed][pressed]
    thick = gap.max(initial=0.0)
    if thick <= 0.0:
        raise ValueError(f'the first force is felt at a gap of {thick:.3g} m: allowed are > 0')
    def residual(compressed):
        return np.sqrt(pinch_force(gap, thick, compressed[0], fingertips)) - np.sqrt(force)
    compressed = least_squares(residual, (0.2 * thick,), x_scale=(1e-4,),
                               bounds=((0.0,), (thick,))).x[0]
    return thick, thick - compressed, compressed / thick
