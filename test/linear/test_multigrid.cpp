#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../malloc_counter.h"
#include "coupled_system.h"
#include "haptex/linear/linear_solver.h"
#include "haptex/linear/multigrid.h"
#include "haptex/mesh/mesh.h"

namespace haptex::linear::test_multigrid {
namespace {

/// Springs along the edges of a square sheet of cells x cells, which resist turning a little, on
/// light particles. @param ratio stiffness along y over that along x
SymmetricBlockMatrix springSheet(int cells, double ratio = 1.0) {
  const mesh::ClothMesh mesh =
      mesh::makeRectangle(1.0, 1.0, cells, cells, mesh::Triangulation::kAlternating);
  SymmetricBlockMatrix matrix(static_cast<int>(mesh.rest_coordinates.size()), mesh.triangles);
  for (int i = 0; i < matrix.size(); ++i) matrix.diagonal(i).diagonal().setConstant(1e-5);
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int i = triangle[k], j = triangle[(k + 1) % 3];
      const Eigen::Vector2d along =
          (mesh.rest_coordinates[j] - mesh.rest_coordinates[i]).normalized();
      const double stiffness = std::abs(along.y()) > 0.9 ? ratio : 1.0;
      const Eigen::Vector3d direction(along.x(), along.y(), 0.0);
      const Eigen::Matrix3d term =
          stiffness * (direction * direction.transpose() + 0.01 * Eigen::Matrix3d::Identity());
      matrix.diagonal(i) += term;
      matrix.diagonal(j) += term;
      matrix.lower(matrix.slot(std::max(i, j), std::min(i, j))) -= term;
    }
  }
  return matrix;
}

BlockVector smoothLoad(int size) {
  BlockVector load(3, size);
  for (int i = 0; i < size; ++i) load.col(i) = Eigen::Vector3d(1.0, 0.5, std::sin(0.01 * i));
  return load;
}

SolveResult solve(Multigrid& multigrid, const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                  double tolerance, int most_iterations, BlockVector& x) {
  EXPECT_TRUE(multigrid.takeValues(matrix));
  return ConjugateGradient(matrix.size())
      .solve(matrix, multigrid, rhs, tolerance, most_iterations, x);
}

double residualOf(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                  const BlockVector& x) {
  BlockVector product(3, matrix.size());
  matrix.multiply(x, product);
  return (rhs - product).norm() / rhs.norm();
}

Eigen::MatrixXd dense(const Interpolation& interpolation) {
  const auto fine = static_cast<int>(interpolation.begin.size()) - 1;
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(3 * fine, 3 * interpolation.coarse_size);
  for (int i = 0; i < fine; ++i) {
    for (int k = interpolation.begin[i]; k < interpolation.begin[i + 1]; ++k) {
      result.block<3, 3>(3 * i, 3 * interpolation.columns[k])
          .diagonal()
          .setConstant(interpolation.weights[k]);
    }
  }
  return result;
}

BlockRows rowsOf(const SymmetricBlockMatrix& matrix) {
  BlockRows rows(matrix);
  rows.take(matrix, nullptr);
  return rows;
}

TEST(Multigrid, RowsMultiplyAsTheMatrixDoes) {
  const SymmetricBlockMatrix matrix = cloth::randomDefinite(cloth::square(5), 1.0);
  const BlockRows rows = rowsOf(matrix);
  const BlockVector x = BlockVector::Random(3, matrix.size());
  BlockVector product = x;
  matrix.multiply(x, product);
  PaddedVector padded(matrix.size());
  for (int i = 0; i < matrix.size(); ++i) padded[i] << x.col(i).cast<float>().array(), 0.0f;
  for (int i = 0; i < matrix.size(); ++i) {
    const Eigen::Array4f row = rows.product(i, padded);
    EXPECT_LT((row.head<3>().matrix().cast<double>() - product.col(i)).norm(), 1e-5);
    EXPECT_EQ(row[3], 0.0f);
    EXPECT_LT((rows.timesInverseDiagonal(i, row).head<3>().matrix().cast<double>() -
               matrix.diagonal(i).inverse() * product.col(i))
                  .norm(),
              1e-4);
  }
}

TEST(Multigrid, InterpolatesTranslationsExactlyFromFewerRows) {
  const BlockRows rows = rowsOf(springSheet(20));
  const Interpolation interpolation = smoothedAggregation(rows);
  EXPECT_LT(interpolation.coarse_size, rows.size() / 4);
  for (int i = 0; i < rows.size(); ++i) {
    float sum = 0.0f;
    for (int k = interpolation.begin[i]; k < interpolation.begin[i + 1]; ++k) {
      sum += interpolation.weights[k];
    }
    EXPECT_NEAR(sum, 1.0f, 1e-6f) << i;
  }
}

