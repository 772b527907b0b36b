// Factors that are kept, of the fixed pattern and of whole matrices.
#include <gtest/gtest.h>

#include "coupled_system.h"
#include "haptex/linear/backoff.h"
#include "haptex/linear/kept_factor.h"

namespace haptex::linear::test_kept_factor {
namespace {

constexpr double kTolerance = 1e-7;
constexpr int kMostIterations = 30;

SolveResult solve(KeptFactor& factor, const SymmetricBlockMatrix& matrix) {
  ConjugateGradient conjugate_gradient(matrix.size());
  const BlockVector rhs = BlockVector::Random(3, matrix.size());
  BlockVector x = BlockVector::Zero(3, matrix.size()), product = x;
  const SolveResult result =
      factor.solve(conjugate_gradient, matrix, rhs, kTolerance, kMostIterations, x);
  matrix.multiply(x, product);
  if (result.converged) {
    EXPECT_LE((product - rhs).norm(), 1.01 * kTolerance * rhs.norm());
  }
  return result;
}

TEST(Backoff, LeavesOutTwiceAsOftenAfterEveryFailureUntilASuccess) {
  Backoff backoff(2, 7);
  const auto left_out = [&] {
    int times = 0;
    for (; backoff.holds(); backoff.pass()) ++times;
    return times;
  };
  EXPECT_EQ(left_out(), 0);
  for (const int expected : {2, 4, 7, 7}) {
    backoff.failed();
    EXPECT_EQ(left_out(), expected);
  }
  backoff.succeeded();
  EXPECT_EQ(left_out(), 0);
  backoff.failed();
  EXPECT_EQ(left_out(), 2);
}

TEST(KeptFactor, OfWholeMatricesKnowsCouplingsThatComeAndGo) {
  const CoupledSystem plain = sheetWithSprings(12, 1.0, 0, 0.0);
  KeptFactor fixed(plain.matrix, nullptr);
  const auto whole = fixed.ofWholeMatrices();
  EXPECT_FALSE(solve(fixed, sheetWithSprings(12, 1.0, 500, 1e4).matrix).converged);
  unsigned seed = 0;
  for (int springs : {500, 100, 0, 1, 500, 2, 300}) {
    SCOPED_TRACE(springs);
    const CoupledSystem system = sheetWithSprings(12, 1.0, springs, 1e4, ++seed);
    EXPECT_TRUE(solve(*whole, system.matrix).converged);
    // Again, with the same factor.
    const long before = whole->factorisations();
    EXPECT_TRUE(solve(*whole, system.matrix).converged);
    EXPECT_LE(whole->factorisations(), before + 1);
  }
  EXPECT_LE(whole->factorisations(), 14);
}

/// 1, -0.8 and 0.6 in the diagonals of a 3 x 3 matrix, each times the identity. The eigenvalues
/// without the coupling of 0.6 are 1 and 1 +- 0.8 sqrt 2, of which one is negative.
TEST(KeptFactor, OfWholeMatricesNeedsNoPositiveDefiniteFixedPart) {
  SymmetricBlockMatrix matrix(3, {}, {{0, 1}, {1, 2}});
  for (int i = 0; i < 3; ++i) matrix.diagonal(i).setIdentity();
  for (int s = 0; s < 2; ++s) matrix.lower(s) = -0.8 * Eigen::Matrix3d::Identity();
  matrix.addCoupling(2, 0, 0.6 * Eigen::Matrix3d::Identity());
  KeptFactor fixed(matrix, nullptr);
  EXPECT_EQ(solve(fixed, matrix).iterations, 0);
  const auto whole = fixed.ofWholeMatrices();
  EXPECT_TRUE(solve(*whole, matrix).converged);
  matrix.clearCouplings();
  matrix.addCoupling(2, 0, -0.6 * Eigen::Matrix3d::Identity());
  matrix.diagonal(1) *= 0.1;
  const auto indefinite = fixed.ofWholeMatrices();
  EXPECT_FALSE(solve(*indefinite, matrix).converged);
}

/// Expected costs are those of a system that is larger than the fixed part's.
TEST(KeptFactor, SaysWhatItCosts) {
  const CoupledSystem system = sheetWithSprings(12, 1.0, 100, 1e4);
  KeptFactor fixed(system.matrix, nullptr);
  const auto whole = fixed.ofWholeMatrices();
  EXPECT_GT(whole->factorCost(), fixed.factorCost());
  EXPECT_GT(fixed.factorCost(), fixed.iterationCost());
  ASSERT_TRUE(solve(*whole, system.matrix).converged);
  EXPECT_GE(whole->meanCost(), whole->factorCost());
  const double first = whole->meanCost();
  ASSERT_TRUE(solve(*whole, system.matrix).converged);
  EXPECT_LT(whole->meanCost(), first);
}

}  // namespace
}  // namespace haptex::linear::test_kept_factor
