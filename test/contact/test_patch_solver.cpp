#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fixtures.h"
#include "haptex/contact/kept_factor.h"
#include "haptex/contact/patch_solver.h"
#include "haptex/linear/block_cholesky.h"

namespace haptex::contact::test_patch_solver {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using linear::BlockVector;
using linear::SymmetricBlockMatrix;

// The matrices have a condition number of about 1e5: from inertia alone, 1e-4, to six springs. With
// the rounding of single precision, 6e-8, a factor in it may be wrong by 7e-3.
constexpr double kOfSinglePrecision = 7e-3;

/// Springs along the edges of a sheet in a frame that turns with `angle` (rad), stiff along it and
/// a thousand times softer across, and a contact on the first `touched` particles.
void fill(const mesh::ClothMesh& mesh, double angle, int touched, SymmetricBlockMatrix& matrix) {
  const Vector3d stiff(0.0, std::cos(angle), std::sin(angle));
  const Matrix3d spring = stiff * stiff.transpose() + 1e-3 * Matrix3d::Identity();
  matrix.setZero();
  for (int i = 0; i < matrix.size(); ++i) {
    matrix.diagonal(i) = 1e-4 * Matrix3d::Identity();
    if (i < touched) matrix.diagonal(i)(0, 0) += 0.1;
  }
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
      matrix.diagonal(low) += spring;
      matrix.diagonal(high) += spring;
      matrix.lower(matrix.slot(high, low)) -= spring;
    }
  }
}

class PatchSolverTest : public testing::Test {
 protected:
  PatchSolverTest() : rhs_(3, matrix_.size()) {
    for (int i = 0; i < matrix_.size(); ++i) {
      rhs_.col(i) = Vector3d(std::sin(i), std::cos(3.0 * i), std::sin(5.0 * i));
    }
  }
  BlockVector exact() {
    BlockVector solution = rhs_;
    linear::BlockCholesky cholesky(matrix_);
    EXPECT_TRUE(cholesky.factorise(matrix_));
    cholesky.solve(solution);
    return solution;
  }
  /// The root of the energy of the error by that of the solution.
  double errorOf(const BlockVector& solution) {
    const BlockVector right = exact();
    const BlockVector error = solution - right;
    BlockVector product(3, matrix_.size());
    matrix_.multiply(error, product);
    return std::sqrt(error.cwiseProduct(product).sum() / right.cwiseProduct(rhs_).sum());
  }

  const mesh::ClothMesh mesh_ = smallSample();
  SymmetricBlockMatrix matrix_{static_cast<int>(mesh_.rest_coordinates.size()), mesh_.triangles};
  BlockVector rhs_;
};

TEST_F(PatchSolverTest, AFactorOfTheMatrixSolvesToSinglePrecision) {
  fill(mesh_, 0.3, 5, matrix_);
  KeptFactor factor(matrix_);
  ASSERT_TRUE(factor.factorise(matrix_));
  BlockVector solution = rhs_;
  factor.solve(rhs_, solution);
  EXPECT_LT(errorOf(solution), 1e-3);
}

TEST_F(PatchSolverTest, AFactorRenewedPieceByPieceIsThatOfTheMatrix) {
  fill(mesh_, 0.3, 0, matrix_);
  KeptFactor renewed(matrix_), anew(matrix_);
  ASSERT_TRUE(renewed.factorise(matrix_));
  fill(mesh_, 0.4, 5, matrix_);
  ASSERT_TRUE(anew.factorise(matrix_));
  // More than a round: the first pieces may have been made from old ones.
  for (int i = 0; i < 25; ++i) ASSERT_TRUE(renewed.renew(matrix_, 0.1));
  BlockVector a = rhs_, b = rhs_;
  renewed.solve(rhs_, a);
  anew.solve(rhs_, b);
  EXPECT_LT((a - b).norm(), kOfSinglePrecision * b.norm());
}

TEST_F(PatchSolverTest, AKeptFactorGivesTheSolutionOfTheMatrixOfNow) {
  PatchSolver solver(matrix_);
  BlockVector solution = rhs_;
  for (int i = 0; i < 200; ++i) {
    const int touched = i % 50 < 25 ? 0 : i % 7;  // contacts come and go
    fill(mesh_, 0.5 * std::sin(0.05 * i), touched, matrix_);
    ASSERT_TRUE(solver.solve(matrix_, rhs_, Vector3d::Zero(), solution));
    ASSERT_LT(errorOf(solution), 1e-3) << i;
  }
}

TEST_F(PatchSolverTest, WhatGoesOnEvenlyTakesNoIteration) {
  fill(mesh_, 0.3, 5, matrix_);
  PatchSolver solver(matrix_);
  BlockVector solution = rhs_;
  const BlockVector first = rhs_;
  for (int i = 0; i < 10; ++i) {
    rhs_ = (1.0 + 0.1 * i) * first;
    ASSERT_TRUE(solver.solve(matrix_, rhs_, Vector3d::Zero(), solution));
    EXPECT_EQ(solver.iterations() > 0, i < 2) << i;
    EXPECT_LT(errorOf(solution), 1e-3) << i;
  }
}

TEST_F(PatchSolverTest, ALeapAfterWhatWentOnEvenlyIsSolvedAsWell) {
  fill(mesh_, 0.3, 5, matrix_);
  PatchSolver solver(matrix_);
  BlockVector solution = rhs_;
  const BlockVector first = rhs_;
  for (const double factor : {1.0, 1.1, 1.2, -50.0, 1e-2, 1e3}) {
    rhs_ = factor * first;
    rhs_.col(3) = factor * Vector3d(1.0, 2.0, factor);
    ASSERT_TRUE(solver.solve(matrix_, rhs_, Vector3d::Zero(), solution));
    EXPECT_LT(errorOf(solution), 1e-3) << factor;
  }
}

TEST_F(PatchSolverTest, AnImprovementNeverMakesASolutionWorse) {
  PatchSolver solver(matrix_);
  BlockVector solution = rhs_;
  fill(mesh_, 0.0, 0, matrix_);
  ASSERT_TRUE(solver.solve(matrix_, rhs_, Vector3d::Zero(), solution));
  fill(mesh_, 0.2, 5, matrix_);
  solution.setZero();
  double last = 1.0;
  for (int i = 0; i < 5; ++i) {
    solver.improve(matrix_, rhs_, solution);
    const double error = errorOf(solution);
    EXPECT_LT(error, last);
    last = error;
  }
}

TEST_F(PatchSolverTest, RefusesWhatIsNotPositiveDefiniteOrNotFiniteAndGoesOnAfterwards) {
  PatchSolver solver(matrix_);
  BlockVector solution = rhs_;
  for (const double bad :
       {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    fill(mesh_, 0.0, 0, matrix_);
    ASSERT_TRUE(solver.solve(matrix_, rhs_, Vector3d::Zero(), solution));
    matrix_.diagonal(3)(0, 0) = bad;
    EXPECT_FALSE(solver.solve(matrix_, rhs_, Vector3d::Zero(), solution)) << bad;
    fill(mesh_, 0.0, 0, matrix_);
    ASSERT_TRUE(solver.solve(matrix_, rhs_, Vector3d::Zero(), solution));
    EXPECT_LT(errorOf(solution), 1e-3);
    const BlockVector rhs = rhs_;
    rhs_(1, 2) = bad;
    EXPECT_EQ(solver.solve(matrix_, rhs_, Vector3d::Zero(), solution), std::isfinite(bad)) << bad;
    rhs_ = rhs;
  }
}

}  // namespace
}  // namespace haptex::contact::test_patch_solver
