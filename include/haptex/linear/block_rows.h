// Whole rows of symmetric block matrices in single precision, for the products of multigrid.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/linear/block_matrix.h"
#include "haptex/linear/shared_rows.h"

namespace haptex::linear {

/// One 3-vector per block row, and a zero: four numbers are one register.
using PaddedVector = std::vector<Eigen::Array4f>;

/// Both triangles, so that rows can be multiplied independently of one another: twice the memory of
/// SymmetricBlockMatrix in numbers of half the size. Its couplings are left out.
class BlockRows {
 public:
  /// The fixed pattern of a matrix; its values are those of take().
  explicit BlockRows(const SymmetricBlockMatrix& pattern);
  /// All blocks zero. @param begin of the rows in columns, and the end
  /// @param columns of the blocks of each row, its own first
  BlockRows(std::vector<int> begin, std::vector<int> columns);

  int size() const { return static_cast<int>(begin_.size()) - 1; }
  /// Slots of a row: [begin(row), begin(row + 1)), first that of its diagonal block.
  int begin(int row) const { return begin_[row]; }
  int column(int slot) const { return columns_[slot]; }
  /// Nine numbers, columns first.
  const float* block(int slot) const { return &blocks_[9 * static_cast<std::size_t>(slot)]; }
  float* block(int slot) { return &blocks_[9 * static_cast<std::size_t>(slot)]; }
  /// Whether the diagonal block is the only one with values, as of a particle that is held.
  bool isAlone(int row) const { return is_alone_[row] != 0; }

  /// Of a matrix with the constructor's pattern, which has to be the one of SymmetricBlockMatrix.
  void take(const SymmetricBlockMatrix& matrix, ThreadPool* pool);
  /// After the blocks have changed: what timesInverseDiagonal() and isAlone() tell.
  void finish(ThreadPool* pool);
  void setZero();

  Eigen::Array4f product(int row, const PaddedVector& x) const {
    Eigen::Array4f sum = Eigen::Array4f::Zero();
    for (int s = begin_[row]; s < begin_[row + 1]; ++s) sum += times(block(s), x[columns_[s]]);
    sum[3] = 0.0f;
    return sum;
  }
  Eigen::Array4f timesInverseDiagonal(int row, const Eigen::Array4f& x) const {
    Eigen::Array4f result = times(&inverse_diagonal_[9 * static_cast<std::size_t>(row)], x);
    result[3] = 0.0f;
    return result;
  }

 private:
  /// The fourth number is of no use.
  static Eigen::Array4f times(const float* block, const Eigen::Array4f& x) {
    using Column = Eigen::Map<const Eigen::Array4f>;  // and the number behind it
    return Column(block) * x[0] + Column(block + 3) * x[1] + Column(block + 6) * x[2];
  }
  void allocate();

  std::vector<int> begin_;
  std::vector<int> columns_;
  std::vector<int> sources_;   // of slots, in the matrix of take(): its, or ~ its transposed
  std::vector<float> blocks_;  // and one number more, likewise the next
  std::vector<float> inverse_diagonal_;
  std::vector<char> is_alone_;
};

}  // namespace haptex::linear
