// The outer product that couples every particle with every other.
#include <gtest/gtest.h>

#include "coupled_system.h"
#include "haptex/linear/linear_solver.h"

namespace haptex::linear::test_outer_product {
namespace {

using cloth::stacked;

/// Some couplings, too.
CoupledSystem withOuterProduct(double scale) {
  CoupledSystem system = sheetWithSprings(6, 3.0, 20, 10.0);
  const BlockVector vector = BlockVector::Random(3, system.matrix.size());
  system.matrix.setOuterProduct(scale, vector);
  system.exact += scale * stacked(vector) * stacked(vector).transpose();
  return system;
}

TEST(OuterProduct, MultipliesLikeTheDenseForm) {
  const CoupledSystem system = withOuterProduct(2.0);
  const BlockVector x = BlockVector::Random(3, system.matrix.size());
  BlockVector y(3, system.matrix.size());
  system.matrix.multiply(x, y);
  const Eigen::VectorXd exact = system.exact * stacked(x);
  EXPECT_LT((stacked(y) - exact).norm(), 1e-14 * exact.norm());
}

TEST(OuterProduct, IsOneCouplingAndGoesWithTheOthers) {
  CoupledSystem system = withOuterProduct(2.0);
  const int count = system.matrix.couplingCount();
  system.matrix.setOuterProduct(0.0, BlockVector::Zero(3, system.matrix.size()));
  EXPECT_EQ(system.matrix.couplingCount(), count - 1);
  system = withOuterProduct(2.0);
  system.matrix.clearCouplings();
  EXPECT_EQ(system.matrix.couplingCount(), 0);
}

TEST(OuterProduct, IsEliminatedLikeTheDenseForm) {
  CoupledSystem system = withOuterProduct(2.0);
  const int size = system.matrix.size();
  BlockVector rhs = BlockVector::Random(3, size), values = BlockVector::Zero(3, size);
  std::vector<char> fixed(size, 0);
  for (const int particle : {0, 3, 7, 20, 40}) {
    fixed[particle] = 1;
    values.col(particle).setRandom();
  }
  Eigen::VectorXd expected = stacked(rhs) - system.exact * stacked(values);
  for (int i = 0; i < size; ++i) {
    if (fixed[i]) expected.segment<3>(3 * i).setZero();
  }
  system.matrix.eliminate(fixed, values, rhs);
  EXPECT_LT((stacked(rhs) - expected).norm(), 1e-12 * expected.norm());
  // What is left couples the free ones as before, and no fixed one.
  BlockVector x = BlockVector::Random(3, size), y(3, size);
  for (int i = 0; i < size; ++i) {
    if (fixed[i]) x.col(i).setZero();
  }
  system.matrix.multiply(x, y);
  Eigen::VectorXd exact = system.exact * stacked(x);
  for (int i = 0; i < size; ++i) {
    if (fixed[i]) exact.segment<3>(3 * i).setZero();
  }
  EXPECT_LT((stacked(y) - exact).norm(), 1e-12 * exact.norm());
}

TEST(OuterProduct, IsConfinedLikeTheDenseForm) {
  CoupledSystem system = withOuterProduct(2.0);
  const int size = system.matrix.size();
  BlockVector rhs = BlockVector::Random(3, size), normals = BlockVector::Zero(3, size);
  BlockVector values = normals;
  std::vector<char> confined(size, 0);
  Eigen::MatrixXd projector = Eigen::MatrixXd::Identity(3 * size, 3 * size);
  for (const int i : {1, 3, 8, 20, 40}) {
    confined[i] = 1;
    normals.col(i) = Eigen::Vector3d::Random().normalized();
    values.col(i) = 0.7 * normals.col(i);
    projector.block<3, 3>(3 * i, 3 * i) -= normals.col(i) * normals.col(i).transpose();
  }
  const Eigen::VectorXd expected = projector * (stacked(rhs) - system.exact * stacked(values));
  system.matrix.confine(confined, normals, values, rhs);
  EXPECT_LT((stacked(rhs) - expected).norm(), 1e-12 * expected.norm());
  const BlockVector x = BlockVector::Random(3, size);
  BlockVector y(3, size);
  system.matrix.multiply(x, y);
  const Eigen::VectorXd exact = projector * system.exact * projector * stacked(x);
  EXPECT_LT((projector * stacked(y) - exact).norm(), 1e-12 * exact.norm());
}

TEST(OuterProduct, IsSolvedWithByEveryMethodHoweverStiff) {
  for (const double scale : {1.0, 1e4, 1e8}) {
    const CoupledSystem system = withOuterProduct(scale);
    const int size = system.matrix.size();
    const BlockVector exact = BlockVector::Random(3, size);
    BlockVector rhs(3, size);
    system.matrix.multiply(exact, rhs);
    for (const auto method : {LinearSolverMethod::kConjugateGradient, LinearSolverMethod::kCholesky,
                              LinearSolverMethod::kAutomatic}) {
      LinearSolver solver(system.matrix, method);
      BlockVector x = BlockVector::Zero(3, size);
      const SolveResult result = solver.solve(system.matrix, rhs, 1e-10, x);
      EXPECT_TRUE(result.converged) << scale;
    }
  }
}

}  // namespace
}  // namespace haptex::linear::test_outer_product
