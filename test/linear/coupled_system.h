// A matrix with couplings beside its dense form.
#pragma once

#include <array>
#include <random>
#include <vector>

#include "../cloth/fixtures.h"
#include "haptex/linear/block_matrix.h"

namespace haptex::linear {

/// Blocks are added to both forms, so that the dense one knows nothing of patterns.
struct CoupledSystem {
  explicit CoupledSystem(const SymmetricBlockMatrix& fixed)
      : matrix(fixed), exact(cloth::dense(fixed)) {}

  void addCoupling(int row, int column, const Eigen::Matrix3d& block) {
    matrix.addCoupling(row, column, block);
    exact.block<3, 3>(3 * row, 3 * column) += block;
    exact.block<3, 3>(3 * column, 3 * row) += block.transpose();
  }

  /// A spring of a stiffness along a direction n of unit length, which adds terms k n n^T.
  void addSpring(int row, int column, double stiffness, const Eigen::Vector3d& direction) {
    const Eigen::Matrix3d term = stiffness * direction * direction.transpose();
    for (int i : {row, column}) {
      matrix.diagonal(i) += term;
      exact.block<3, 3>(3 * i, 3 * i) += term;
    }
    addCoupling(row, column, -term);
  }

  SymmetricBlockMatrix matrix;
  Eigen::MatrixXd exact;
};

/// Pairs of different particles in [0, size), in either order; some repeat each other.
inline std::vector<std::array<int, 2>> randomPairs(int size, int count, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> particle(0, size - 1), distance(1, size - 1);
  std::vector<std::array<int, 2>> pairs(count);
  for (std::array<int, 2>& pair : pairs) {
    pair[0] = particle(random);
    pair[1] = (pair[0] + distance(random)) % size;
  }
  return pairs;
}

/// A random positive definite system of a sheet of cells x cells with springs between random pairs.
/// No eigenvalue is below 1.
inline CoupledSystem sheetWithSprings(int cells, double sheet_stiffness, int springs,
                                      double spring_stiffness, unsigned seed = 1) {
  CoupledSystem system(cloth::randomDefinite(cloth::square(cells), sheet_stiffness));
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (const auto& [row, column] : randomPairs(system.matrix.size(), springs, seed)) {
    const Eigen::Vector3d direction(normal(random), normal(random), normal(random));
    system.addSpring(row, column, spring_stiffness, direction.normalized());
  }
  return system;
}

/// Column by column, by multiplying unit vectors.
inline Eigen::MatrixXd denseWithCouplings(const SymmetricBlockMatrix& matrix) {
  const int unknowns = 3 * matrix.size();
  Eigen::MatrixXd result(unknowns, unknowns);
  BlockVector unit = BlockVector::Zero(3, matrix.size()), product = unit;
  for (int k = 0; k < unknowns; ++k) {
    unit(k % 3, k / 3) = 1.0;
    matrix.multiply(unit, product);
    result.col(k) = cloth::stacked(product);
    unit(k % 3, k / 3) = 0.0;
  }
  return result;
}

}  // namespace haptex::linear
