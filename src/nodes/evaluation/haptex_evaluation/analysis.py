"""What the ratings of one or several sessions say: tables, and a plot per property."""
import csv
import pathlib
from typing import NamedTuple

import numpy as np

from . import programs
from .kes_values import PROPERTY_UNITS, FabricValues, find_fabric
from .protocol import PROPERTIES, REAL, VIRTUAL
from .results import read_results
from .statistics import bootstrap_interval, concordance, kendall, mean_ranks, spearman

USAGE = 'usage: analyse_evaluation CSV... OUT_DIR\n'
LEAST_PAIRS = 3  # of a rank correlation


class Correlation(NamedTuple):
    """Of the mean ranks of samples with KES values, or of real with virtual samples."""
    between: str
    pairs: int
    rho: float  # Spearman's; None where there are too few pairs or one side is constant
    interval: tuple
    tau: float  # Kendall's, b


class Group(NamedTuple):
    """Everything about a property, with or without the picture."""
    property: str
    with_picture: bool
    samples: list  # (fabric, kind), which every one of the raters has rated
    raters: list
    left_out: list  # raters who have not rated all samples
    ratings: np.ndarray  # of raters and samples
    ranks: np.ndarray  # mean over raters, real and virtual samples ranked together
    kes: list  # value of every sample; None where its file says nothing
    agreement: object  # Concordance; None with fewer than 2 raters or samples, or no differences
    correlations: list


def correlate(between, first, second):
    """Correlation of pairs, of which those with None on a side do not count."""
    pairs = [(a, b) for a, b in zip(first, second) if a is not None and b is not None]
    if len(pairs) >= LEAST_PAIRS:
        x, y = np.array(pairs).T
        if np.ptp(x) > 0.0 and np.ptp(y) > 0.0:
            return Correlation(between, len(pairs), spearman(x, y), bootstrap_interval(spearman, x, y),
                               kendall(x, y))
    return Correlation(between, len(pairs), None, None, None)


def _correlations(samples, ranks, kes):
    of = dict(zip(samples, ranks))
    result = []
    for kind in (VIRTUAL, REAL):
        chosen = [i for i, sample in enumerate(samples) if sample[1] == kind]
        if chosen:
            result.append(correlate(f'KES - {kind}', [kes[i] for i in chosen], ranks[chosen]))
    both = sorted(fabric for fabric, kind in samples
                  if kind == REAL and (fabric, VIRTUAL) in of)
    if both:
        result.append(correlate('real - virtual', [of[fabric, REAL] for fabric in both],
                                [of[fabric, VIRTUAL] for fabric in both]))
    return result


def _rating_table(results):
    """Mean rating by rater and sample: somebody may have rated one twice."""
    table = {}
    for result in results:
        sample = (result.fabric, result.sample)
        table.setdefault(result.who, {}).setdefault(sample, []).append(result.rating)
    return {who: {sample: np.mean(ratings) for sample, ratings in row.items()}
            for who, row in table.items()}


def make_group(name, with_picture, results, values):
    """@param results of one property, all with or all without the picture
    @param values FabricValues by fabric"""
    table = _rating_table(results)
    samples = sorted({sample for row in table.values() for sample in row}, key=lambda s: s[::-1])
    raters = sorted(who for who, row in table.items() if len(row) == len(samples))
    left_out = sorted(set(table) - set(raters))
    ratings = np.array([[table[who][sample] for sample in samples] for who in raters])
    kes = [values[fabric].properties.get(name) for fabric, _ in samples]
    if not raters:
        return Group(name, with_picture, samples, raters, left_out, ratings, None, kes, None, [])
    ranks = mean_ranks(ratings)
    agreement = None
    if min(ratings.shape) >= 2 and np.ptp(ratings, axis=1).any():
        agreement = concordance(ratings)
    return Group(name, with_picture, samples, raters, left_out, ratings, ranks, kes, agreement,
                 _correlations(samples, ranks, kes))


def make_groups(results, values):
    groups = []
    for name in PROPERTIES:
        for with_picture in (True, False):
            chosen = [result for result in results
                      if result.property == name and result.with_picture == with_picture]
            if chosen:
                groups.append(make_group(name, with_picture, chosen, values))
    return groups


def _number(value, digits=3):
    return '' if value is None else f'{value:.{digits}g}'


def _begin(group):
    return [group.property, 'shown' if group.with_picture else 'hidden']


