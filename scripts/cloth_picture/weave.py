"""The yarns of a fabric as textures: what fabric_relief says of its surface, in the colours of its look."""
import pathlib
import re
import subprocess
import tempfile

import numpy as np
import roslib.packages
from matplotlib.image import imread

from bag_report.bags import Refused

from .looks import Look
from .povray import finish_of, matrix_of, plain_texture

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


def netpbm(samples):
    """A picture of 16 bits without gamma. @param samples 0 to 1, with or without colours"""
    kind = b'P6' if samples.ndim == 3 else b'P5'
    return kind + b'\n%d %d\n65535\n' % samples.shape[1::-1] + np.round(65535.0 * samples).astype('>u2').tobytes()


class Weave:
    """How a fabric looks from some distance."""

    def __init__(self, fabric, relief, pixel):
        """@param pixel m, how wide one is on the cloth"""
        self.look = fabric.look
        seen = None if relief is None else relief.seen(pixel)
        share = 0.5 if relief is None else float(relief.warp.mean())
        self.colour = share * self.look.warp + (1.0 - share) * self.look.weft
        spread = 0.0 if seen is None else float(seen.warp.std()) * np.abs(self.look.warp - self.look.weft).max()
        self.relief = seen if seen is not None and (seen.slopes() > LEAST_SLOPE or spread > LEAST_COLOUR) else None

    def plain(self):
        return plain_texture(Look(self.colour, self.look.gloss, self.look.width))

    def files(self, name):
        """Pictures that declaration() names."""
        if self.relief is None:
            return {}
        heights, warp = self.relief.heights, self.relief.warp[..., None]
        lifted = (heights - heights.min()) / max(np.ptp(heights), 1e-12)
        colours = warp * self.look.warp + (1.0 - warp) * self.look.weft
        return {f'{name}.pgm': netpbm(lifted), f'{name}.ppm': netpbm(colours)}

    def declaration(self, name):
        """A texture in whose plane z = 0 the piece is the unit square. A step of the picture is 1 / SIDE there, a
        unit along z the geometric mean of the piece's sides: texture_of()."""
        bump = np.ptp(self.relief.heights) * SIDE / np.sqrt(self.relief.size.prod())
        return (f'#declare {name} = texture {{ pigment {{ image_map {{ ppm "{name}.ppm" gamma 1.0 interpolate 2 }} }} '
                f'normal {{ bump_map {{ pgm "{name}.pgm" gamma 1.0 interpolate 2 bump_size {bump:.6g} }} }} '
                f'{finish_of(self.look)} }}\n')

    def textures(self, name, positions, rest):
        """Of every triangle: the declared texture where its rest coordinates are.
        @param positions, rest m, (triangle, corner, 3) and (triangle, corner, 2)"""
        sides, flat = positions[:, 1:] - positions[:, :1], rest[:, 1:] - rest[:, :1]
        # Rows of a triangle's axes: images of the unit vectors along weft and warp.
        axes = np.linalg.solve(flat, sides)
        origins = positions[:, 0] - np.einsum('tr,trx->tx', rest[:, 0], axes)
        # POV-Ray's bumps are right as seen from the negative side of z, from where its pictures are not mirrored.
        normals = np.cross(axes[:, 1], axes[:, 0])
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
        size = self.relief.size
        rows = np.stack([size[0] * axes[:, 0], size[1] * axes[:, 1], np.sqrt(size.prod()) * normals, origins], axis=1)
        return [f'texture {{ {name} {matrix_of(row)} }}' for row in rows]
