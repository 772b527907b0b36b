"""A session of one person: where it is, what it takes, and how it goes on after it was killed. No ROS."""
import csv
import io
import math
import os
import pathlib
import threading

from .plan import TRIAL, stages_of, trials_of
from .quoted import quoted
from .results import Result, ResultFile

LONGEST_NAME = 80


def _write_whole(path, text):
    """Either all of it is there, or nothing."""
    part = path.with_name(path.name + '.part')
    with open(part, 'w', encoding='utf-8') as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    part.replace(path)


def _keep(path, text, what):
    """Writes a file that has to say the same when the session goes on."""
    if not path.exists():
        _write_whole(path, text)
    elif path.read_text(encoding='utf-8') != text:
        raise ValueError(f'{path} is of another {what}: go on with that one, or name another directory')


class Session:
    """Its directory holds results.csv, the protocol, samples.csv, which tells the experimenter what
    the codes mean, and the bags. Times are s; a clock that jumps changes seconds_left() only by as
    much. All functions may be called by several threads."""

    def __init__(self, directory, protocol, protocol_text, who, subject, warn):
        """@param protocol_text of the file that `protocol` was read from @param who the person, a
        name or a code @param subject from 1 @param warn is told by a text what was dropped
        @throws ValueError if the directory is of another protocol, person or subject, or in use"""
        who = who.strip()
        if not who or len(who) > LONGEST_NAME or not who.isprintable():
            raise ValueError(f'who: {quoted(who)} must have 1 to {LONGEST_NAME} printable characters')
        self.directory = pathlib.Path(directory)
        self.protocol, self.who, self.subject = protocol, who, subject
        self.trials = trials_of(protocol, subject)
        self.directory.mkdir(parents=True, exist_ok=True)
        _keep(self.directory / 'protocol.yaml', protocol_text, 'protocol')
        _keep(self.directory / 'samples.csv', self._samples_text(), 'subject')
        self._file = ResultFile(self.directory / 'results.csv', protocol.scale, warn)
        try:
            self._check_results()
        except ValueError:
            self._file.close()
            raise
        self._stages = stages_of(self.trials, len(self._file.results))
        self._begun = None  # s; when the present stage did
        self._lock = threading.RLock()

    def _samples_text(self):
        text = io.StringIO()
        writer = csv.writer(text, lineterminator='\n')
        writer.writerow(['trial', 'code', 'property', 'sample', 'fabric'])
        for trial in self.trials:
            writer.writerow([trial.number, trial.code, trial.property.name, trial.sample.kind,
                             trial.sample.fabric])
        return text.getvalue()

    def _check_results(self):
        results = self._file.results
        if len(results) > len(self.trials):
            raise ValueError(f'{self._file.path}: {len(results)} results, the protocol has '
                             f'{len(self.trials)} trials')
        for i, (trial, result) in enumerate(zip(self.trials, results), 2):
            expected = (self.who, self.subject, trial.number, trial.property.name,
                        trial.sample.kind, trial.sample.fabric)
            found = (result.who, result.subject, result.trial, result.property, result.sample,
                     result.fabric)
            if found != expected:
                raise ValueError(f'{self._file.path}: line {i}: {found} must be {expected}')

    def answered(self):
        """The results so far."""
        return list(self._file.results)

    def stage(self):
        """The present one; None: the session is over."""
        with self._lock:
            return self._stages[0] if self._stages else None

    def begin(self, now):
        """The fabric of the present stage is there, and its time runs."""
        with self._lock:
            self._begun = now

    def has_begun(self):
        with self._lock:
            return self._begun is not None

    def seconds_left(self, now):
        """Of the present stage; all of its time before it has begun, 0 afterwards."""
        with self._lock:
            if not self._stages:
                return 0.0
            seconds = self._stages[0].seconds()
            return seconds if self._begun is None else max(0.0, seconds - max(0.0, now - self._begun))

    def end_standard(self):
        """@throws ValueError if the present stage is none: a trial ends by its answer"""
        with self._lock:
            stage = self.stage()
            if stage is None:
                raise ValueError('the session is over')
            if stage.kind == TRIAL:
                raise ValueError(f'trial {stage.trial.number} has to be answered first')
            if self._begun is None:
                raise ValueError('the standard is not there yet')
            self._advance()

    def _advance(self):
        self._stages.pop(0)
        self._begun = None

    def check_answer(self, trial, rating):
        """@throws ValueError unless this trial may be answered so now"""
        with self._lock:
            stage = self.stage()
            if stage is None:
                raise ValueError('the session is over')
            if stage.kind != TRIAL:
                raise ValueError('a standard is shown, there is nothing to answer')
            if trial != stage.trial.number:
                raise ValueError(f'trial: {trial} is not the present one, {stage.trial.number}')
            if self._begun is None:
                raise ValueError(f'trial {trial}: the sample is not there yet')
            least, most = self.protocol.scale
            if not math.isfinite(rating) or not least <= rating <= most:
                raise ValueError(f'rating: {rating:g} must be finite and from {least:g} to {most:g}')

    def answer(self, trial, rating, now, bag):
        """Writes the result and goes on. @param bag name of the trial's bag; empty: none
        @throws ValueError as check_answer()"""
        with self._lock:
            self.check_answer(trial, rating)
            present = self.stage().trial
            self._file.add(Result(self.who, self.subject, present.number, present.property.name,
                                  present.sample.kind, present.sample.fabric, present.code,
                                  present.position, float(rating), self._begun, now,
                                  self.protocol.picture, bag))
            self._advance()

    def bag_path(self):
        """For the present trial: a name that no bag has, complete or not, so that none is lost."""
        number = self.stage().trial.number
        attempt = 1
        while True:
            name = f'trial_{number:02d}.bag' if attempt == 1 else f'trial_{number:02d}_{attempt}.bag'
            path = self.directory / name
            if not any(path.with_name(name + end).exists() for end in ('', '.active')):
                return path
            attempt += 1

    def close(self):
        self._file.close()
