// The factorisation of CHOLMOD, for comparison. Its supernodal part is under the GPL, so it is used
// by this program, which is not installed, and by nothing else.
#pragma once

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCore>
#include <vector>

#include "haptex/linear/block_matrix.h"

namespace haptex::bench {

class Cholmod {
 public:
  /// Analyses the pattern.
  explicit Cholmod(const linear::SymmetricBlockMatrix& matrix) {
    solver_.analyzePattern(scalars(matrix));
  }

  /// By scalars, of the lower triangle.
  static Eigen::SparseMatrix<double> scalars(const linear::SymmetricBlockMatrix& matrix) {
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](int row, int column, const Eigen::Matrix3d& block) {
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < (row == column ? i + 1 : 3); ++j) {
          entries.emplace_back(3 * row + i, 3 * column + j, block(i, j));
        }
      }
    };
    for (int row = 0; row < matrix.size(); ++row) {
      add(row, row, matrix.diagonal(row));
      for (int slot = matrix.rowBegin(row); slot < matrix.rowBegin(row + 1); ++slot) {
        add(row, matrix.column(slot), matrix.lower(slot));
      }
    }
    Eigen::SparseMatrix<double> sparse(3 * matrix.size(), 3 * matrix.size());
    sparse.setFromTriplets(entries.begin(), entries.end());
    return sparse;
  }

  bool factorise(const Eigen::SparseMatrix<double>& matrix) {
    solver_.factorize(matrix);
    return solver_.info() == Eigen::Success;
  }
  Eigen::VectorXd solve(const linear::BlockVector& rhs) {
    return solver_.solve(Eigen::Map<const Eigen::VectorXd>(rhs.data(), rhs.size()));
  }

 private:
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> solver_;
};

}  // namespace haptex::bench
