"""Where in the path of a demo the fingers hold the cloth."""
import math
from typing import NamedTuple

import yaml

FINGERTIPS = 0.0075 + 0.009  # m, radii of index and thumb
# N, how hard the path pinches in each phase: comments of config/paths/demo.yaml.
PINCHES = {'pinch': 1.0, 'lift': 2.2, 'stretch': 2.2, 'slide': 0.3, 'rub': 0.5}


class Hold(NamedTuple):
    """From begin to end (s since the phase began) the targets of the fingers rest, so near to each
    other that the fingertips press with `pinch` (N)."""
    phase: str
    begin: float
    end: float
    pinch: float


def load_holds(path):
    with open(path, encoding='utf-8') as file:
        return holds_of(yaml.safe_load(file)['key_frames'])


def holds_of(key_frames):
    holds, phase, phase_begin = [], None, 0.0
    for first, second in zip(key_frames, key_frames[1:]):
        if 'phase' in first:
            phase, phase_begin = first['phase'], first['time']
        if not (presses(first) and rests(first, second)):
            continue
        begin, end = first['time'] - phase_begin, second['time'] - phase_begin
        if holds and holds[-1].phase == phase and holds[-1].end == begin:
            holds[-1] = holds[-1]._replace(end=end)
        else:
            holds.append(Hold(phase, begin, end, PINCHES[phase]))
    return holds


def presses(key_frame):
    return math.dist(key_frame['index'], key_frame['thumb']) < FINGERTIPS


def rests(first, second):
    """Whether the fingers do; the hand may move."""
    return first['index'] == second['index'] and first['thumb'] == second['thumb']
