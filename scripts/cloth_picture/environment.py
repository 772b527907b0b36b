"""What lights a picture: radiance from all around, of a computed sky or of a picture, and its sun.

A map is linear red, green and blue by elevation (rows, from the zenith down) and azimuth (columns, from
+x over +y), in the world frame."""
import re

import numpy as np

from bag_report.bags import Refused

ROWS, COLUMNS = 128, 256  # of a computed map, and at most of one that light is gathered from
SUN_ELEVATION, SUN_AZIMUTH = np.radians([42.0, -42.0])
SUN_WIDTH = 0.04  # of its distance: softens shadows as a thin haze does
SUN_SHARE = 0.66  # of the light of a computed sky on what faces the sun
SUN_COLOUR = np.array([1.0, 0.93, 0.82])
ZENITH, HORIZON = np.array([0.52, 0.66, 0.90]), np.array([0.92, 0.96, 1.0])
EXPOSED = 1.2  # what a white surface shows that faces the sky's brightest half
LARGEST = 8192  # pixels along a side of a .hdr
SUN_CUT = 12.0  # times the mean: what is brighter is taken out of a map and shines as a sun
SUN_LEAST = 0.08  # of all light: less is no sun


class Environment:
    """radiance of the map, and the sun: direction to it, and its light on what faces it (as radiance of
    a white surface); none if it does not shine."""

    def __init__(self, radiance, sun, sunlight):
        self.radiance, self.sun, self.sunlight = radiance, sun, sunlight


def directions(rows, columns):
    """(row, column, 3) unit vectors to the middles of the pixels, and their solid angles (row, 1)."""
    elevation = 0.5 * np.pi - (np.arange(rows) + 0.5) * np.pi / rows
    azimuth = (np.arange(columns) + 0.5) * 2.0 * np.pi / columns
    across = np.cos(elevation)[:, None]
    vectors = np.stack([across * np.cos(azimuth), across * np.sin(azimuth),
                        np.broadcast_to(np.sin(elevation)[:, None], (rows, columns))], axis=-1)
    return vectors, across * (np.pi / rows) * (2.0 * np.pi / columns)


def light_on(radiance, normal):
    """Radiance that a white surface would show: the integral over its half of the map, over pi."""
    vectors, angles = directions(*radiance.shape[:2])
    weights = np.clip(vectors @ normal, 0.0, None) * angles / np.pi
    return np.einsum('rc,rcx->x', weights, radiance)


def exposed(radiance, sun, sunlight):
    """So bright that a white surface that looks up and to the sun shows EXPOSED."""
    facing = np.array([0.0, 0.0, 1.0]) if sun is None else sun
    light = light_on(radiance, facing) + (0.0 if sun is None else sunlight)
    brightness = float(light.mean())
    if not brightness > 0.0:
        raise Refused('the environment has no light')
    scale = EXPOSED / brightness
    return Environment(scale * radiance, sun, None if sun is None else scale * sunlight)


