#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "fixtures.h"
#include "haptex/cloth/block_cholesky.h"
#include "haptex/cloth/conjugate_gradient.h"
#include "haptex/cloth/dense_kernels.h"
#include "haptex/cloth/elimination.h"
#include "haptex/cloth/linear_solver.h"

namespace haptex::cloth {
namespace {

TEST(SymmetricBlockMatrix, MultipliesLikeItsDenseForm) {
  const SymmetricBlockMatrix matrix = randomDefinite(square(6), 3.0);
  const BlockVector x = BlockVector::Random(3, matrix.size());
  BlockVector y(3, matrix.size());
  matrix.multiply(x, y);
  const Eigen::VectorXd exact = dense(matrix) * stacked(x);
  EXPECT_LT((stacked(y) - exact).norm(), 1e-14 * exact.norm());
}

TEST(SymmetricBlockMatrix, NamesABlockThatIsNotInThePattern) {
  const SymmetricBlockMatrix matrix = randomDefinite(square(3), 1.0);
  EXPECT_NO_THROW(matrix.slot(1, 0));
  EXPECT_THROW(matrix.slot(15, 0), std::out_of_range);
}

TEST(SymmetricBlockMatrix, EliminationGivesTheSolutionOfTheConstrainedSystem) {
  SymmetricBlockMatrix matrix = randomDefinite(square(4), 5.0);
  const Eigen::MatrixXd a = dense(matrix);
  BlockVector rhs = BlockVector::Random(3, matrix.size());
  const Eigen::VectorXd b = stacked(rhs);
  std::vector<char> fixed(matrix.size(), 0);
  BlockVector values = BlockVector::Zero(3, matrix.size());
  for (int particle : {0, 3, 7}) {
    fixed[particle] = 1;
    values.col(particle).setRandom();
  }
  matrix.eliminate(fixed, values, rhs);
  Eigen::VectorXd x = dense(matrix).llt().solve(stacked(rhs));
  x += stacked(values);
  const Eigen::VectorXd residual = b - a * x;
  for (int i = 0; i < matrix.size(); ++i) {
    if (fixed[i]) {
      EXPECT_EQ(x.segment<3>(3 * i), values.col(i));
    } else {
      EXPECT_LT(residual.segment<3>(3 * i).norm(), 1e-12);
    }
  }
}

TEST(ConjugateGradient, ReachesTheStatedTrueResidual) {
  const SymmetricBlockMatrix matrix = randomDefinite(square(12), 300.0);
  const BlockVector rhs = BlockVector::Random(3, matrix.size());
  ConjugateGradient solver(matrix.size());
  for (double tolerance : {1e-2, 1e-6, 1e-10}) {
    BlockVector x = BlockVector::Zero(3, matrix.size());
    const SolveResult result = solver.solve(matrix, rhs, tolerance, 10000, x);
    const double residual =
        (stacked(rhs) - dense(matrix) * stacked(x)).norm() / stacked(rhs).norm();
    EXPECT_TRUE(result.converged);
    EXPECT_LE(residual, tolerance * (1.0 + 1e-6));
    EXPECT_NEAR(result.residual, residual, 1e-3 * tolerance);  // the rounding of the product
  }
}

TEST(ConjugateGradient, ReportsTheTrueResidualWhereItCannotReachTheTolerance) {
  const SymmetricBlockMatrix matrix = randomDefinite(square(12), 1e10);
  const BlockVector rhs = BlockVector::Random(3, matrix.size());
  ConjugateGradient solver(matrix.size());
  BlockVector x = BlockVector::Zero(3, matrix.size());
  const SolveResult result = solver.solve(matrix, rhs, 1e-14, 20000, x);
  const double residual = (stacked(rhs) - dense(matrix) * stacked(x)).norm() / stacked(rhs).norm();
  EXPECT_FALSE(result.converged);
  EXPECT_LE(result.residual, 1.0);  // never worse than no solution
  EXPECT_NEAR(result.residual, residual, 1e-3 * residual);
}

TEST(ConjugateGradient, SaysSoWhenTheIterationsDoNotSuffice) {
  const SymmetricBlockMatrix matrix = randomDefinite(square(12), 300.0);
  const BlockVector rhs = BlockVector::Random(3, matrix.size());
  ConjugateGradient solver(matrix.size());
  BlockVector x = BlockVector::Zero(3, matrix.size());
  const SolveResult result = solver.solve(matrix, rhs, 1e-8, 3, x);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.iterations, 3);
  EXPECT_GT(result.residual, 1e-8);
}

TEST(ConjugateGradient, DropsAGuessThatIsWorseThanNone) {
  const SymmetricBlockMatrix matrix = randomDefinite(square(8), 10.0);
  const BlockVector rhs = BlockVector::Random(3, matrix.size());
  ConjugateGradient solver(matrix.size());
  BlockVector cold = BlockVector::Zero(3, matrix.size());
  BlockVector bad = BlockVector::Constant(3, matrix.size(), 1e12);
  const int iterations = solver.solve(matrix, rhs, 1e-8, 1000, cold).iterations;
  EXPECT_EQ(solver.solve(matrix, rhs, 1e-8, 1000, bad).iterations, iterations);
  bad.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(solver.solve(matrix, rhs, 1e-8, 1000, bad).iterations, iterations);
}

TEST(DenseKernels, SubtractTheProductForEverySizeOfRemainder) {
  for (int rows = 1; rows <= 29; ++rows) {
    for (int columns : {1, 2, 3, 4, 6, 11}) {
      const int depth = 7, lda = rows + 2, ldb = columns + 1, ldc = rows + 3;
      const Eigen::MatrixXd a = Eigen::MatrixXd::Random(lda, depth);
      const Eigen::MatrixXd b = Eigen::MatrixXd::Random(ldb, depth);
      Eigen::MatrixXd c = Eigen::MatrixXd::Random(ldc, columns);
      Eigen::MatrixXd exact = c;
      exact.topRows(rows) -= a.topRows(rows) * b.topRows(columns).transpose();
      subtractProduct(rows, columns, depth, a.data(), lda, b.data(), ldb, c.data(), ldc);
      // The rows below must stay as they are.
      EXPECT_LT((c - exact).cwiseAbs().maxCoeff(), 1e-14) << rows << " x " << columns;
    }
  }
}

TEST(DenseKernels, MultiplyByTheOwnTopBelowItsDiagonalBlocks) {
  for (int columns : {3, 6, 9}) {
    for (int rows = columns; rows <= columns + 29; ++rows) {
      const int depth = 6, lda = rows + 2, ldc = rows + 3;
      const Eigen::MatrixXd a = Eigen::MatrixXd::Random(lda, depth);
      const Eigen::MatrixXd before = Eigen::MatrixXd::Random(ldc, columns);
      Eigen::MatrixXd c = before;
      multiplyByOwnTop(rows, columns, depth, a.data(), lda, c.data(), ldc);
      Eigen::MatrixXd exact = before;
      exact.topRows(rows) = a.topRows(rows) * a.topRows(columns).transpose();
      for (int j = 0; j < columns; ++j)
        exact.col(j).head(j / 3 * 3) = before.col(j).head(j / 3 * 3);
      EXPECT_LT((c - exact).cwiseAbs().maxCoeff(), 1e-14) << rows << " x " << columns;
    }
  }
}

/// A panel of the factor as the kernels keep it, with its diagonal inverted.
struct RandomPanel {
  Eigen::MatrixXd exact;   // lower trapezoid
  Eigen::MatrixXd stored;  // with a row more, which no kernel may change
  RandomPanel(int rows, int columns) : exact(Eigen::MatrixXd::Random(rows, columns)) {
    exact.triangularView<Eigen::StrictlyUpper>().setZero();
    exact.diagonal().array() += 3.0;
    stored = Eigen::MatrixXd::Constant(rows + 1, columns, 7.0);
    stored.topRows(rows) = exact;
    stored.diagonal() = exact.diagonal().cwiseInverse();
  }
};

TEST(DenseKernels, FactoriseThreeColumnsOfEveryHeight) {
  for (int rows = 3; rows <= 32; ++rows) {
    const RandomPanel panel(rows, 3);
    Eigen::MatrixXd a = panel.stored;
    a.topRows(rows) = panel.exact * panel.exact.topRows(3).transpose();
    ASSERT_TRUE(factoriseThreeColumns(rows, a.data(), rows + 1));
    a.triangularView<Eigen::StrictlyUpper>().setZero();
    Eigen::MatrixXd exact = panel.stored;
    // Some ten operations on numbers of order 10.
    EXPECT_LT((a - exact).cwiseAbs().maxCoeff(), 1e-13) << rows;
  }
}

TEST(DenseKernels, SubstituteThroughPanelsOfEveryHeight) {
  for (int columns : {3, 6, 9}) {
    for (int rows = columns; rows <= columns + 20; ++rows) {
      const RandomPanel panel(rows, columns);
      const auto top = panel.exact.topRows(columns).triangularView<Eigen::Lower>();
      const auto below = panel.exact.bottomRows(rows - columns);
      const Eigen::VectorXd start = Eigen::VectorXd::Random(rows + 1);

      Eigen::VectorXd x = start, exact = start;
      substituteForward(rows, columns, panel.stored.data(), rows + 1, x.data());
      exact.head(columns) = top.solve(start.head(columns));
      exact.segment(columns, rows - columns) -= below * exact.head(columns);
      EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-14) << rows << " x " << columns;

      x = exact = start;
      substituteBackward(rows, columns, panel.stored.data(), rows + 1, x.data());
      exact.head(columns) -= below.transpose() * start.segment(columns, rows - columns);
      exact.head(columns) = top.transpose().solve(exact.head(columns)).eval();
      EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-14) << rows << " x " << columns;
    }
  }
}

