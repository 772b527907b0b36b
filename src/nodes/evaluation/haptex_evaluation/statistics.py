"""Rank statistics of ratings. Formulas: Kendall and Gibbons 1990, Rank Correlation Methods, 5th
edition; ties have the mean of the ranks that they share."""
from typing import NamedTuple

import numpy as np
from scipy import stats

SEED = 20051101  # of the resampling: the same data give the same interval
RESAMPLES = 2000


class Concordance(NamedTuple):
    """Kendall's W of m raters over n samples."""
    w: float  # 0: no agreement, 1: all alike
    chi_square: float  # m (n - 1) W
    freedom: int  # n - 1
    p: float  # of a chi-square at least as large if raters rank at random


def _pairs(first, second):
    """@throws ValueError unless both are finite, equally long, of at least 2, and neither constant"""
    first, second = np.asarray(first, float), np.asarray(second, float)
    if first.ndim != 1 or first.shape != second.shape or len(first) < 2:
        raise ValueError(f'shapes {first.shape} and {second.shape}: must be equal, (n,) with n >= 2')
    for values in (first, second):
        if not np.isfinite(values).all():
            raise ValueError(f'{values}: all must be finite')
        if np.ptp(values) == 0.0:
            raise ValueError(f'{values}: must not all be equal, there is no rank correlation')
    return first, second


def spearman(first, second):
    """Spearman's rho: Pearson's correlation of the mid-ranks."""
    first, second = (stats.rankdata(values) for values in _pairs(first, second))
    first, second = first - first.mean(), second - second.mean()
    return float(first @ second / np.sqrt((first @ first) * (second @ second)))


def kendall(first, second):
    """Kendall's tau-b: concordant less discordant pairs, over the geometric mean of the numbers of
    pairs that are not tied in either."""
    first, second = (np.sign(values[:, None] - values[None, :]) for values in _pairs(first, second))
    return float((first * second).sum() / np.sqrt((first ** 2).sum() * (second ** 2).sum()))


def concordance(ratings):
    """Kendall's W, corrected for ties: W = 12 S / (m^2 (n^3 - n) - m sum T), with S the sum of
    squared deviations of the samples' rank sums, and T the sum of t^3 - t over a rater's groups of
    t ties.
    @param ratings shape (m, n), a row per rater, m >= 2, n >= 2, finite
    @throws ValueError naming the shape or that no rater tells any samples apart"""
    ratings = np.asarray(ratings, float)
    if ratings.ndim != 2 or min(ratings.shape) < 2 or not np.isfinite(ratings).all():
        raise ValueError(f'ratings of shape {ratings.shape}: must be finite, (m, n) with m, n >= 2')
    m, n = ratings.shape
    ranks = np.array([stats.rankdata(row) for row in ratings])
    sums = ranks.sum(axis=0)
    s = ((sums - sums.mean()) ** 2).sum()
    ties = sum((count ** 3 - count).sum()
               for count in (np.unique(row, return_counts=True)[1] for row in ratings))
    most = m * m * (n ** 3 - n) - m * ties
    if most <= 0:
        raise ValueError('ratings: every rater rates all samples alike, there is no concordance')
    w = float(12.0 * s / most)
    chi_square = m * (n - 1) * w
    return Concordance(w, chi_square, n - 1, float(stats.chi2.sf(chi_square, n - 1)))


def bootstrap_interval(statistic, first, second, share=0.95):
    """Percentile interval (Efron 1979) of a statistic of pairs, which are drawn with replacement.
    Resamples in which one side is constant have no rank correlation and are drawn again.
    @param share of the resamples within the interval, between 0 and 1
    @returns (low, high)"""
    if not 0.0 < share < 1.0:
        raise ValueError(f'share: {share} must be between 0 and 1')
    first, second = _pairs(first, second)
    random = np.random.default_rng(SEED)
    values = []
    while len(values) < RESAMPLES:
        drawn = random.integers(len(first), size=len(first))
        if np.ptp(first[drawn]) > 0.0 and np.ptp(second[drawn]) > 0.0:
            values.append(statistic(first[drawn], second[drawn]))
    low, high = np.quantile(values, [0.5 - share / 2, 0.5 + share / 2])
    return float(low), float(high)


def mean_ranks(ratings):
    """The mean over raters of the rank that each gives a sample among all; real and virtual ones
    that were rated together are ranked together.
    @param ratings shape (m, n), a row per rater, finite; @returns shape (n,), from 1 to n"""
    ratings = np.asarray(ratings, float)
    if ratings.ndim != 2 or ratings.size == 0 or not np.isfinite(ratings).all():
        raise ValueError(f'ratings of shape {ratings.shape}: must be finite, (m, n) with m, n >= 1')
    return np.mean([stats.rankdata(row) for row in ratings], axis=0)
