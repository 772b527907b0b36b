// Conjugate gradients: work that threads share, and solves that are given up.
#include <gtest/gtest.h>

#include "../cloth/fixtures.h"
#include "coupled_system.h"
#include "haptex/linear/conjugate_gradient.h"
#include "haptex/linear/shared_rows.h"

namespace haptex::linear::test_conjugate_gradient {
namespace {

TEST(SharedRows, ProductsWithThreadsAreThoseWithout) {
  // More than kSharedRows rows, and couplings across the parts.
  SymmetricBlockMatrix matrix = cloth::randomDefinite(cloth::square(70), 1.0);
  ASSERT_GT(matrix.size(), kSharedRows);
  for (const auto& [row, column] : randomPairs(matrix.size(), 50)) {
    matrix.addCoupling(row, column, Eigen::Matrix3d::Random());
  }
  const BlockVector x = BlockVector::Random(3, matrix.size());
  BlockVector alone(3, matrix.size()), shared = alone;
  matrix.multiply(x, alone);
  for (const int threads : {1, 2, 3}) {
    ThreadPool pool(threads);
    shared.setZero();
    matrix.multiply(x, shared, &pool);
    EXPECT_EQ(shared, alone);
  }
  ThreadPool pool(2);
  matrix.setZero(&pool);
  for (int i = 0; i < matrix.size(); ++i) EXPECT_TRUE(matrix.diagonal(i).isZero(0.0));
  for (int s = 0; s < matrix.lowerCount(); ++s) EXPECT_TRUE(matrix.lower(s).isZero(0.0));
}

TEST(ConjugateGradient, GivesTheSameSolutionWithAnyNumberOfThreads) {
  const SymmetricBlockMatrix matrix = cloth::randomDefinite(cloth::square(70), 1.0);
  const BlockVector rhs = BlockVector::Random(3, matrix.size());
  const auto solve = [&](ThreadPool* pool, bool by_factor) {
    ConjugateGradient conjugate_gradient(matrix.size(), pool);
    BlockVector x = BlockVector::Constant(3, matrix.size(), 0.01);
    BasicBlockCholesky<float> factor(matrix, pool);
    EXPECT_TRUE(factor.factorise(matrix));
    const SolveResult result = by_factor
                                   ? conjugate_gradient.solve(matrix, factor, rhs, 1e-9, 100, x)
                                   : conjugate_gradient.solve(matrix, rhs, 1e-9, 1000, x);
    EXPECT_TRUE(result.converged);
    return x;
  };
  for (const bool by_factor : {false, true}) {
    const BlockVector alone = solve(nullptr, by_factor);
    ThreadPool two(2), three(3);
    EXPECT_EQ(solve(&two, by_factor), alone);
    EXPECT_EQ(solve(&three, by_factor), alone);
  }
}

TEST(ConjugateGradient, GivesUpEarlyWhatIsTooSlowForItsIterations) {
  using Patience = ConjugateGradient::Patience;
  constexpr int kMost = 40;
  const SymmetricBlockMatrix matrix = cloth::randomDefinite(cloth::square(20), 1e6);
  ConjugateGradient conjugate_gradient(matrix.size());
  const BlockVector rhs = BlockVector::Random(3, matrix.size());
  BlockVector x = BlockVector::Zero(3, matrix.size()), product = x;
  const SolveResult slow =
      conjugate_gradient.solve(matrix, rhs, 1e-9, kMost, x, Patience::kWhilePromising);
  EXPECT_FALSE(slow.converged);
  EXPECT_FALSE(slow.indefinite);
  EXPECT_EQ(slow.iterations, kMost / 4);
  matrix.multiply(x, product);
  EXPECT_NEAR((rhs - product).norm(), slow.residual * rhs.norm(), 1e-9 * rhs.norm());
  EXPECT_LE(slow.residual, 1.0);
  x.setZero();
  EXPECT_EQ(conjugate_gradient.solve(matrix, rhs, 1e-9, kMost, x).iterations, kMost);
}

TEST(ConjugateGradient, KeepsOnWhatConvergesInItsIterations) {
  using Patience = ConjugateGradient::Patience;
  const SymmetricBlockMatrix matrix = cloth::randomDefinite(cloth::square(20), 1.0);
  ConjugateGradient conjugate_gradient(matrix.size());
  const BlockVector rhs = BlockVector::Random(3, matrix.size());
  BlockVector x = BlockVector::Zero(3, matrix.size()), y = x;
  const SolveResult alone = conjugate_gradient.solve(matrix, rhs, 1e-9, 1000, x);
  ASSERT_TRUE(alone.converged);
  const SolveResult tried =
      conjugate_gradient.solve(matrix, rhs, 1e-9, alone.iterations, y, Patience::kWhilePromising);
  EXPECT_TRUE(tried.converged);
  EXPECT_EQ(x, y);
}

}  // namespace
}  // namespace haptex::linear::test_conjugate_gradient