TEST(Elimination, SupernodesPartitionTheColumnsAndHoldTheWholePattern) {
  const SymmetricBlockMatrix pattern = randomDefinite(square(9), 1.0);
  const Elimination elimination = analyse(pattern);
  int next = 0;
  for (const Supernode& supernode : elimination.supernodes) {
    EXPECT_EQ(supernode.first, next);
    next = supernode.end;
    EXPECT_TRUE(std::is_sorted(supernode.rows.begin(), supernode.rows.end()));
  }
  EXPECT_EQ(next, pattern.size());
  for (int i = 0; i < pattern.size(); ++i) {
    EXPECT_EQ(elimination.position[elimination.order[i]], i);
    for (int s = pattern.rowBegin(i); s < pattern.rowBegin(i + 1); ++s) {
      const int a = elimination.position[i], b = elimination.position[pattern.column(s)];
      const int row = std::max(a, b), column = std::min(a, b);
      const Supernode& home = elimination.supernodes[elimination.supernode_of[column]];
      EXPECT_TRUE(row < home.end || std::binary_search(home.rows.begin(), home.rows.end(), row));
    }
  }
}

TEST(BlockCholesky, SolvesToRoundingOnEveryShapeOfPattern) {
  std::vector<ClothMesh> meshes = {square(1),
                                   square(2),
                                   square(5),
                                   square(13),
                                   makeRectangle(1.0, 0.1, 40, 1, Triangulation::kOneWay),
                                   makeRectangle(1.0, 1.0, 11, 9, Triangulation::kOneWay)};
  ClothMesh separate = square(3);  // two pieces without a common particle
  const int offset = static_cast<int>(separate.rest_coordinates.size());
  for (const auto& t : square(3).triangles) {
    separate.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  separate.rest_coordinates.resize(2 * offset);
  meshes.push_back(separate);
  for (const ClothMesh& mesh : meshes) {
    const SymmetricBlockMatrix matrix = randomDefinite(mesh, 40.0);
    BlockCholesky cholesky(matrix);
    ASSERT_TRUE(cholesky.factorise(matrix));
    const BlockVector rhs = BlockVector::Random(3, matrix.size());
    BlockVector x = rhs;
    cholesky.solve(x);
    const Eigen::VectorXd exact = dense(matrix).llt().solve(stacked(rhs));
    EXPECT_LT((stacked(x) - exact).norm(), 1e-11 * exact.norm());
  }
}

TEST(BlockCholesky, FactorisesAgainAfterTheValuesChanged) {
  SymmetricBlockMatrix matrix = randomDefinite(square(6), 2.0);
  BlockCholesky cholesky(matrix);
  ASSERT_TRUE(cholesky.factorise(matrix));
  for (int i = 0; i < matrix.size(); ++i) matrix.diagonal(i) *= 3.0;
  ASSERT_TRUE(cholesky.factorise(matrix));
  const BlockVector rhs = BlockVector::Random(3, matrix.size());
  BlockVector x = rhs;
  cholesky.solve(x);
  EXPECT_LT((dense(matrix) * stacked(x) - stacked(rhs)).norm(), 1e-12 * stacked(rhs).norm());
}

TEST(BlockCholesky, RefusesAnIndefiniteMatrixAndOneThatIsNotFinite) {
  SymmetricBlockMatrix matrix = randomDefinite(square(5), 1.0);
  BlockCholesky cholesky(matrix);
  const Eigen::Matrix3d sound = matrix.diagonal(4);
  matrix.diagonal(4)(1, 1) = -1.0;
  EXPECT_FALSE(cholesky.factorise(matrix));
  matrix.diagonal(4)(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(cholesky.factorise(matrix));
  matrix.diagonal(4) = sound;
  EXPECT_TRUE(cholesky.factorise(matrix));
}

class EveryMethod : public testing::TestWithParam<LinearSolverMethod> {};

TEST_P(EveryMethod, ReachesTheToleranceOnSoftAndStiffSystems) {
  for (double stiffness : {1e-3, 1.0, 1e6}) {
    const SymmetricBlockMatrix matrix = randomDefinite(square(10), stiffness);
    LinearSolver solver(matrix, GetParam());
    const BlockVector rhs = BlockVector::Random(3, matrix.size());
    BlockVector x = BlockVector::Zero(3, matrix.size());
    const SolveResult result = solver.solve(matrix, rhs, 1e-7, x);
    EXPECT_TRUE(result.converged) << stiffness;
    EXPECT_LT((dense(matrix) * stacked(x) - stacked(rhs)).norm(), 1.01e-7 * stacked(rhs).norm());
  }
}

TEST_P(EveryMethod, AnswersZeroForZero) {
  const SymmetricBlockMatrix matrix = randomDefinite(square(4), 1.0);
  LinearSolver solver(matrix, GetParam());
  BlockVector x = BlockVector::Ones(3, matrix.size());
  EXPECT_TRUE(solver.solve(matrix, BlockVector::Zero(3, matrix.size()), 1e-6, x).converged);
  EXPECT_TRUE(x.isZero());
}

TEST_P(EveryMethod, SaysSoWhenTheSystemIsNotANumber) {
  SymmetricBlockMatrix matrix = randomDefinite(square(4), 1.0);
  matrix.diagonal(3).setConstant(std::numeric_limits<double>::quiet_NaN());
  LinearSolver solver(matrix, GetParam());
  BlockVector x = BlockVector::Zero(3, matrix.size());
  EXPECT_FALSE(solver.solve(matrix, BlockVector::Ones(3, matrix.size()), 1e-6, x).converged);
}

INSTANTIATE_TEST_SUITE_P(LinearSolver, EveryMethod,
                         testing::Values(LinearSolverMethod::kConjugateGradient,
                                         LinearSolverMethod::kCholesky,
                                         LinearSolverMethod::kAutomatic));

TEST(LinearSolver, AutomaticIteratesWhereItIsEasyAndFactorisesWhereItIsHard) {
  const SymmetricBlockMatrix easy = randomDefinite(square(20), 1e-3);
  const SymmetricBlockMatrix hard = randomDefinite(square(20), 1e6);
  const BlockVector rhs = BlockVector::Random(3, easy.size());
  LinearSolver solver(easy, LinearSolverMethod::kAutomatic);
  EXPECT_GT(solver.iterationBudget(), 5);
  BlockVector x = BlockVector::Zero(3, easy.size());
  EXPECT_TRUE(solver.solve(easy, rhs, 1e-6, x).converged);
  EXPECT_EQ(solver.lastMethod(), LinearSolverMethod::kConjugateGradient);
  EXPECT_TRUE(solver.solve(hard, rhs, 1e-6, x).converged);
  EXPECT_EQ(solver.lastMethod(), LinearSolverMethod::kCholesky);
  // The failed try itself ends in a factorisation too; the next tries come 8 and 16 solves later.
  const auto direct_solves_before_success = [&] {
    for (int count = 0; count < 1000; ++count) {
      x.setZero();
      solver.solve(easy, rhs, 1e-6, x);
      if (solver.lastMethod() == LinearSolverMethod::kConjugateGradient) return count;
    }
    return -1;
  };
  EXPECT_EQ(direct_solves_before_success(), 8);
  for (int i = 0; i < 10; ++i) {  // iterations fail at once and again after 8 factorisations
    x.setZero();                  // the solution of the solve before would be too good a guess
    solver.solve(hard, rhs, 1e-6, x);
  }
  EXPECT_EQ(direct_solves_before_success(), 16);
}

TEST(SymmetricBlockMatrix, HasTheBlocksOfFurtherPairsForBothSolvers) {
  const ClothMesh mesh = square(6);
  const int size = static_cast<int>(mesh.rest_coordinates.size());
  const std::vector<std::array<int, 2>> pairs = {{0, 48}, {30, 2}, {2, 30}, {0, 1}};
  const SymmetricBlockMatrix without(size, mesh.triangles);
  SymmetricBlockMatrix matrix(size, mesh.triangles, pairs);
  EXPECT_EQ(matrix.lowerCount(), without.lowerCount() + 2);  // {0, 1} is an edge
  for (int i = 0; i < size; ++i) {
    matrix.diagonal(i) = 20.0 * Eigen::Matrix3d::Identity();
    for (int s = matrix.rowBegin(i); s < matrix.rowBegin(i + 1); ++s) matrix.lower(s).setRandom();
  }
  matrix.lower(matrix.slot(48, 0)).setConstant(2.0);
  matrix.lower(matrix.slot(30, 2)).setConstant(-3.0);
  const BlockVector rhs = BlockVector::Random(3, size);
  const Eigen::VectorXd exact = dense(matrix).llt().solve(stacked(rhs));
  BlockVector x = rhs;
  BlockCholesky cholesky(matrix);
  ASSERT_TRUE(cholesky.factorise(matrix));
  cholesky.solve(x);
  EXPECT_LT((stacked(x) - exact).norm(), 1e-12 * exact.norm());
  x.setZero();
  EXPECT_TRUE(ConjugateGradient(size).solve(matrix, rhs, 1e-12, 1000, x).converged);
  EXPECT_LT((stacked(x) - exact).norm(), 1e-10 * exact.norm());
}

}  // namespace
}  // namespace haptex::cloth
