"""The yarns of a fabric as textures: what fabric_relief says of its surface, in the colours of its look; and cloth
that has them."""
import pathlib
import re
import subprocess
import tempfile

import numpy as np
import roslib.packages
from matplotlib.image import imread

from bag_report.bags import Refused

from .looks import Look

SIDE = 256  # samples along the pictures of a piece, whatever its size
BLUR = 0.75  # times the width of a pixel: standard deviation of what a pixel sees
LEAST_SLOPE, LEAST_COLOUR = 0.02, 0.01  # standard deviations that are seen


class Relief:
    """A piece of a fabric, rows from its largest warp coordinate down: heights (m), share of the warp in what is
    seen, and size (m) along weft and warp."""

    def __init__(self, heights, warp, size):
        self.heights, self.warp, self.size = heights, warp, np.asarray(size)

    def seen(self, pixel):
        """As pixels see it that are so wide (m): SIDE x SIDE samples, without what is finer."""
        return Relief(blurred(self.heights, self.size, pixel),
                      np.clip(blurred(self.warp, self.size, pixel), 0.0, 1.0), self.size)

    def slopes(self):
        """Standard deviation over the directions along weft and warp."""
        steps = self.size / self.heights.shape[::-1]
        along = [(np.roll(self.heights, 1, axis) - self.heights) / steps[1 - axis] for axis in (0, 1)]
        return float(np.sqrt(np.mean(np.square(along))))


def blurred(field, size, pixel):
    """Of a field that continues at its opposite edges, by a Gaussian; sampled anew."""
    rows, columns = field.shape
    spectrum = np.fft.fft2(field)
    result = np.zeros((SIDE, SIDE), dtype=complex)
    waves = [np.fft.fftfreq(count, 1.0 / count).astype(int) for count in (rows, columns)]
    kept = [np.abs(wave) < 0.5 * min(count, SIDE) for wave, count in zip(waves, (rows, columns))]
    down, across = (wave[keep] for wave, keep in zip(waves, kept))
    damped = np.exp(-2.0 * (np.pi * BLUR * pixel) ** 2 * ((down[:, None] / size[1]) ** 2 + (across / size[0]) ** 2))
    result[np.ix_(down, across)] = spectrum[np.ix_(kept[0], kept[1])] * damped
    return np.fft.ifft2(result).real * SIDE ** 2 / (rows * columns)


def relief_of(fabric):
    """None of a fabric that does not say how its yarns lie. @throws Refused if its file is not a sound one"""
    if not fabric.has_surface:
        return None
    programs = roslib.packages.find_node('haptex', 'fabric_relief')
    if not programs:
        raise Refused('the program fabric_relief is not built, or not found by rosrun')
    with tempfile.TemporaryDirectory(prefix='haptex_relief_') as name:
        folder = pathlib.Path(name)
        path = fabric.path
        if path is None:
            path = folder / 'fabric.yaml'
            path.write_text(fabric.text, encoding='utf-8')
        run = subprocess.run([programs[0], path.absolute(), folder / 'heights.png', folder / 'yarns.png'],
                             capture_output=True, text=True)
        if run.returncode != 0:
            raise Refused(f'fabric {fabric.name}: {run.stderr.strip()}')
        said = {key: float(value) for key, value in re.findall(r'(\w+): (\S+)', run.stdout)}
        heights, warp = (np.asarray(imread(folder / f'{name}.png'), dtype=float) for name in ('heights', 'yarns'))
    rows, columns = heights.shape
    return Relief(said['height'] * heights, warp, (columns * said['weft_spacing'], rows * said['warp_spacing']))


class Weave:
    """How a fabric looks from some distance."""

    def __init__(self, fabric, relief, pixel):
        """@param pixel m, how wide one is on the cloth"""
        look = fabric.look
        seen = None if relief is None else relief.seen(pixel)
        share = 0.5 if relief is None else float(relief.warp.mean())
        spread = 0.0 if seen is None else float(seen.warp.std()) * np.abs(look.warp - look.weft).max()
        self.fabric = fabric.name
        self.look = look  # of its yarns
        self.even = Look(share * look.warp + (1.0 - share) * look.weft, look.gloss, look.width)  # where none is seen
        self.relief = seen if seen is not None and (seen.slopes() > LEAST_SLOPE or spread > LEAST_COLOUR) else None

    def colours(self):
        """(row, column, 3), linear, of the piece's samples."""
        warp = self.relief.warp[..., None]
        return warp * self.look.warp + (1.0 - warp) * self.look.weft


class Plain:
    """A fabric without yarns."""

    def __init__(self, look):
        self.look = self.even = look
        self.relief = None


class Cloth:
    """surface, which of the weaves each triangle is of, and these."""

    def __init__(self, surface, weave_of, weaves):
        self.surface, self.weave_of, self.weaves = surface, weave_of, weaves

    def matt(self):
        """In the mean colours of its fabrics, without yarns and gloss."""
        return Cloth(self.surface, self.weave_of, [Plain(Look(weave.even.warp)) for weave in self.weaves])

    def has_yarns(self, number):
        """Of the weave's triangles: whether their yarns are seen, and where they lie is known."""
        return self.weaves[number].relief is not None and self.surface.rest is not None

    def axes(self, mine):
        """Of these triangles, (triangle, 2, 3): images of the unit vectors along weft and warp."""
        places, rest = self.surface.positions[self.surface.triangles[mine]], self.surface.rest[mine]
        return np.linalg.solve(rest[:, 1:] - rest[:, :1], places[:, 1:] - places[:, :1])
