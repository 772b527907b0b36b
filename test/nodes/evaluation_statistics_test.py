#!/usr/bin/python3
"""Rank statistics give what was published, to rounding, and know where they have no meaning."""
import pathlib
import sys
import unittest

import numpy as np
import rostest
from scipy import stats

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'src' / 'nodes' / 'evaluation'))
from haptex_evaluation.statistics import (bootstrap_interval, concordance, kendall,  # noqa: E402
                                          mean_ranks, spearman)

TOLERANCE = 1e-12
# Wikipedia, Spearman's rank correlation coefficient: IQ and hours of television a week.
IQ = [106, 100, 86, 101, 99, 103, 97, 113, 112, 110]
HOURS = [7, 27, 2, 50, 28, 29, 20, 12, 6, 17]
# Siegel 1956, Nonparametric Statistics, chapter 9: authoritarianism and striving of twelve students,
# sorted by the first.
STRIVING = [1, 5, 2, 6, 7, 3, 4, 10, 11, 8, 9, 12]
# Kendall, Rank Correlation Methods, chapter 3: two rankings of ten with ties.
TIED_PAIR = [[1, 2.5, 2.5, 4.5, 4.5, 6.5, 6.5, 8, 9.5, 9.5], [1, 2, 4.5, 4.5, 4.5, 4.5, 8, 8, 8, 10]]
# Siegel 1956, Nonparametric Statistics, chapter 9: three executives rank six applicants.
EXECUTIVES = [[1, 6, 3, 2, 5, 4], [1, 5, 6, 4, 2, 3], [6, 3, 2, 5, 4, 1]]
# Kendall, Rank Correlation Methods, chapter 6, as in Siegel 1956: three rankings of ten with ties.
TIED = [[1, 4.5, 2, 4.5, 3, 7.5, 6, 9, 7.5, 10], [2.5, 1, 2.5, 4.5, 4.5, 8, 9, 6.5, 10, 6.5],
        [2, 1, 4.5, 4.5, 4.5, 4.5, 8, 8, 8, 10]]


class Statistics(unittest.TestCase):
    def near(self, value, exact):
        self.assertLessEqual(abs(value - exact), TOLERANCE)

    def test_spearman_of_television_and_iq_is_as_published(self):
        self.near(spearman(IQ, HOURS), -29 / 165)

    def test_spearman_and_kendall_of_striving_are_as_published(self):
        ranks = range(1, 13)
        self.near(kendall(ranks, STRIVING), 2 / 3)  # 55 - 11 of 66; 0.67
        self.near(spearman(ranks, STRIVING), 9 / 11)  # 1 - 6 52 / 1716; 0.82

    def test_kendall_with_ties_is_as_published(self):
        # Kendall: 33 over the root of (45 - 4) (45 - 9); 0.859.
        self.near(kendall(*TIED_PAIR), 33 / np.sqrt(41 * 36))
        # Documentation of scipy.stats.kendalltau: -0.4714.
        self.near(kendall([12, 2, 1, 12, 2], [1, 4, 7, 1, 0]), -np.sqrt(2) / 3)

    def test_rank_correlations_with_ties_are_those_of_scipy(self):
        random = np.random.default_rng(1)
        for _ in range(50):
            first, second = random.integers(5, size=(2, 12))
            self.near(spearman(first, second), stats.spearmanr(first, second)[0])
            self.near(kendall(first, second), stats.kendalltau(first, second)[0])

    def test_concordance_of_executives_is_as_published(self):
        found = concordance(EXECUTIVES)
        self.near(found.w, 17 / 105)  # s = 25.5; 0.16
        self.near(found.chi_square, 17 / 7)
        self.assertEqual(found.freedom, 5)
        self.near(found.p, stats.chi2.sf(17 / 7, 5))

    def test_concordance_with_ties_is_as_published(self):
        self.near(concordance(TIED).w, 591 / 714)  # 0.828
        self.near(concordance(TIED).chi_square, 27 * 591 / 714)

    def test_concordance_is_friedmans_chi_square_over_its_most(self):
        ratings = np.random.default_rng(2).integers(4, size=(7, 5))
        found, friedman = concordance(ratings), stats.friedmanchisquare(*ratings.T)
        self.near(found.chi_square, friedman[0])
        self.near(found.p, friedman[1])

    def test_raters_who_agree_have_concordance_one(self):
        self.near(concordance([[1, 2, 3], [10, 20, 30]]).w, 1.0)
        self.near(concordance([[1, 2, 2], [4, 9, 9]]).w, 1.0)

    def test_the_interval_is_the_same_every_time_and_around_the_value(self):
        interval = bootstrap_interval(spearman, IQ, HOURS)
        self.assertEqual(interval, bootstrap_interval(spearman, IQ, HOURS))
        self.assertTrue(-1 <= interval[0] < -29 / 165 < interval[1] <= 1)
        self.assertEqual(bootstrap_interval(spearman, [1, 2, 3, 4], [2, 4, 6, 8]), (1.0, 1.0))

    def test_mixed_ranks_are_means_over_raters_of_ranks_among_all(self):
        found = mean_ranks([[1, 5, 5, 9], [2, 1, 3, 4]])  # 1 2.5 2.5 4 and 2 1 3 4
        np.testing.assert_array_equal(found, [1.5, 1.75, 2.75, 4.0])

    def test_refuses_what_has_no_rank_correlation(self):
        for statistic in (spearman, kendall):
            for first, second, says in [([1, 1, 1], [1, 2, 3], 'must not all be equal'),
                                        ([1, np.nan], [1, 2], 'must be finite'),
                                        ([1, 2], [1, 2, 3], 'must be equal'), ([1], [1], 'n >= 2')]:
                with self.assertRaisesRegex(ValueError, says):
                    statistic(first, second)
        with self.assertRaisesRegex(ValueError, 'rates all samples alike'):
            concordance([[1, 1], [2, 2]])
        with self.assertRaisesRegex(ValueError, 'must be finite'):
            concordance([[1, 2], [np.inf, 2]])
        with self.assertRaisesRegex(ValueError, 'share: 1.0 must be'):
            bootstrap_interval(spearman, IQ, HOURS, 1.0)


if __name__ == '__main__':
    rostest.rosrun('haptex', 'evaluation_statistics', Statistics)
