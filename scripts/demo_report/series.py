"""Values against time, and the names of what a demo is made of."""
import numpy as np

PHASES = ['approach', 'pinch', 'lift', 'stretch', 'slide', 'release', 'rub', 'retreat']
WITH_CONTACT = ['pinch', 'lift', 'stretch', 'slide', 'rub']
FINGERS = ['index', 'thumb']


def runs(flags):
    """(first, after) of every run of places where the flag is set."""
    changes = np.flatnonzero(np.diff(np.concatenate([[0], np.asarray(flags, int), [0]])))
    return list(zip(changes[::2], changes[1::2]))


class Series:
    """Times (s since the epoch, of the headers) and values of the messages of a topic."""

    def __init__(self, times=(), values=()):
        self.times, self.values = list(times), list(values)

    def add(self, time, value):
        self.times.append(time)
        self.values.append(value)

    def close(self):
        """To be called after the last add()."""
        self.times = np.array(self.times)

    def within(self, begin, end):
        """Indices of begin <= time < end."""
        return slice(*np.searchsorted(self.times, [begin, end]))

    def between(self, begin, end):
        """Values of begin <= time < end, as an array."""
        return np.array(self.values[self.within(begin, end)])

    def rate(self):
        """Mean, Hz."""
        return (len(self.times) - 1) / (self.times[-1] - self.times[0])
