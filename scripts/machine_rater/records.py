"""What a device has measured: positions of two fingertips and the forces on them, every millisecond."""
import pathlib

import numpy as np

COLUMNS = 13  # of a file of bench/device_records: time, two positions, two forces
FINGERS = 2  # index and thumb


class DeviceRecord:
    """times (n,) in s, positions and forces (n, finger, axis) in m and N, world."""

    def __init__(self, times, positions, forces):
        self.times = np.asarray(times, float)
        self.positions = np.asarray(positions, float)
        self.forces = np.asarray(forces, float)

    @classmethod
    def read(cls, path):
        data = np.fromfile(pathlib.Path(path), np.float32).astype(float)
        if len(data) == 0 or len(data) % COLUMNS:
            raise ValueError(f'{path}: has {len(data)} numbers, allowed are {COLUMNS} per sample')
        data = data.reshape(-1, COLUMNS)
        return cls(data[:, 0], data[:, 1:7].reshape(-1, FINGERS, 3),
                   data[:, 7:].reshape(-1, FINGERS, 3))

    def limited(self, quantum=0.0, delay=0.0):
        """As a device would have measured it that renders forces in steps (N) and late (s)."""
        places = np.searchsorted(self.times, self.times - delay + 1e-9, side='right') - 1
        forces = self.forces[np.maximum(places, 0)]
        if quantum > 0.0:
            forces = quantum * np.round(forces / quantum)
        return DeviceRecord(self.times, self.positions, forces)

    @property
    def places(self):
        """Middle of both fingertips (n, axis)."""
        return self.positions.mean(axis=1)

    @property
    def sums(self):
        """Force on both fingertips together (n, axis)."""
        return self.forces.sum(axis=1)