def computed_sky():
    """A clear sky with haze: the gradation of a CIE standard general sky of type 12 (CIE S 011/E:2003) without
    the ring around its sun, which is a light of its own here; blue at the zenith and pale at the horizon."""
    vectors, _ = directions(ROWS, COLUMNS)
    height = np.clip(vectors[..., 2], 0.0, 1.0)
    gradation = 1.0 - np.exp(-0.32 / np.maximum(height, 0.02))
    sun = np.array([np.cos(SUN_ELEVATION) * np.cos(SUN_AZIMUTH),
                    np.cos(SUN_ELEVATION) * np.sin(SUN_AZIMUTH), np.sin(SUN_ELEVATION)])
    angle = np.arccos(np.clip(vectors @ sun, -1.0, 1.0))
    indicatrix = 1.0 + 10.0 * (np.exp(-3.0 * np.maximum(angle, 0.35)) - np.exp(-1.5 * np.pi)) \
        + 0.45 * np.cos(angle) ** 2
    blueness = np.sqrt(height)[..., None]
    colour = (1.0 - blueness) * HORIZON + blueness * ZENITH
    radiance = (gradation * indicatrix)[..., None] * colour
    horizon = radiance[ROWS // 2 - 1].copy()
    radiance[ROWS // 2:] = 0.3 * horizon.mean(axis=0)  # ground
    radiance[ROWS // 2:ROWS // 2 + 2] = horizon  # which POV-Ray would mix with the sky above
    sky = light_on(radiance, sun).mean()
    return exposed(radiance, sun, SUN_SHARE / (1.0 - SUN_SHARE) * sky * SUN_COLOUR / SUN_COLOUR.mean())


def run_lengths(data, place, width):
    """One row of an .hdr as Radiance packs it: the four components one after the other."""
    row = np.empty((4, width), dtype=np.uint8)
    for component in range(4):
        filled = 0
        while filled < width:
            count = data[place]
            place += 1
            run = count > 128
            count -= 128 if run else 0
            if count == 0 or filled + count > width:
                raise ValueError('a run of pixels is longer than its row')
            row[component, filled:filled + count] = data[place] if run \
                else np.frombuffer(data, np.uint8, count, place)
            place += 1 if run else count
            filled += count
    return row.T, place


def read_hdr(path):
    """Radiance of a picture of Radiance's format (RGBE), all around: twice as wide as high.
    @throws Refused naming the file and what it is instead"""
    allowed = f'{path}: allowed are .hdr files (Radiance RGBE, 32-bit_rle_rgbe) twice as wide as high'
    try:
        with open(path, 'rb') as file:
            data = file.read()
    except OSError as error:
        raise Refused(f'{path}: cannot be read ({error.strerror})') from error
    header = re.match(rb'#\?(?:RADIANCE|RGBE)\n(.*?)\n\n-Y (\d+) \+X (\d+)\n', data, re.DOTALL)
    if not header or b'FORMAT=32-bit_rle_rgbe' not in header.group(1):
        raise Refused(f'{allowed}; this is none, or not upright')
    rows, columns = int(header.group(2)), int(header.group(3))
    if columns != 2 * rows or not 8 <= rows <= LARGEST:
        raise Refused(f'{allowed}, 8 to {LARGEST} rows; this has {columns} x {rows} pixels')
    place, pixels = header.end(), np.empty((rows, columns, 4), dtype=np.uint8)
    try:
        if data[place:place + 4] == bytes((2, 2, columns >> 8, columns & 255)):
            for row in range(rows):
                pixels[row], place = run_lengths(data, place + 4, columns)
        else:
            pixels[:] = np.frombuffer(data, np.uint8, pixels.size, place).reshape(pixels.shape)
    except (ValueError, IndexError) as error:
        raise Refused(f'{path}: the .hdr is damaged or cut off ({error})') from error
    exponent = pixels[..., 3:].astype(int)
    return np.where(exponent > 0, np.ldexp(pixels[..., :3] + 0.5, exponent - 136), 0.0)


def averaged(radiance, rows):
    """With at most so many rows, each pixel the mean of those it takes the place of."""
    step = -(-radiance.shape[0] // rows)
    while radiance.shape[0] % step:
        step += 1
    shape = radiance.shape[0] // step, step, radiance.shape[1] // step, step, 3
    return radiance.reshape(shape).mean(axis=(1, 3))


def panorama(radiance):
    """A map as a picture, or such a picture as a map: that turns to the right, azimuth to the left, and its middle is
    what one looks at."""
    return np.roll(radiance[:, ::-1], radiance.shape[1] // 2, axis=1)


def environment_of(path):
    """What a picture shows all around, its middle column where +x is. What of it is as bright as the sun becomes
    one. @throws Refused, see read_hdr(), and if it is black"""
    radiance = panorama(averaged(read_hdr(path), 2 * ROWS))
    vectors, angles = directions(*radiance.shape[:2])
    brightness = radiance.mean(axis=2)
    mean = float((brightness * angles).sum() / (4.0 * np.pi))
    if not mean > 0.0:
        raise Refused(f'{path}: the picture is black: it lights nothing')
    kept = radiance * np.minimum(1.0, SUN_CUT * mean / np.maximum(brightness, 1e-30))[..., None]
    taken = radiance - kept
    amounts = taken.mean(axis=2) * angles
    if amounts.sum() < SUN_LEAST * 4.0 * np.pi * mean:
        return exposed(radiance, None, None)
    brightest = vectors[np.unravel_index(amounts.argmax(), amounts.shape)]
    near = (vectors @ brightest > np.cos(0.3)) * amounts
    direction = np.einsum('rc,rcx->x', near, vectors)
    sunlight = np.einsum('rc,rcx->x', angles * np.ones(brightness.shape), taken) / np.pi
    return exposed(kept, direction / np.linalg.norm(direction), sunlight)


def write_hdr(radiance, path):
    """As POV-Ray reads it: unpacked RGBE, for a sphere of which z is up."""
    largest = np.maximum(radiance.max(axis=2), 1e-30)
    mantissa, exponent = np.frexp(largest)
    pixels = np.empty((*radiance.shape[:2], 4), dtype=np.uint8)
    pixels[..., :3] = radiance * (mantissa * 256.0 / largest)[..., None]
    pixels[..., 3] = np.where(largest > 1e-30, np.clip(exponent + 128, 0, 255), 0)
    with open(path, 'wb') as file:
        file.write(b'#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n' % radiance.shape[:2])
        file.write(pixels.tobytes())