TEST(Multigrid, GroupsLieAlongTheStiffThreads) {
  constexpr int kCells = 20;
  const Interpolation interpolation = smoothedAggregation(rowsOf(springSheet(kCells, 100.0)));
  for (int i = 0; i <= kCells; ++i) {
    // One row of particles along y shares nothing with the next.
    for (int k = interpolation.begin[i]; k < interpolation.begin[i + 1]; ++k) {
      for (int j = 0; j <= kCells; ++j) {
        if (i == j) continue;
        for (int m = interpolation.begin[j]; m < interpolation.begin[j + 1]; ++m) {
          EXPECT_NE(interpolation.columns[k], interpolation.columns[m]) << i << " and " << j;
        }
      }
    }
  }
}

TEST(Multigrid, CoarseMatricesAreGalerkins) {
  const SymmetricBlockMatrix matrix = cloth::randomDefinite(cloth::square(8), 10.0);
  const BlockRows fine = rowsOf(matrix);
  const Interpolation interpolation = smoothedAggregation(fine);
  CoarseProduct product(fine, interpolation);
  BlockRows coarse = product.pattern();
  product.multiply(fine, interpolation, coarse, nullptr);
  const Eigen::MatrixXd weights = dense(interpolation);
  const Eigen::MatrixXd exact = weights.transpose() * cloth::dense(matrix) * weights;
  Eigen::MatrixXd found = Eigen::MatrixXd::Zero(exact.rows(), exact.cols());
  for (int i = 0; i < coarse.size(); ++i) {
    for (int s = coarse.begin(i); s < coarse.begin(i + 1); ++s) {
      found.block<3, 3>(3 * i, 3 * coarse.column(s)) =
          Eigen::Map<const Eigen::Matrix3f>(coarse.block(s)).cast<double>();
    }
  }
  EXPECT_LT((found - exact).norm(), 1e-5 * exact.norm());
}

TEST(Multigrid, NeedsAboutAsManyIterationsForLargeSheets) {
  for (const double ratio : {1.0, 160.0}) {
    for (const int cells : {40, 150}) {
      const SymmetricBlockMatrix matrix = springSheet(cells, ratio);
      const BlockVector rhs = smoothLoad(matrix.size());
      BlockVector x = BlockVector::Zero(3, matrix.size());
      Multigrid multigrid(matrix);
      const SolveResult result = solve(multigrid, matrix, rhs, 1e-4, 200, x);
      EXPECT_TRUE(result.converged) << cells << " cells, ratio " << ratio;
      EXPECT_LE(result.iterations, 50) << cells << " cells, ratio " << ratio;
      EXPECT_LE(residualOf(matrix, rhs, x), 1e-4);
    }
  }
}

TEST(Multigrid, SolutionIsCholeskysToATightTolerance) {
  SymmetricBlockMatrix matrix = springSheet(40);
  BlockVector rhs = smoothLoad(matrix.size()), x = BlockVector::Zero(3, matrix.size());
  std::vector<char> held(matrix.size(), 0);
  for (int i = 0; i <= 40; ++i) held[i] = 1;
  matrix.eliminate(held, x, rhs);
  Multigrid multigrid(springSheet(40));  // from before anything was held
  const SolveResult result = solve(multigrid, matrix, rhs, 1e-11, 200, x);
  EXPECT_TRUE(result.converged);
  BlockCholesky cholesky(matrix);
  ASSERT_TRUE(cholesky.factorise(matrix));
  BlockVector exact = rhs;
  cholesky.solve(exact);
  EXPECT_LT((x - exact).norm(), 1e-7 * exact.norm());
  for (int i = 0; i <= 40; ++i) EXPECT_EQ(x.col(i).norm(), 0.0) << i;
}

TEST(Multigrid, KnowsCouplingsAndAnOuterProduct) {
  SymmetricBlockMatrix matrix = springSheet(30);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d direction = Eigen::Vector3d(1.0, 0.1 * i, 2.0).normalized();
    const Eigen::Matrix3d term = 3.0 * direction * direction.transpose();
    matrix.diagonal(i) += term;
    matrix.diagonal(i + 500) += term;
    matrix.addCoupling(i, i + 500, -term);
  }
  matrix.setOuterProduct(0.01, BlockVector::Random(3, matrix.size()));
  const BlockVector rhs = smoothLoad(matrix.size());
  BlockVector x = BlockVector::Zero(3, matrix.size());
  Multigrid multigrid(matrix);
  EXPECT_TRUE(solve(multigrid, matrix, rhs, 1e-8, 500, x).converged);
  EXPECT_LE(residualOf(matrix, rhs, x), 1e-8);
}

