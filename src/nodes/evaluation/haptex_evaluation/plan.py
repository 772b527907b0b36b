"""What a subject meets in which order. The same protocol and subject give the same plan."""
import random
from typing import NamedTuple

from .latin_square import row_of
from .protocol import VIRTUAL, Property, Sample

CODES = range(100, 1000)  # three digits, which say nothing of the fabric
STANDARD, TRIAL = 'STANDARD', 'TRIAL'


class Trial(NamedTuple):
    number: int  # from 1
    property: Property
    sample: Sample
    code: str
    position: int  # among the trials of the property, from 1


class Stage(NamedTuple):
    """A fabric to touch: one of the two standards of a property, or a trial."""
    kind: str  # STANDARD or TRIAL
    property: Property
    sample: Sample
    code: str  # of a standard the word of its end of the scale
    trial: Trial  # None of a standard

    def seconds(self):
        is_trial = self.kind == TRIAL
        return self.property.trial_seconds if is_trial else self.property.standard_seconds


def trials_of(protocol, subject):
    """Properties in the order of a row of their Latin square, and in each the samples in one of
    theirs, which is the next for every property. The subject's number picks the rows.
    @param subject from 1
    @throws ValueError naming another subject, or more trials than there are codes"""
    if isinstance(subject, bool) or not isinstance(subject, int) or subject < 1:
        raise ValueError(f'subject: {subject!r} must be a whole number of at least 1')
    properties, samples = protocol.properties, protocol.samples
    count = len(properties) * len(samples)
    if count > len(CODES):
        raise ValueError(f'{count} trials: at most {len(CODES)} are allowed')
    codes = random.Random(f'{protocol.title}/{subject}').sample(CODES, count)
    trials = []
    for property_index in row_of(len(properties), subject - 1):
        row = row_of(len(samples), subject - 1 + property_index)
        for position, sample_index in enumerate(row, 1):
            trials.append(Trial(len(trials) + 1, properties[property_index], samples[sample_index],
                                str(codes[len(trials)]), position))
    return trials


def stages_of(trials, answered):
    """What is left after so many answered trials. The standards come before the first trial of a
    property, and do not come again where a session goes on within it."""
    stages = []
    for trial in trials[answered:]:
        if trial.position == 1:
            for word, fabric in zip(trial.property.words, trial.property.standards):
                stages.append(Stage(STANDARD, trial.property, Sample(fabric, VIRTUAL), word, None))
        stages.append(Stage(TRIAL, trial.property, trial.sample, trial.code, trial))
    return stages
