"""Which place of a surface is seen at the places of a picture's pixels."""
import numpy as np

NEAREST = 1e-3  # m, from the eye


class Seen:
    """Places of a surface: their pixels, triangles and the weights of the triangles' corners."""

    def __init__(self, size, pixel, triangle, weights):
        self.size, self.pixel, self.triangle, self.weights = size, pixel, triangle, weights

    def mean(self, corners):
        """Of each place. @param corners (place, corner, ...) values"""
        return np.einsum('pc,pc...->p...', self.weights, corners)

    def by_pixel(self, values):
        """(row, column, ...): mean of those of a pixel, 0 where there are none. @param values (place, ...)"""
        count = np.bincount(self.pixel, minlength=self.size[0] * self.size[1])
        sums = np.stack([np.bincount(self.pixel, column, len(count)) for column in values.T], axis=-1)
        return (sums / np.maximum(count, 1)[:, None]).reshape(self.size[1], self.size[0], -1)


def seen(surface, camera, size, side):
    """@param size pixels @param side places along a side of a pixel"""
    columns, rows = side * size[0], side * size[1]
    local = (surface.positions - camera.eye) @ camera.axes().T
    depth = np.maximum(local[:, 2], NEAREST)
    scale = 0.5 * columns / np.tan(0.5 * camera.angle)
    across = 0.5 * columns + scale * local[:, 0] / depth
    down = 0.5 * rows - scale * local[:, 1] / depth
    nearness = np.zeros((rows, columns))  # 1/m, of what is seen so far
    triangle = np.full((rows, columns), -1)
    weights = np.zeros((rows, columns, 3))
    for number, corners in enumerate(surface.triangles):
        if local[corners, 2].min() < NEAREST:
            continue
        x, y, inverse = across[corners], down[corners], 1.0 / depth[corners]
        # Places are in the middles of their parts of a pixel.
        first = np.maximum(np.ceil([x.min() - 0.5, y.min() - 0.5]), 0).astype(int)
        last = np.minimum(np.floor([x.max() - 0.5, y.max() - 0.5]), [columns - 1, rows - 1]).astype(int)
        area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])
        if (last < first).any() or area == 0.0:
            continue
        u = np.arange(first[0], last[0] + 1)[None, :] + 0.5
        v = np.arange(first[1], last[1] + 1)[:, None] + 0.5
        second = ((u - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (v - y[0])) / area
        third = ((x[1] - x[0]) * (v - y[0]) - (u - x[0]) * (y[1] - y[0])) / area
        flat = np.stack([1.0 - second - third, second, third], axis=-1)
        near = flat @ inverse
        window = slice(first[1], last[1] + 1), slice(first[0], last[0] + 1)
        nearer = (flat.min(axis=-1) >= 0.0) & (near > nearness[window])
        nearness[window][nearer] = near[nearer]
        triangle[window][nearer] = number
        weights[window][nearer] = (flat * inverse / near[..., None])[nearer]
    row, column = np.nonzero(triangle >= 0)
    return Seen(size, (row // side) * size[0] + column // side, triangle[row, column], weights[row, column])