def rank_table(groups):
    rows = [['property', 'picture', 'fabric', 'sample', 'mean rating', 'mean rank', 'KES value',
             'unit and formula of the KES value']]
    for group in groups:
        for i, (fabric, kind) in enumerate(group.samples if group.raters else []):
            rows.append([*_begin(group), fabric, kind, _number(group.ratings[:, i].mean(), 4),
                         _number(group.ranks[i], 4), _number(group.kes[i], 4),
                         PROPERTY_UNITS[group.property]])
    return rows


def correlation_table(groups):
    rows = [['property', 'picture', 'between', 'pairs', 'Spearman rho', '95 % from', '95 % to',
             'Kendall tau-b']]
    for group in groups:
        for each in group.correlations:
            low, high = each.interval or (None, None)
            rows.append([*_begin(group), each.between, str(each.pairs), _number(each.rho),
                         _number(low), _number(high), _number(each.tau)])
    return rows


def agreement_table(groups):
    rows = [['property', 'picture', 'raters', 'samples', 'Kendall W', 'chi-square',
             'degrees of freedom', 'p']]
    for group in groups:
        found = group.agreement
        rows.append([*_begin(group), str(len(group.raters)), str(len(group.samples)),
                     *([_number(found.w), _number(found.chi_square, 4), str(found.freedom),
                        _number(found.p)] if found else [''] * 4)])
    return rows


def remarks(groups):
    """What is missing, in sentences."""
    result = []
    for group in groups:
        without = sorted({fabric for (fabric, _), value in zip(group.samples, group.kes) if value is None})
        if without:
            result.append(f'{group.property}: the files of {", ".join(without)} have no value for it.')
        if group.left_out:
            result.append(f'{group.property}: {", ".join(group.left_out)} did not rate all samples, and '
                          'count neither for ranks nor for agreement.')
        if any(each.rho is None for each in group.correlations):
            result.append(f'{group.property}: a rank correlation takes {LEAST_PAIRS} pairs that are not '
                          'all alike.')
        if group.agreement is None:
            result.append(f'{group.property}: agreement takes two raters who tell samples apart.')
    return result


def _markdown(rows):
    lines = ['| ' + ' | '.join(row) + ' |' for row in rows]
    return '\n'.join([lines[0], '|' + ' --- |' * len(rows[0]), *lines[1:]]) + '\n'


def write_tables(groups, folder):
    """ranks.csv, correlations.csv, agreement.csv, and all of it in evaluation.md."""
    text = '# Ratings of fabrics\n'
    for name, title, rows in [('correlations', 'Rank correlations', correlation_table(groups)),
                              ('agreement', 'Agreement between raters', agreement_table(groups)),
                              ('ranks', 'Ratings and ranks', rank_table(groups))]:
        with open(folder / f'{name}.csv', 'w', encoding='utf-8', newline='') as file:
            csv.writer(file, lineterminator='\n').writerows(rows)
        text += f'\n## {title}\n\n{_markdown(rows)}'
    missing = remarks(groups)
    if missing:
        text += '\n## Missing\n\n' + ''.join(f'- {each}\n' for each in missing)
    (folder / 'evaluation.md').write_text(text, encoding='utf-8')


def read_all(paths):
    """@throws ValueError naming a file that cannot be read or has another scale, or an answer that
    is there twice"""
    results, scales, seen = [], {}, set()
    for path in paths:
        found, scales[path] = read_results(path)
        if scales[path] != scales[paths[0]]:
            raise ValueError(f'{path}: the ratings are {scales[path]}, those of {paths[0]} '
                             f'{scales[paths[0]]}: all must have the same scale')
        for result in found:
            if result in seen:
                raise ValueError(f'{path}: trial {result.trial} of {result.who} is there twice')
            seen.add(result)
        results += found
    if not results:
        raise ValueError(f'{", ".join(map(str, paths))}: no answered trial')
    return results


def _analyse(arguments, config):
    from .plots import plot_group  # takes a second to load
    folder = pathlib.Path(arguments[-1])
    results = read_all(arguments[:-1])
    values = {fabric: FabricValues(find_fabric(fabric, config))
              for fabric in {result.fabric for result in results}}
    groups = make_groups(results, values)
    folder.mkdir(parents=True, exist_ok=True)
    write_tables(groups, folder)
    for group in groups:
        if group.raters:
            plot_group(group, folder)
    print(folder / 'evaluation.md')


def main(arguments):
    """@returns the exit status"""
    return programs.run('analyse_evaluation', USAGE, arguments, _analyse)
