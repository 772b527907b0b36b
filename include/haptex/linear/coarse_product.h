// The matrix of the coarse unknowns of an interpolation.
#pragma once

#include <array>
#include <vector>

#include "haptex/linear/aggregation.h"
#include "haptex/linear/block_rows.h"

namespace haptex::linear {

/// W^T A W for an interpolation W and matrices A of one pattern (Galerkin). The sums are the same
/// for any number of threads.
class CoarseProduct {
 public:
  CoarseProduct(const BlockRows& fine, const Interpolation& interpolation);

  /// The pattern of the results.
  BlockRows pattern() const { return {coarse_begin_, coarse_columns_}; }

  /// @param fine   of the constructor's pattern; rows that are alone take no part
  /// @param coarse of pattern(). Rows of no part get an identity
  void multiply(const BlockRows& fine, const Interpolation& interpolation, BlockRows& coarse,
                ThreadPool* pool);

 private:
  static constexpr int kParts = 8;
  using BlockColumns = std::array<Eigen::Array4f, 3>;  // of a block; fourth numbers are of no use

  void planRows(const BlockRows& fine, const Interpolation& interpolation);
  void findCoarsePattern(const Interpolation& interpolation);
  void planTargets(const Interpolation& interpolation);
  void splitRows(const Interpolation& interpolation);
  void addRow(int row, const BlockRows& fine, const Interpolation& interpolation,
              std::vector<BlockColumns>& sums, BlockRows& coarse) const;

  // Row i of A W has blocks in columns_[k], k in [begin_[i], begin_[i + 1]).
  std::vector<int> begin_;
  std::vector<int> columns_;
  // Of the products of row i's blocks with weights, in their order: the place in row i of A W.
  std::vector<int> first_place_;
  std::vector<int> places_;
  // Of row i of A W times each weight of row i, in their order: the slot of the result.
  std::vector<int> first_target_;
  std::vector<int> targets_;
  std::vector<int> coarse_begin_;
  std::vector<int> coarse_columns_;
  // Fine rows whose sums go to coarse ones that no other part adds to, and the others.
  std::vector<int> parts_[kParts];
  std::vector<int> shared_;
  // A row of A W, for each part and for the others.
  std::vector<BlockColumns> sums_[kParts + 1];
};

}  // namespace haptex::linear
