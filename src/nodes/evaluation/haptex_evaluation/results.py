"""A line of CSV per answered trial, on the disk before the answer is acknowledged."""
import csv
import fcntl
import io
import math
import os
import pathlib
import re
from typing import NamedTuple

from .protocol import PROPERTIES, REAL, VIRTUAL
from .quoted import quoted


class Result(NamedTuple):
    """The columns of the file; `header` adds the units."""
    who: str
    subject: int
    trial: int
    property: str
    sample: str  # virtual or real
    fabric: str
    code: str
    position: int
    rating: float
    began: float  # s since 1970
    answered: float  # s since 1970
    with_picture: bool
    bag: str  # name of the file beside the CSV


def header(scale):
    """@param scale least and largest rating"""
    units = {'rating': f' ({scale[0]:g} to {scale[1]:g})', 'began': ' (s since 1970)',
             'answered': ' (s since 1970)'}
    return [name + units.get(name, '') for name in Result._fields]


def _line(cells):
    text = io.StringIO()
    csv.writer(text, lineterminator='\n').writerow(cells)
    return text.getvalue()


def _cells(result):
    return [str(value).lower() if isinstance(value, bool) else
            f'{value:.3f}' if name in ('began', 'answered') else
            repr(value) if isinstance(value, float) else value
            for name, value in zip(Result._fields, result)]


def _finite(text):
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f'{text} is not finite')
    return value


def _named(*allowed):
    def read(text):
        if text not in allowed:
            raise ValueError(f'{quoted(text)} is not allowed, allowed are {", ".join(allowed)}')
        return text
    return read


_READERS = {'subject': int, 'trial': int, 'position': int, 'rating': _finite, 'began': _finite,
            'answered': _finite, 'property': _named(*PROPERTIES), 'sample': _named(VIRTUAL, REAL),
            'with_picture': lambda text: _named('true', 'false')(text) == 'true'}


def _result(cells, where):
    if len(cells) != len(Result._fields):
        raise ValueError(f'{where}: {len(cells)} cells, must be {len(Result._fields)}')
    values = []
    for name, cell in zip(Result._fields, cells):
        try:
            values.append(_READERS.get(name, str)(cell))
        except ValueError as error:
            raise ValueError(f'{where}: {name}: {error}') from error
    return Result(*values)


def read_results(path):
    """@returns the results of a file and the scale of its ratings
    @throws ValueError naming file, line, column and what is allowed"""
    try:
        with open(path, encoding='utf-8', newline='') as file:
            lines = list(csv.reader(file))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise ValueError(f'{path}: {error}') from error
    names = [re.sub(r' \(.*\)$', '', name) for name in lines[0]] if lines else []
    if names != list(Result._fields):
        raise ValueError(f'{path}: the columns are {", ".join(names) or "none"}, must be '
                         f'{", ".join(Result._fields)}')
    column = lines[0][names.index('rating')]
    scale = re.fullmatch(r'rating \((\S+) to (\S+)\)', column)
    if not scale:
        raise ValueError(f'{path}: {quoted(column)} must say the scale, as in "rating (1 to 10)"')
    scale = tuple(map(float, scale.groups()))
    results = [_result(cells, f'{path}: line {i}') for i, cells in enumerate(lines[1:], 2)]
    for i, result in enumerate(results, 2):
        if not scale[0] <= result.rating <= scale[1]:
            raise ValueError(f'{path}: line {i}: rating {result.rating:g} must be from {scale[0]:g} to '
                             f'{scale[1]:g}')
    return results, scale


class ResultFile:
    """Of one session. While it is open no other process writes it."""

    def __init__(self, path, scale, warn):
        """A line that a process died over is dropped. @param warn is told so, by a text
        @throws ValueError if another process writes the file or it is of another kind"""
        self.path = pathlib.Path(path)
        self._file = open(self.path, 'a+b', buffering=0)  # what cannot be written must not come later
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            self._file.close()
            raise ValueError(f'{path}: another process writes it') from error
        try:
            self._drop_torn_line(warn)
            if self._file.tell() == 0:
                self._write(_line(header(scale)))
                self._sync_directory()
            self.results, found = read_results(self.path)
            if found != tuple(map(float, scale)):
                raise ValueError(f'{path}: the ratings are {found[0]:g} to {found[1]:g}, those of the '
                                 f'protocol {scale[0]:g} to {scale[1]:g}')
        except ValueError:
            self._file.close()
            raise

    def _drop_torn_line(self, warn):
        self._file.seek(0)
        content = self._file.read()
        end = content.rfind(b'\n') + 1
        if end < len(content):
            warn(f'{self.path}: its last line is not complete and is dropped: {quoted(content[end:])}')
            self._file.truncate(end)
            os.fsync(self._file.fileno())
        self._file.seek(0, os.SEEK_END)

    def _write(self, text):
        """All of it, or nothing where the disk is full."""
        size, left = os.fstat(self._file.fileno()).st_size, text.encode('utf-8')
        try:
            while left:
                left = left[self._file.write(left):]
            os.fsync(self._file.fileno())
        except OSError:
            self._file.truncate(size)
            raise

    def _sync_directory(self):
        directory = os.open(self.path.parent, os.O_RDONLY)
        try:
            os.fsync(directory)
        finally:
            os.close(directory)

    def add(self, result):
        """Returns when the line is on the disk. @throws OSError if it is not: then nothing of it is"""
        self._write(_line(_cells(result)))
        self.results.append(result)

    def close(self):
        self._file.close()
