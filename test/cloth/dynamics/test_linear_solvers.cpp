#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fixtures.h"
#include "haptex/linear/block_cholesky.h"
#include "haptex/linear/conjugate_gradient.h"
#include "haptex/linear/linear_solver.h"

namespace haptex::cloth::test_linear_solvers {
namespace {

TEST(SymmetricBlockMatrix, MultipliesLikeItsDenseForm) {
  const linear::SymmetricBlockMatrix matrix = randomDefinite(square(6), 3.0);
  const linear::BlockVector x = linear::BlockVector::Random(3, matrix.size());
  linear::BlockVector y(3, matrix.size());
  matrix.multiply(x, y);
  const Eigen::VectorXd exact = dense(matrix) * stacked(x);
  EXPECT_LT((stacked(y) - exact).norm(), 1e-14 * exact.norm());
}

TEST(SymmetricBlockMatrix, NamesABlockThatIsNotInThePattern) {
  const linear::SymmetricBlockMatrix matrix = randomDefinite(square(3), 1.0);
  EXPECT_NO_THROW(matrix.slot(1, 0));
  EXPECT_THROW(matrix.slot(15, 0), std::out_of_range);
}

TEST(SymmetricBlockMatrix, EliminationGivesTheSolutionOfTheConstrainedSystem) {
  linear::SymmetricBlockMatrix matrix = randomDefinite(square(4), 5.0);
  const Eigen::MatrixXd a = dense(matrix);
  linear::BlockVector rhs = linear::BlockVector::Random(3, matrix.size());
  const Eigen::VectorXd b = stacked(rhs);
  std::vector<char> fixed(matrix.size(), 0);
  linear::BlockVector values = linear::BlockVector::Zero(3, matrix.size());
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
  const linear::SymmetricBlockMatrix matrix = randomDefinite(square(12), 300.0);
  const linear::BlockVector rhs = linear::BlockVector::Random(3, matrix.size());
  linear::ConjugateGradient solver(matrix.size());
  for (double tolerance : {1e-2, 1e-6, 1e-10}) {
    linear::BlockVector x = linear::BlockVector::Zero(3, matrix.size());
    const linear::SolveResult result = solver.solve(matrix, rhs, tolerance, 10000, x);
    const double residual =
        (stacked(rhs) - dense(matrix) * stacked(x)).norm() / stacked(rhs).norm();
    EXPECT_TRUE(result.converged);
    EXPECT_LE(residual, tolerance * (1.0 + 1e-6));
    EXPECT_NEAR(result.residual, residual, 1e-3 * tolerance);  // the rounding of the product
  }
}

TEST(ConjugateGradient, ReportsTheTrueResidualWhereItCannotReachTheTolerance) {
  const linear::SymmetricBlockMatrix matrix = randomDefinite(square(12), 1e10);
  const linear::BlockVector rhs = linear::BlockVector::Random(3, matrix.size());
  linear::ConjugateGradient solver(matrix.size());
  linear::BlockVector x = linear::BlockVector::Zero(3, matrix.size());
  const linear::SolveResult result = solver.solve(matrix, rhs, 1e-14, 20000, x);
  const double residual = (stacked(rhs) - dense(matrix) * stacked(x)).norm() / stacked(rhs).norm();
  EXPECT_FALSE(result.converged);
  EXPECT_LE(result.residual, 1.0);  // never worse than no solution
  EXPECT_NEAR(result.residual, residual, 1e-3 * residual);
}

TEST(ConjugateGradient, SaysSoWhenTheIterationsDoNotSuffice) {
  const linear::SymmetricBlockMatrix matrix = randomDefinite(square(12), 300.0);
  const linear::BlockVector rhs = linear::BlockVector::Random(3, matrix.size());
  linear::ConjugateGradient solver(matrix.size());
  linear::BlockVector x = linear::BlockVector::Zero(3, matrix.size());
  const linear::SolveResult result = solver.solve(matrix, rhs, 1e-8, 3, x);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.iterations, 3);
  EXPECT_GT(result.residual, 1e-8);
}

TEST(ConjugateGradient, DropsAGuessThatIsWorseThanNone) {
  const linear::SymmetricBlockMatrix matrix = randomDefinite(square(8), 10.0);
  const linear::BlockVector rhs = linear::BlockVector::Random(3, matrix.size());
  linear::ConjugateGradient solver(matrix.size());
  linear::BlockVector cold = linear::BlockVector::Zero(3, matrix.size());
  linear::BlockVector bad = linear::BlockVector::Constant(3, matrix.size(), 1e12);
  const int iterations = solver.solve(matrix, rhs, 1e-8, 1000, cold).iterations;
  EXPECT_EQ(solver.solve(matrix, rhs, 1e-8, 1000, bad).iterations, iterations);
  bad.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(solver.solve(matrix, rhs, 1e-8, 1000, bad).iterations, iterations);
}

class EveryMethod : public testing::TestWithParam<linear::LinearSolverMethod> {};

TEST_P(EveryMethod, ReachesTheToleranceOnSoftAndStiffSystems) {
  for (double stiffness : {1e-3, 1.0, 1e6}) {
    const linear::SymmetricBlockMatrix matrix = randomDefinite(square(10), stiffness);
    linear::LinearSolver solver(matrix, GetParam());
    const linear::BlockVector rhs = linear::BlockVector::Random(3, matrix.size());
    linear::BlockVector x = linear::BlockVector::Zero(3, matrix.size());
    const linear::SolveResult result = solver.solve(matrix, rhs, 1e-7, x);
    EXPECT_TRUE(result.converged) << stiffness;
    EXPECT_LT((dense(matrix) * stacked(x) - stacked(rhs)).norm(), 1.01e-7 * stacked(rhs).norm());
  }
}

TEST_P(EveryMethod, AnswersZeroForZero) {
  const linear::SymmetricBlockMatrix matrix = randomDefinite(square(4), 1.0);
  linear::LinearSolver solver(matrix, GetParam());
  linear::BlockVector x = linear::BlockVector::Ones(3, matrix.size());
  EXPECT_TRUE(solver.solve(matrix, linear::BlockVector::Zero(3, matrix.size()), 1e-6, x).converged);
  EXPECT_TRUE(x.isZero());
}

TEST_P(EveryMethod, SaysSoWhenTheSystemIsNotANumber) {
  linear::SymmetricBlockMatrix matrix = randomDefinite(square(4), 1.0);
  matrix.diagonal(3).setConstant(std::numeric_limits<double>::quiet_NaN());
  linear::LinearSolver solver(matrix, GetParam());
  linear::BlockVector x = linear::BlockVector::Zero(3, matrix.size());
  EXPECT_FALSE(
      solver.solve(matrix, linear::BlockVector::Ones(3, matrix.size()), 1e-6, x).converged);
}

INSTANTIATE_TEST_SUITE_P(LinearSolver, EveryMethod,
                         testing::Values(linear::LinearSolverMethod::kConjugateGradient,
                                         linear::LinearSolverMethod::kCholesky,
                                         linear::LinearSolverMethod::kAutomatic));

TEST(LinearSolver, AutomaticIteratesWhereItIsEasyAndFactorisesWhereItIsHard) {
  const linear::SymmetricBlockMatrix easy = randomDefinite(square(20), 1e-3);
  const linear::SymmetricBlockMatrix hard = randomDefinite(square(20), 1e6);
  const linear::BlockVector rhs = linear::BlockVector::Random(3, easy.size());
  linear::LinearSolver solver(easy, linear::LinearSolverMethod::kAutomatic);
  EXPECT_GT(solver.iterationBudget(), 5);
  linear::BlockVector x = linear::BlockVector::Zero(3, easy.size());
  EXPECT_TRUE(solver.solve(easy, rhs, 1e-6, x).converged);
  EXPECT_EQ(solver.lastMethod(), linear::LinearSolverMethod::kConjugateGradient);
  EXPECT_TRUE(solver.solve(hard, rhs, 1e-6, x).converged);
  EXPECT_EQ(solver.lastMethod(), linear::LinearSolverMethod::kCholesky);
  // The failed try itself ends in a factorisation too; the next tries come 8 and 16 solves later.
  const auto direct_solves_before_success = [&] {
    for (int count = 0; count < 1000; ++count) {
      x.setZero();
      solver.solve(easy, rhs, 1e-6, x);
      if (solver.lastMethod() == linear::LinearSolverMethod::kConjugateGradient) return count;
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

TEST(LinearSolver, KeepsAFactorWhileTheSystemsChangeLittle) {
  const linear::SymmetricBlockMatrix start = randomDefinite(square(20), 1e4);
  const linear::BlockVector rhs = linear::BlockVector::Random(3, start.size());
  linear::LinearSolver solver(start, linear::LinearSolverMethod::kAutomatic);
  for (int i = 0; i < 8; ++i) {
    linear::SymmetricBlockMatrix matrix = start;
    for (int k = 0; k < matrix.size(); ++k) matrix.diagonal(k) *= 1.0 + 1e-6 * i;
    linear::BlockVector x = linear::BlockVector::Zero(3, matrix.size());
    const linear::SolveResult result = solver.solve(matrix, rhs, 1e-4, x);
    EXPECT_TRUE(result.converged);
    EXPECT_EQ(solver.lastMethod(), linear::LinearSolverMethod::kCholesky);
    linear::BlockVector product(3, matrix.size());
    matrix.multiply(x, product);
    EXPECT_LE((product - rhs).norm(), 1.01e-4 * rhs.norm());
  }
  EXPECT_LE(solver.factorisations(), 2);
  const linear::SymmetricBlockMatrix other = randomDefinite(square(20), 1e4, 7);
  const long before = solver.factorisations();
  linear::BlockVector x = linear::BlockVector::Zero(3, start.size());
  EXPECT_TRUE(solver.solve(other, rhs, 1e-4, x).converged);
  EXPECT_EQ(solver.factorisations(), before + 1);  // the kept one does not help
}

TEST(LinearSolver, SolvesWhatIsTooStiffForAFactorInSinglePrecisionAlone) {
  // Condition numbers above 1e8, where the rounding of single precision is larger than the smallest
  // eigenvalues of the scaled matrix.
  const linear::SymmetricBlockMatrix matrix = randomDefinite(square(20), 1e8);
  const linear::BlockVector rhs = linear::BlockVector::Random(3, matrix.size());
  linear::LinearSolver solver(matrix, linear::LinearSolverMethod::kAutomatic);
  linear::BlockVector x = linear::BlockVector::Zero(3, matrix.size()), product = x;
  EXPECT_TRUE(solver.solve(matrix, rhs, 1e-6, x).converged);
  matrix.multiply(x, product);
  EXPECT_LE((product - rhs).norm(), 1.01e-6 * rhs.norm());
}

TEST(LinearSolver, GivesUpWhatIsNotPositiveDefiniteAfterItsFactorsIfThatIsWorthNoSearch) {
  linear::SymmetricBlockMatrix matrix = randomDefinite(square(20), 1e4);
  const linear::BlockVector rhs = linear::BlockVector::Random(3, matrix.size());
  linear::LinearSolver solver(matrix, linear::LinearSolverMethod::kAutomatic);
  linear::BlockVector x = linear::BlockVector::Zero(3, matrix.size());
  const auto solve = [&](linear::LinearSolver::Definiteness definiteness) {
    x.setZero();
    return solver.solve(matrix, rhs, 1e-6, x, definiteness);
  };
  EXPECT_TRUE(solve(linear::LinearSolver::Definiteness::kUnknown).converged);
  matrix.diagonal(17) -= 1e7 * Eigen::Matrix3d::Identity();
  EXPECT_FALSE(solve(linear::LinearSolver::Definiteness::kUnknown).converged);
  const long before = solver.factorisations();
  const linear::SolveResult result = solve(linear::LinearSolver::Definiteness::kUnknown);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.iterations, 0);
  EXPECT_LE(solver.factorisations(), before + 2);  // in single and in double precision
}

/// The system of a step of cloth that is folded into waves of this height (m), which go on.
class FoldedSystem {
 public:
  explicit FoldedSystem(const material::Fabric& fabric)
      : cloth_(square(32, 0.2), fabric, {}), matrix_(cloth_.pattern()) {}

  void assemble(double height, double phase, linear::BlockVector& rhs) {
    ClothState state = cloth_.initialState();
    for (std::size_t i = 0; i < cloth_.particleCount(); ++i) {
      Eigen::Vector3d& place = state.positions[i];
      const double along = place.z() + 0.3 * place.y();
      place.x() += height * std::sin(80.0 * along + phase);
      place.z() *= 0.8;  // compressed
      state.velocities[i].x() = 4.0 * height * std::cos(80.0 * along + phase);
    }
    matrix_.setZero();
    rhs.setZero();
    for (int i = 0; i < matrix_.size(); ++i) {
      matrix_.diagonal(i).diagonal().setConstant(cloth_.masses()[i]);
    }
    cloth_.forces().assembleLinearised(state.ofForces(), {0.0125, 0.0125}, matrix_, rhs);
  }
  const linear::SymmetricBlockMatrix& matrix() const { return matrix_; }

 private:
  Cloth cloth_;
  linear::SymmetricBlockMatrix matrix_;
};

TEST(LinearSolver, NeedsOneFactorInSinglePrecisionPerSystemOfFoldedClothWhateverItsStiffness) {
  for (double factor : {1.0, 10.0, 100.0}) {
    FoldedSystem system(material::linearFabric(100.0 * factor));
    const linear::SymmetricBlockMatrix& matrix = system.matrix();
    linear::BlockVector rhs(3, matrix.size()), x = linear::BlockVector::Zero(3, matrix.size()),
                                               product = x;
    linear::LinearSolver solver(matrix, linear::LinearSolverMethod::kAutomatic);
    for (int step = 0; step < 12; ++step) {
      system.assemble(0.01, 0.3 * step, rhs);
      const long before = solver.factorisations();
      const linear::SolveResult result = solver.solve(matrix, rhs, 1e-6, x);
      EXPECT_TRUE(result.converged);
      EXPECT_LE(solver.factorisations(), before + 1) << factor << ", step " << step;
      matrix.multiply(x, product);
      EXPECT_LE((product - rhs).norm(), 1.01e-6 * rhs.norm()) << factor << ", step " << step;
    }
  }
}

TEST(SymmetricBlockMatrix, HasTheBlocksOfFurtherPairsForBothSolvers) {
  const mesh::ClothMesh mesh = square(6);
  const int size = static_cast<int>(mesh.rest_coordinates.size());
  const std::vector<std::array<int, 2>> pairs = {{0, 48}, {30, 2}, {2, 30}, {0, 1}};
  const linear::SymmetricBlockMatrix without(size, mesh.triangles);
  linear::SymmetricBlockMatrix matrix(size, mesh.triangles, pairs);
  EXPECT_EQ(matrix.lowerCount(), without.lowerCount() + 2);  // {0, 1} is an edge
  for (int i = 0; i < size; ++i) {
    matrix.diagonal(i) = 20.0 * Eigen::Matrix3d::Identity();
    for (int s = matrix.rowBegin(i); s < matrix.rowBegin(i + 1); ++s) matrix.lower(s).setRandom();
  }
  matrix.lower(matrix.slot(48, 0)).setConstant(2.0);
  matrix.lower(matrix.slot(30, 2)).setConstant(-3.0);
  const linear::BlockVector rhs = linear::BlockVector::Random(3, size);
  const Eigen::VectorXd exact = dense(matrix).llt().solve(stacked(rhs));
  linear::BlockVector x = rhs;
  linear::BlockCholesky cholesky(matrix);
  ASSERT_TRUE(cholesky.factorise(matrix));
  cholesky.solve(x);
  EXPECT_LT((stacked(x) - exact).norm(), 1e-12 * exact.norm());
  x.setZero();
  EXPECT_TRUE(linear::ConjugateGradient(size).solve(matrix, rhs, 1e-12, 1000, x).converged);
  EXPECT_LT((stacked(x) - exact).norm(), 1e-10 * exact.norm());
}

}  // namespace
}  // namespace haptex::cloth::test_linear_solvers