TEST(Multigrid, SumsAreTheSameForAnyNumberOfThreads) {
  const SymmetricBlockMatrix matrix = springSheet(100);
  const BlockVector rhs = smoothLoad(matrix.size());
  BlockVector alone = BlockVector::Zero(3, matrix.size()), shared = alone;
  Multigrid by_one(matrix);
  solve(by_one, matrix, rhs, 1e-6, 200, alone);
  ThreadPool pool(3);
  Multigrid by_three(matrix, &pool);
  solve(by_three, matrix, rhs, 1e-6, 200, shared);
  EXPECT_EQ(alone, shared);
}

TEST(Multigrid, AllocatesNothingAfterItIsMade) {
  const SymmetricBlockMatrix matrix = springSheet(40);
  BlockVector x = smoothLoad(matrix.size());
  Multigrid multigrid(matrix);
  const long before = allocations;
  EXPECT_TRUE(multigrid.takeValues(matrix));
  multigrid.solve(x);
  EXPECT_EQ(allocations - before, 0);
}

TEST(Multigrid, SaysWhatIsFarFromPositiveDefinite) {
  SymmetricBlockMatrix matrix = springSheet(40);
  Multigrid multigrid(matrix);
  for (int i = 0; i < matrix.size(); ++i) matrix.diagonal(i).diagonal().array() -= 5.0;
  EXPECT_FALSE(multigrid.takeValues(matrix));
}

TEST(Multigrid, LeavesAFiniteSolutionWhereTheLoadIsNot) {
  const SymmetricBlockMatrix matrix = springSheet(40);
  BlockVector rhs = smoothLoad(matrix.size()), x = BlockVector::Zero(3, matrix.size());
  rhs(1, 7) = std::numeric_limits<double>::quiet_NaN();
  Multigrid multigrid(matrix);
  EXPECT_FALSE(solve(multigrid, matrix, rhs, 1e-6, 200, x).converged);
  EXPECT_TRUE(x.allFinite());
}

TEST(Multigrid, RowsWithoutCouplingsAreSolvedByTheirBlocks) {
  SymmetricBlockMatrix matrix(30'000, {});
  for (int i = 0; i < matrix.size(); ++i) matrix.diagonal(i).diagonal() << 1.0, 2.0, 3.0 + i;
  const BlockVector rhs = smoothLoad(matrix.size());
  BlockVector x = BlockVector::Zero(3, matrix.size());
  Multigrid multigrid(matrix);
  EXPECT_EQ(multigrid.sizes().size(), 1u);
  EXPECT_TRUE(solve(multigrid, matrix, rhs, 1e-10, 20, x).converged);
}

TEST(LargePatterns, AreSolvedWithoutAFactor) {
  const SymmetricBlockMatrix matrix = springSheet(40);
  const BlockVector rhs = smoothLoad(matrix.size());
  LinearSolver solver(matrix, LinearSolverMethod::kAutomatic, nullptr, 1000);
  for (int step = 0; step < 3; ++step) {
    BlockVector x = BlockVector::Zero(3, matrix.size());
    const SolveResult result = solver.solve(matrix, rhs, 1e-6, x);
    EXPECT_TRUE(result.converged);
    EXPECT_EQ(solver.lastMethod(), LinearSolverMethod::kConjugateGradient);
  }
  EXPECT_EQ(solver.factorisations(), 0);
}

TEST(LargePatterns, GetANewHierarchyWhereTheOldOneFails) {
  const SymmetricBlockMatrix first = springSheet(60, 1e-3), second = springSheet(60, 1e3);
  const BlockVector rhs = smoothLoad(first.size());
  LinearSolver solver(first, LinearSolverMethod::kAutomatic, nullptr, 1000);
  BlockVector x = BlockVector::Zero(3, first.size());
  EXPECT_TRUE(solver.solve(first, rhs, 1e-6, x).converged);
  x.setZero();
  EXPECT_TRUE(solver.solve(second, rhs, 1e-6, x).converged);
  EXPECT_LE(residualOf(second, rhs, x), 1e-6);
}

TEST(LargePatterns, IndefiniteOnesAreGivenUp) {
  SymmetricBlockMatrix matrix = springSheet(40);
  for (int i = 0; i < matrix.size(); ++i) matrix.diagonal(i).diagonal().array() -= 5.0;
  const BlockVector rhs = smoothLoad(matrix.size());
  BlockVector x = BlockVector::Zero(3, matrix.size());
  LinearSolver solver(matrix, LinearSolverMethod::kAutomatic, nullptr, 1000);
  const SolveResult result =
      solver.solve(matrix, rhs, 1e-6, x, LinearSolver::Definiteness::kUnknown);
  EXPECT_FALSE(result.converged);
  EXPECT_TRUE(x.allFinite());
}

}  // namespace
}  // namespace haptex::linear::test_multigrid
