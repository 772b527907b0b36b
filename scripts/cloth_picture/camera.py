"""From where a picture is taken."""
import numpy as np

ANGLE = np.radians(28.0)  # from the left to the right edge
AZIMUTH = np.radians(24.0)  # to the left of the one who looks along +x
STEEP, FLAT = np.radians([34.0, 9.0])  # elevations for what lies and for what hangs
MARGIN = 1.08  # of what must be seen


class Camera:
    def __init__(self, eye, target, angle=ANGLE):
        self.eye, self.target, self.angle = np.asarray(eye, float), np.asarray(target, float), angle

    def axes(self):
        """Rows: to the right, up, and forward."""
        forward = self.target - self.eye
        forward /= np.linalg.norm(forward)
        right = np.cross(forward, [0.0, 0.0, 1.0])
        right /= np.linalg.norm(right)
        return np.array([right, np.cross(right, forward), forward])

    def pixel(self, places, width):
        """m, how wide a pixel is at each place, of a picture of so many pixels' width."""
        depth = (places - self.eye) @ self.axes()[2]
        return 2.0 * np.tan(0.5 * self.angle) / width * np.maximum(depth, 1e-3)


def framing(places, size):
    """From before (+x) and a little to the left, the higher the flatter things lie, so far away that all
    places are seen. @param size pixels"""
    extent = np.ptp(places, axis=0)
    upright = np.clip(extent[2] / max(extent[:2].max(), 1e-9), 0.0, 1.0)
    elevation = STEEP + (FLAT - STEEP) * upright
    backward = np.array([np.cos(elevation) * np.cos(AZIMUTH), np.cos(elevation) * np.sin(AZIMUTH),
                         np.sin(elevation)])
    camera = Camera(backward, np.zeros(3))
    local = places @ camera.axes().T
    across = np.tan(0.5 * ANGLE) / MARGIN
    slopes = np.array([across, across * size[1] / size[0]])
    # Each edge of the picture is a plane through the eye: the nearest eye before all of them.
    low, high = local[:, :2] + slopes * local[:, 2:], local[:, :2] - slopes * local[:, 2:]
    middle = 0.5 * (low.min(axis=0) + high.max(axis=0))
    depth = np.min(0.5 * (low.min(axis=0) - high.max(axis=0)) / slopes)
    eye = camera.axes().T @ np.array([*middle, depth])
    target = eye - backward * max(1e-6, np.median(local[:, 2]) - depth)
    return Camera(eye, target)
