"""Whether a demo did what its path asks for, and how well: without ROS, from series of its bag."""
from typing import NamedTuple

import numpy as np

from .series import FINGERS, runs

DIP_SHARE = 0.8  # of the median of a hold: what is felt less is a dip
SHORTEST_DIP = 0.005  # s
LOST_SHARE = 0.5  # of what the path presses with: who feels less does not hold
# s: cloth that is let go falls by the radius of a fingertip (7.5 mm) meanwhile, out of the pinch.
LONGEST_LOSS = 0.039
LONGEST_SILENCE = 0.020  # s: after it the driver has ended its force


class Spell(NamedTuple):
    """A finger felt too little from begin (s since the epoch) for a length (s)."""
    phase: str
    finger: str
    begin: float
    length: float


class Judgement(NamedTuple):
    held: dict  # phases with a hold: whether the pinch was kept
    medians: dict  # N felt, by (phase, finger)
    dips: list  # spells below DIP_SHARE
    failures: list  # sentences; none: the demo did what it was asked to

    def longest_dip(self):
        """s, 0 without any."""
        return max((dip.length for dip in self.dips), default=0.0)


def spells_below(times, values, bound):
    """(begin, length) of every run of values below a bound, until the next that is not, or until
    the last time."""
    last = len(times) - 1
    return [(times[first], times[min(after, last)] - times[first])
            for first, after in runs(np.asarray(values) < bound)]


def judge(demo, holds):
    """@param demo: a Recording, or what has begins, felt, contact, operating and dropped of one"""
    held, medians, dips, failures = {}, {}, [], []
    for hold in holds:
        losses = []
        for finger in FINGERS:
            times, forces = felt_in(demo, hold, finger)
            if len(times) < 2:
                losses.append(Spell(hold.phase, finger, demo.begins[hold.phase] + hold.begin,
                                    hold.end - hold.begin))
                continue
            medians[hold.phase, finger] = np.median(forces)
            losses += [Spell(hold.phase, finger, *spell)
                       for spell in spells_below(times, forces, LOST_SHARE * hold.pinch)
                       if spell[1] > LONGEST_LOSS]
            dips += [Spell(hold.phase, finger, *spell)
                     for spell in spells_below(times, forces,
                                               DIP_SHARE * medians[hold.phase, finger])
                     if spell[1] > SHORTEST_DIP]
        held[hold.phase] = not losses
        failures += lost_pinches(hold, losses)
        failures += dipping_holds(hold, dips)
    failures += silences(demo, holds)
    failures += dropped_cloth(demo)
    failures += latched_faults(demo)
    return Judgement(held, medians, dips, failures)


def felt_in(demo, hold, finger):
    """Times (s since the epoch) and norms (N) of what a finger felt in a hold."""
    begin = demo.begins[hold.phase]
    within = demo.felt[finger].within(begin + hold.begin, begin + hold.end)
    forces = np.array(demo.felt[finger].values[within]).reshape(-1, 3)
    return demo.felt[finger].times[within], np.linalg.norm(forces, axis=1)


def lost_pinches(hold, losses):
    for finger in FINGERS:
        lengths = [loss.length for loss in losses if loss.finger == finger]
        if lengths:
            yield (f'{hold.phase}: pinch lost, the {finger} felt less than '
                   f'{LOST_SHARE * hold.pinch:.2f} N for {sum(lengths):.2f} s of '
                   f'{hold.end - hold.begin:.1f} s')


def dipping_holds(hold, dips):
    for finger in FINGERS:
        lengths = [1e3 * dip.length for dip in dips
                   if (dip.phase, dip.finger) == (hold.phase, finger)]
        if lengths:
            yield (f'{hold.phase}: the hold of the {finger} dips {len(lengths)} times, for '
                   f'{max(lengths):.1f} ms at most')


def silences(demo, holds):
    """Of the force loop, while the fingers hold."""
    for hold in holds:
        begin = demo.begins[hold.phase]
        for finger in FINGERS:
            contact = demo.contact[finger]
            heard = contact.times[contact.within(begin + hold.begin, begin + hold.end)]
            gap = np.diff([begin + hold.begin, *heard, begin + hold.end]).max()
            if gap > LONGEST_SILENCE:
                yield (f'{hold.phase}: force loop silent, no force for the {finger} for '
                       f'{1e3 * gap:.0f} ms')


def dropped_cloth(demo):
    """In the whole demo."""
    dropped = max(demo.dropped.values, default=0.0)
    if dropped > 0.0:
        yield f'cloth dropped, {dropped:.3f} s of simulated time'


def latched_faults(demo):
    """Since the forces were on for the first time; also those that were cleared."""
    was_enabled, latched = False, False
    for state, fault in demo.operating.values:
        if was_enabled and state == 'FAULT' and not latched:
            yield f'latched fault: {fault}'
        was_enabled |= state == 'ENABLED'
        latched = state == 'FAULT'
