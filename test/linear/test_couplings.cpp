// Couplings: the blocks of a matrix beyond its fixed pattern, and solves with them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "coupled_system.h"
#include "haptex/linear/block_cholesky.h"
#include "haptex/linear/conjugate_gradient.h"
#include "haptex/linear/linear_solver.h"

namespace haptex::linear::test_couplings {
namespace {

using cloth::stacked;

/// Of a sheet, with blocks that are neither symmetric nor small; some pairs are in the pattern.
CoupledSystem randomlyCoupled(int cells = 6, int couplings = 200) {
  CoupledSystem system(cloth::randomDefinite(cloth::square(cells), 3.0));
  for (const auto& [row, column] : randomPairs(system.matrix.size(), couplings)) {
    system.addCoupling(row, column, Eigen::Matrix3d::Random());
  }
  return system;
}

BlockVector product(const SymmetricBlockMatrix& matrix, const BlockVector& x) {
  BlockVector y(3, matrix.size());
  matrix.multiply(x, y);
  return y;
}

TEST(Couplings, MultiplyLikeTheDenseForm) {
  const CoupledSystem system = randomlyCoupled();
  EXPECT_GT(system.matrix.couplingCount(), 100);
  EXPECT_LT(system.matrix.couplingCount(), 200);  // the others repeat, or are in the pattern
  const BlockVector x = BlockVector::Random(3, system.matrix.size());
  const Eigen::VectorXd exact = system.exact * stacked(x);
  EXPECT_LT((stacked(product(system.matrix, x)) - exact).norm(), 1e-14 * exact.norm());
}

TEST(Couplings, GiveTheSameSumsToTheLastBitInWhateverOrderPairsAreAdded) {
  struct Block {
    int row, column;
    Eigen::Matrix3d block;
  };
  SymmetricBlockMatrix matrix = cloth::randomDefinite(cloth::square(6), 3.0);
  std::vector<Block> blocks;
  for (int i = 0; i < matrix.size(); ++i) {
    for (int j = 0; j < i; j += 5) blocks.push_back({i, j, Eigen::Matrix3d::Random()});
  }
  const BlockVector x = BlockVector::Random(3, matrix.size());
  const SymmetricBlockMatrix plain = matrix;
  for (const Block& b : blocks) matrix.addCoupling(b.row, b.column, b.block);
  const BlockVector expected = product(matrix, x);
  EXPECT_NE(expected, product(plain, x));
  for (unsigned seed : {1U, 2U, 3U}) {
    std::shuffle(blocks.begin(), blocks.end(), std::mt19937(seed));
    SymmetricBlockMatrix other = plain;
    for (const Block& b : blocks) {
      if (seed == 2U) {
        other.addCoupling(b.row, b.column, b.block);
      } else {
        other.addCoupling(b.column, b.row, b.block.transpose());
      }
    }
    EXPECT_EQ(other.couplingCount(), matrix.couplingCount());
    EXPECT_EQ(product(other, x), expected);
  }
}

TEST(Couplings, MayLeaveAPairOfThePatternToTheIteration) {
  SymmetricBlockMatrix matrix(3, {}, {{0, 1}});
  ASSERT_TRUE(matrix.hasInPattern(0, 1));
  ASSERT_TRUE(matrix.hasInPattern(1, 0));
  ASSERT_FALSE(matrix.hasInPattern(1, 2));
  const Eigen::Matrix3d first = Eigen::Matrix3d::Random(), second = Eigen::Matrix3d::Random();
  matrix.addCoupling(1, 0, first);
  matrix.addBeyondPattern(0, 1, second);
  EXPECT_EQ(matrix.couplingCount(), 1);
  EXPECT_EQ(matrix.lower(matrix.slot(1, 0)), first);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(9, 9);
  expected.block<3, 3>(3, 0) = first + second.transpose();
  expected.block<3, 3>(0, 3) = expected.block<3, 3>(3, 0).transpose();
  EXPECT_LT((denseWithCouplings(matrix) - expected).norm(), 1e-15);
  matrix.clearCouplings();
  EXPECT_EQ(matrix.couplingCount(), 0);
  EXPECT_EQ(matrix.lower(matrix.slot(1, 0)), first);
}

TEST(Couplings, OfOnePairAreSummedFromBothSides) {
  SymmetricBlockMatrix matrix(4, {});
  const Eigen::Matrix3d first = Eigen::Matrix3d::Random(), second = Eigen::Matrix3d::Random();
  matrix.addCoupling(1, 3, first);
  matrix.addCoupling(3, 1, second);
  EXPECT_EQ(matrix.couplingCount(), 1);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(12, 12);
  expected.block<3, 3>(3, 9) = first + second.transpose();
  expected.block<3, 3>(9, 3) = first.transpose() + second;
  EXPECT_EQ(denseWithCouplings(matrix), expected);
}

TEST(Couplings, OfAPairInThePatternGoToItsSlotAndStayThere) {
  SymmetricBlockMatrix matrix = cloth::randomDefinite(cloth::square(3), 1.0);
  const int slot = matrix.slot(1, 0);
  const Eigen::Matrix3d before = matrix.lower(slot), added = Eigen::Matrix3d::Random();
  matrix.addCoupling(1, 0, added);
  EXPECT_EQ(matrix.lower(slot), before + added);
  matrix.lower(slot) = before;
  matrix.addCoupling(0, 1, added);
  EXPECT_EQ(matrix.lower(slot), before + added.transpose());
  EXPECT_EQ(matrix.couplingCount(), 0);
  matrix.clearCouplings();
  EXPECT_EQ(matrix.lower(slot), before + added.transpose());
}

TEST(Couplings, AreEliminatedLikeTheDenseForm) {
  CoupledSystem system = randomlyCoupled();
  const int size = system.matrix.size();
  BlockVector rhs = BlockVector::Random(3, size);
  BlockVector values = BlockVector::Zero(3, size);
  std::vector<char> fixed(size, 0);
  for (int particle : {0, 3, 7, 20, 21, 40}) {
    fixed[particle] = 1;
    values.col(particle).setRandom();
  }
  Eigen::VectorXd expected_rhs = stacked(rhs) - system.exact * stacked(values);
  Eigen::MatrixXd expected = system.exact;
  for (int i = 0; i < size; ++i) {
    if (!fixed[i]) continue;
    expected.middleRows<3>(3 * i).setZero();
    expected.middleCols<3>(3 * i).setZero();
    expected.block<3, 3>(3 * i, 3 * i).setIdentity();
    expected_rhs.segment<3>(3 * i).setZero();
  }
  const int count = system.matrix.couplingCount();
  system.matrix.eliminate(fixed, values, rhs);
  EXPECT_EQ(system.matrix.couplingCount(), count);
  EXPECT_EQ(denseWithCouplings(system.matrix), expected);  // nothing is computed there
  EXPECT_LT((stacked(rhs) - expected_rhs).norm(), 1e-12 * expected_rhs.norm());
}

TEST(Couplings, AreConfinedLikeTheDenseForm) {
  CoupledSystem system = randomlyCoupled();
  const int size = system.matrix.size();
  BlockVector rhs = BlockVector::Random(3, size);
  BlockVector normals = BlockVector::Zero(3, size), values = normals;
  std::vector<char> confined(size, 0);
  Eigen::MatrixXd projector = Eigen::MatrixXd::Identity(3 * size, 3 * size);
  Eigen::MatrixXd along_normals = Eigen::MatrixXd::Zero(3 * size, 3 * size);
  for (int i : {1, 3, 8, 20, 21, 40}) {
    confined[i] = 1;
    normals.col(i) = Eigen::Vector3d::Random().normalized();
    values.col(i) = 0.7 * normals.col(i);
    const Eigen::Matrix3d term = normals.col(i) * normals.col(i).transpose();
    projector.block<3, 3>(3 * i, 3 * i) -= term;
    along_normals.block<3, 3>(3 * i, 3 * i) = system.matrix.diagonal(i).trace() / 3.0 * term;
  }
  const Eigen::MatrixXd expected = projector * system.exact * projector + along_normals;
  const Eigen::VectorXd expected_rhs = projector * (stacked(rhs) - system.exact * stacked(values));
  system.matrix.confine(confined, normals, values, rhs);
  EXPECT_LT((denseWithCouplings(system.matrix) - expected).norm(), 1e-12 * expected.norm());
  EXPECT_LT((stacked(rhs) - expected_rhs).norm(), 1e-12 * expected_rhs.norm());
}

TEST(Couplings, LeaveTheFixedPatternAsItIsWhenTheyAreCleared) {
  const SymmetricBlockMatrix plain = cloth::randomDefinite(cloth::square(6), 3.0);
  const BlockVector x = BlockVector::Random(3, plain.size());
  SymmetricBlockMatrix matrix = plain;
  matrix.addCoupling(0, plain.size() - 1, Eigen::Matrix3d::Identity());
  EXPECT_NE(product(matrix, x), product(plain, x));
  matrix.clearCouplings();
  EXPECT_EQ(matrix.couplingCount(), 0);
  EXPECT_EQ(product(matrix, x), product(plain, x));
  matrix.addCoupling(0, plain.size() - 1, Eigen::Matrix3d::Identity());
  matrix.setZero();
  EXPECT_EQ(matrix.couplingCount(), 0);
  EXPECT_TRUE(product(matrix, x).isZero(0.0));
}

TEST(Couplings, AreCopiedAndAssigned) {
  const CoupledSystem system = randomlyCoupled();
  SymmetricBlockMatrix copy = system.matrix;
  SymmetricBlockMatrix assigned = cloth::randomDefinite(cloth::square(6), 1.0);
  assigned.addCoupling(0, 48, Eigen::Matrix3d::Random());
  assigned = system.matrix;
  const BlockVector x = BlockVector::Random(3, copy.size());
  const BlockVector before = product(system.matrix, x);
  EXPECT_EQ(product(copy, x), before);
  EXPECT_EQ(product(assigned, x), before);
  copy.clearCouplings();
  assigned.addCoupling(0, 48, Eigen::Matrix3d::Identity());
  EXPECT_EQ(product(system.matrix, x), before);
  assigned = copy;
  EXPECT_EQ(assigned.couplingCount(), 0);
  EXPECT_EQ(product(assigned, x), product(copy, x));
}

/// Also those of pairs of the fixed pattern.
TEST(Couplings, AreTakenIntoAPatternThatHasThemAll) {
  CoupledSystem system = randomlyCoupled();
  const int row = 1, column = 0;
  ASSERT_TRUE(system.matrix.hasInPattern(row, column));
  const Eigen::Matrix3d block = Eigen::Matrix3d::Random();
  system.matrix.addBeyondPattern(row, column, block);
  SymmetricBlockMatrix whole = system.matrix.wholePattern();
  EXPECT_EQ(whole.couplingCount(), 0);
  EXPECT_TRUE(denseWithCouplings(whole).isZero(0.0));
  ASSERT_TRUE(whole.takeValues(system.matrix));
  EXPECT_EQ(denseWithCouplings(whole), denseWithCouplings(system.matrix));
  // What is taken later takes the place of that, fewer blocks too, but no others.
  const CoupledSystem fewer(cloth::randomDefinite(cloth::square(6), 2.0));
  ASSERT_TRUE(whole.takeValues(fewer.matrix));
  EXPECT_EQ(denseWithCouplings(whole), fewer.exact);
  EXPECT_FALSE(SymmetricBlockMatrix(fewer.matrix).takeValues(system.matrix));
  EXPECT_FALSE(whole.takeValues(cloth::randomDefinite(cloth::square(5), 2.0)));
  EXPECT_FALSE(SymmetricBlockMatrix(fewer.matrix.size(), {}).takeValues(fewer.matrix));
}

TEST(Couplings, AreRefusedInRowsThatDoNotExistAndOnTheDiagonal) {
  SymmetricBlockMatrix matrix = cloth::randomDefinite(cloth::square(3), 1.0);
  const SymmetricBlockMatrix before = matrix;
  for (const auto& [row, column] : std::vector<std::array<int, 2>>{
           {-1, 0}, {0, -1}, {16, 0}, {0, 16}, {16, 16}, {3, 3}, {0, 0}}) {
    try {
      matrix.addCoupling(row, column, Eigen::Matrix3d::Identity());
      ADD_FAILURE() << row << ", " << column << " was taken";
    } catch (const std::out_of_range& error) {
      EXPECT_EQ(error.what(), "no coupling at row " + std::to_string(row) + ", column " +
                                  std::to_string(column) +
                                  ": both have to be in [0, 16) and to differ");
    }
  }
  EXPECT_EQ(matrix.couplingCount(), 0);
  EXPECT_EQ(denseWithCouplings(matrix), denseWithCouplings(before));
}

class CouplingsByEveryMethod : public testing::TestWithParam<LinearSolverMethod> {};

/// No eigenvalue of these systems is below 1, so that |x - A^-1 b| <= |b - A x|.
void expectSolved(LinearSolver& solver, const CoupledSystem& system, double tolerance) {
  const BlockVector rhs = BlockVector::Random(3, system.matrix.size());
  BlockVector x = BlockVector::Zero(3, system.matrix.size());
  const SolveResult result = solver.solve(system.matrix, rhs, tolerance, x);
  EXPECT_TRUE(result.converged) << result.iterations << " iterations, " << result.residual;
  const double most = 1.01 * tolerance * rhs.norm();  // and the rounding of the products
  EXPECT_LE((system.exact * stacked(x) - stacked(rhs)).norm(), most);
  const Eigen::VectorXd exact = system.exact.ldlt().solve(stacked(rhs));
  EXPECT_GT(exact.norm(), 1e3 * most);  // so that the solution is not just small
  EXPECT_LE((stacked(x) - exact).norm(), most);
}

TEST_P(CouplingsByEveryMethod, SolveLikeTheDenseFormHoweverManyAndStiff) {
  for (int springs : {1, 50, 500}) {
    for (double stiffness : {1e-2, 1.0, 1e2, 1e4, 1e6}) {
      SCOPED_TRACE(testing::Message() << springs << " springs of stiffness " << stiffness);
      const CoupledSystem system = sheetWithSprings(12, 1.0, springs, stiffness);
      LinearSolver solver(system.matrix, GetParam());
      expectSolved(solver, system, 1e-7);
    }
  }
}

TEST_P(CouplingsByEveryMethod, MayComeAndGoBetweenTheSolvesOfOneSolver) {
  const CoupledSystem pattern = sheetWithSprings(10, 1e3, 0, 0.0);
  LinearSolver solver(pattern.matrix, GetParam());
  const std::array<int, 10> springs = {0, 30, 31, 0, 0, 200, 1, 5, 200, 0};
  for (std::size_t i = 0; i < springs.size(); ++i) {
    SCOPED_TRACE(testing::Message() << "solve " << i << ", " << springs[i] << " springs");
    expectSolved(solver, sheetWithSprings(10, 1e3, springs[i], 1e4, i), 1e-7);
  }
}

TEST_P(CouplingsByEveryMethod, LeaveSolutionsWithoutThemAsTheyWereToTheLastBit) {
  // As soft as conjugate gradients like it, and as stiff as only a factor solves it.
  for (double stiffness : {1e-3, 1e4}) {
    const SymmetricBlockMatrix plain = cloth::randomDefinite(cloth::square(12), stiffness);
    SymmetricBlockMatrix cleared = plain;
    cleared.reserveCouplings(100);
    for (const auto& [row, column] : randomPairs(plain.size(), 100)) {
      if (std::abs(row - column) > 14) {  // not in the pattern
        cleared.addCoupling(row, column, Eigen::Matrix3d::Random());
      }
    }
    EXPECT_GT(cleared.couplingCount(), 50);
    cleared.clearCouplings();
    LinearSolver solver(plain, GetParam()), other(cleared, GetParam());
    for (int i = 0; i < 4; ++i) {
      const BlockVector rhs = BlockVector::Random(3, plain.size());
      BlockVector x = BlockVector::Random(3, plain.size()), y = x;
      const SolveResult result = solver.solve(plain, rhs, 1e-9, x);
      const SolveResult other_result = other.solve(cleared, rhs, 1e-9, y);
      EXPECT_TRUE(result.converged);
      EXPECT_EQ(result.iterations, other_result.iterations);
      EXPECT_EQ(result.residual, other_result.residual);
      EXPECT_EQ(x, y);
    }
  }
}

TEST_P(CouplingsByEveryMethod, AnswerZeroForZero) {
  const CoupledSystem system = sheetWithSprings(5, 1.0, 20, 10.0);
  LinearSolver solver(system.matrix, GetParam());
  BlockVector x = BlockVector::Ones(3, system.matrix.size());
  EXPECT_TRUE(solver.solve(system.matrix, BlockVector::Zero(3, x.cols()), 1e-6, x).converged);
  EXPECT_TRUE(x.isZero(0.0));
}

/// 1, -0.8 and 0.6 in the diagonals of a 3 x 3 matrix, each times the identity. The eigenvalues
/// without the coupling of 0.6 are 1 and 1 +- 0.8 sqrt 2, of which one is negative.
TEST_P(CouplingsByEveryMethod, AreSolvedByTheDiagonalBlocksIfTheRestAloneIsNotDefinite) {
  SymmetricBlockMatrix matrix(3, {}, {{0, 1}, {1, 2}});
  for (int i = 0; i < 3; ++i) matrix.diagonal(i).setIdentity();
  for (int s = 0; s < 2; ++s) matrix.lower(s) = -0.8 * Eigen::Matrix3d::Identity();
  EXPECT_FALSE(BlockCholesky(matrix).factorise(matrix));
  matrix.addCoupling(2, 0, 0.6 * Eigen::Matrix3d::Identity());
  EXPECT_GT(denseWithCouplings(matrix).selfadjointView<Eigen::Lower>().eigenvalues()[0], 0.01);
  LinearSolver solver(matrix, GetParam());
  const BlockVector rhs = BlockVector::Random(3, 3);
  BlockVector x = BlockVector::Zero(3, 3);
  EXPECT_TRUE(solver.solve(matrix, rhs, 1e-9, x).converged);
  EXPECT_LT((product(matrix, x) - rhs).norm(), 1.01e-9 * rhs.norm());
  EXPECT_EQ(solver.lastMethod(), LinearSolverMethod::kConjugateGradient);
}

INSTANTIATE_TEST_SUITE_P(LinearSolver, CouplingsByEveryMethod,
                         testing::Values(LinearSolverMethod::kConjugateGradient,
                                         LinearSolverMethod::kCholesky,
                                         LinearSolverMethod::kAutomatic));

/// The matrix without one spring's coupling differs from the whole by two eigenvalues, so that
/// conjugate gradients end after three iterations; rounding takes one more.
TEST(Couplings, TakeAFactorInDoublePrecisionTwoIterationsMoreForASpring) {
  for (double stiffness : {1.0, 1e3, 1e6}) {
    const CoupledSystem system = sheetWithSprings(12, 10.0, 1, stiffness);
    LinearSolver solver(system.matrix, LinearSolverMethod::kCholesky);
    const BlockVector rhs = BlockVector::Random(3, system.matrix.size());
    BlockVector x = BlockVector::Zero(3, system.matrix.size());
    const SolveResult result = solver.solve(system.matrix, rhs, 1e-8, x);
    EXPECT_TRUE(result.converged);
    EXPECT_LE(result.iterations, 4) << stiffness;
    EXPECT_EQ(solver.factorisations(), 1);
  }
}

TEST(Couplings, MayChangeWhileAFactorIsKept) {
  const SymmetricBlockMatrix start = cloth::randomDefinite(cloth::square(20), 1e4);
  LinearSolver solver(start, LinearSolverMethod::kAutomatic);
  for (unsigned i = 0; i < 8; ++i) {
    expectSolved(solver, sheetWithSprings(20, 1e4, 20, 0.1, i), 1e-4);
    EXPECT_EQ(solver.lastMethod(), LinearSolverMethod::kCholesky);
  }
  EXPECT_LE(solver.factorisations(), 2);
}

/// With the factor of the fixed pattern they would take hundreds of iterations each.
TEST(Couplings, AreFactorisedWhereTheyAreManyAndStiff) {
  constexpr int kCells = 24, kSolves = 20;
  LinearSolver solver(cloth::randomDefinite(cloth::square(kCells), 1.0),
                      LinearSolverMethod::kAutomatic);
  long iterations = 0;
  for (unsigned i = 0; i < kSolves; ++i) {
    SCOPED_TRACE(testing::Message() << "solve " << i);
    const CoupledSystem system = sheetWithSprings(kCells, 1.0, 500, 1e4, i);
    const BlockVector rhs = BlockVector::Random(3, system.matrix.size());
    BlockVector x = BlockVector::Zero(3, system.matrix.size());
    const SolveResult result = solver.solve(system.matrix, rhs, 1e-7, x);
    EXPECT_TRUE(result.converged);
    EXPECT_LE((product(system.matrix, x) - rhs).norm(), 1.01e-7 * rhs.norm());
    EXPECT_EQ(solver.lastMethod(), LinearSolverMethod::kCholesky);
    iterations += result.iterations;
  }
  EXPECT_LE(iterations, 15 * kSolves);
}

TEST(Couplings, AreSolvedInDoublePrecisionWhereSinglePrecisionFailsInALargePattern) {
  const CoupledSystem system = sheetWithSprings(24, 1e3, 50, 1e9);
  const SymmetricBlockMatrix& matrix = system.matrix;
  EXPECT_GT(matrix.size(), 500);  // the factor in double precision is made when it is needed
  EXPECT_FALSE(BasicBlockCholesky<float>(matrix).factorise(matrix));
  LinearSolver solver(matrix, LinearSolverMethod::kAutomatic);
  const BlockVector rhs = BlockVector::Random(3, matrix.size());
  BlockVector x = BlockVector::Zero(3, matrix.size());
  EXPECT_TRUE(solver.solve(matrix, rhs, 1e-7, x).converged);
  EXPECT_LE((product(matrix, x) - rhs).norm(), 1.01e-7 * rhs.norm());
}

}  // namespace
}  // namespace haptex::linear::test_couplings
