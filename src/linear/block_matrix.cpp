#include "haptex/linear/block_matrix.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "haptex/linear/shared_rows.h"

namespace haptex::linear {

SymmetricBlockMatrix::SymmetricBlockMatrix(int size,
                                           const std::vector<std::array<int, 3>>& triangles,
                                           const std::vector<std::array<int, 2>>& pairs)
    : diagonal_(size, Eigen::Matrix3d::Zero()) {
  std::vector<std::vector<int>> columns_of_row(size);
  for (const std::array<int, 3>& triangle : triangles) {
    for (int i : triangle) {
      for (int j : triangle) {
        if (j < i) columns_of_row[i].push_back(j);
      }
    }
  }
  for (const std::array<int, 2>& pair : pairs) {
    const auto [column, row] = std::minmax(pair[0], pair[1]);
    if (column < row) columns_of_row[row].push_back(column);
  }
  row_begin_.reserve(size + 1);
  row_begin_.push_back(0);
  for (std::vector<int>& columns : columns_of_row) {
    std::sort(columns.begin(), columns.end());
    columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
    columns_.insert(columns_.end(), columns.begin(), columns.end());
    row_begin_.push_back(static_cast<int>(columns_.size()));
  }
  columns_.shrink_to_fit();
  lower_.assign(columns_.size(), Eigen::Matrix3d::Zero());
  if (size > kSharedRows) listUpper();
}

void SymmetricBlockMatrix::listUpper() {
  upper_begin_.assign(size() + 1, 0);
  for (const int column : columns_) ++upper_begin_[column + 1];
  for (int i = 0; i < size(); ++i) upper_begin_[i + 1] += upper_begin_[i];
  upper_.resize(columns_.size());
  std::vector<int> next(upper_begin_.begin(), upper_begin_.end() - 1);
  for (int i = 0; i < size(); ++i) {
    for (int s = row_begin_[i]; s < row_begin_[i + 1]; ++s) upper_[next[columns_[s]]++] = {s, i};
  }
}

/// @returns the slot, or -1 if the pattern has no such block
int SymmetricBlockMatrix::find(int row, int column) const {
  const auto begin = columns_.begin() + row_begin_[row];
  const auto end = columns_.begin() + row_begin_[row + 1];
  const auto found = std::lower_bound(begin, end, column);
  return found == end || *found != column ? -1 : static_cast<int>(found - columns_.begin());
}

int SymmetricBlockMatrix::slot(int row, int column) const {
  const int slot = row >= 0 && row < size() ? find(row, column) : -1;
  if (slot < 0) {
    throw std::out_of_range("no block at row " + std::to_string(row) + ", column " +
                            std::to_string(column) + " of the matrix pattern");
  }
  return slot;
}

void SymmetricBlockMatrix::requirePair(int row, int column) const {
  if (std::min(row, column) < 0 || std::max(row, column) >= size() || row == column) {
    throw std::out_of_range("no coupling at row " + std::to_string(row) + ", column " +
                            std::to_string(column) + ": both have to be in [0, " +
                            std::to_string(size()) + ") and to differ");
  }
}

bool SymmetricBlockMatrix::hasInPattern(int row, int column) const {
  requirePair(row, column);
  return find(std::max(row, column), std::min(row, column)) >= 0;
}

void SymmetricBlockMatrix::addCoupling(int row, int column, const Eigen::Matrix3d& block) {
  requirePair(row, column);
  if (row < column) return addCoupling(column, row, block.transpose());
  const int slot = find(row, column);
  if (slot >= 0) {
    lower_[slot] += block;
    return;
  }
  addBeyondPattern(row, column, block);
}

void SymmetricBlockMatrix::addBeyondPattern(int row, int column, const Eigen::Matrix3d& block) {
  requirePair(row, column);
  if (row < column) return addBeyondPattern(column, row, block.transpose());
  if (first_coupling_.empty()) first_coupling_.assign(size(), -1);
  int before = -1, after = first_coupling_[row];
  while (after >= 0 && couplings_[after].column < column) {
    before = after;
    after = couplings_[after].next;
  }
  if (after >= 0 && couplings_[after].column == column) {
    couplings_[after].block += block;
    return;
  }
  const int added = static_cast<int>(couplings_.size());
  couplings_.push_back({row, column, after, block});
  (before < 0 ? first_coupling_[row] : couplings_[before].next) = added;
}

void SymmetricBlockMatrix::clearCouplings() {
  couplings_.clear();
  first_coupling_.clear();
  outer_scale_ = 0.0;
}

void SymmetricBlockMatrix::setOuterProduct(double scale, const BlockVector& vector) {
  outer_scale_ = scale;
  outer_ = vector;
}

void SymmetricBlockMatrix::reserveCouplings(std::size_t count) {
  couplings_.reserve(count);
  first_coupling_.reserve(diagonal_.size());
}

/// Calls function(index in couplings_), rows ascending, and columns ascending in each.
template <typename Function>
void SymmetricBlockMatrix::forEachCoupling(const Function& function) const {
  for (int first : first_coupling_) {
    for (int k = first; k >= 0; k = couplings_[k].next) function(k);
  }
}

SymmetricBlockMatrix SymmetricBlockMatrix::wholePattern() const {
  std::vector<std::array<int, 2>> pairs;
  pairs.reserve(columns_.size() + couplings_.size());
  for (int i = 0; i < size(); ++i) {
    for (int s = row_begin_[i]; s < row_begin_[i + 1]; ++s) pairs.push_back({i, columns_[s]});
  }
  for (const Coupling& coupling : couplings_) pairs.push_back({coupling.row, coupling.column});
  return {size(), {}, pairs};
}

bool SymmetricBlockMatrix::takeValues(const SymmetricBlockMatrix& other) {
  if (other.size() != size()) return false;
  clearCouplings();
  diagonal_ = other.diagonal_;
  for (int i = 0; i < size(); ++i) {
    int from = other.row_begin_[i];
    for (int s = row_begin_[i]; s < row_begin_[i + 1]; ++s) {
      const bool has = from < other.row_begin_[i + 1] && other.columns_[from] == columns_[s];
      if (has)
        lower_[s] = other.lower_[from++];
      else
        lower_[s].setZero();
    }
    if (from < other.row_begin_[i + 1]) return false;
  }
  for (const Coupling& coupling : other.couplings_) {
    const int slot = find(coupling.row, coupling.column);
    if (slot < 0) return false;
    lower_[slot] += coupling.block;
  }
  return true;
}

void SymmetricBlockMatrix::setZero(ThreadPool* pool) {
  const auto clear = [](std::vector<Eigen::Matrix3d>& blocks, int begin, int end) {
    std::fill(blocks.begin() + begin, blocks.begin() + end, Eigen::Matrix3d::Zero());
  };
  shareRows(pool, size(), [&](int begin, int end) {
    clear(diagonal_, begin, end);
    clear(lower_, row_begin_[begin], row_begin_[end]);
  });
  clearCouplings();
}

/// The fixed pattern, each block below the diagonal once.
void SymmetricBlockMatrix::multiplyInOrder(const BlockVector& x, BlockVector& y) const {
  for (int i = 0; i < size(); ++i) {
    const Eigen::Vector3d x_i = x.col(i);
    Eigen::Vector3d sum = diagonal_[i] * x_i;
    for (int s = row_begin_[i]; s < row_begin_[i + 1]; ++s) {
      const int j = columns_[s];  // j < i, so y.col(j) is already set
      sum += lower_[s] * x.col(j);
      y.col(j) += lower_[s].transpose() * x_i;
    }
    y.col(i) = sum;
  }
}

/// Some rows of it, in the order of the same sums.
void SymmetricBlockMatrix::multiplyRows(int begin, int end, const BlockVector& x,
                                        BlockVector& y) const {
  for (int i = begin; i < end; ++i) {
    Eigen::Vector3d sum = diagonal_[i] * x.col(i);
    for (int s = row_begin_[i]; s < row_begin_[i + 1]; ++s) sum += lower_[s] * x.col(columns_[s]);
    for (int u = upper_begin_[i]; u < upper_begin_[i + 1]; ++u) {
      sum += lower_[upper_[u].slot].transpose() * x.col(upper_[u].column);
    }
    y.col(i) = sum;
  }
}

void SymmetricBlockMatrix::multiply(const BlockVector& x, BlockVector& y, ThreadPool* pool) const {
  if (pool != nullptr && pool->threads() > 1 && !upper_.empty()) {
    shareRows(pool, size(), [&](int begin, int end) { multiplyRows(begin, end, x, y); });
  } else {
    multiplyInOrder(x, y);
  }
  forEachCoupling([&](int k) {
    const Coupling& coupling = couplings_[k];
    y.col(coupling.row) += coupling.block * x.col(coupling.column);
    y.col(coupling.column) += coupling.block.transpose() * x.col(coupling.row);
  });
  if (outer_scale_ > 0.0) y += outer_scale_ * outer_.cwiseProduct(x).sum() * outer_;
}

void SymmetricBlockMatrix::eliminate(const std::vector<char>& fixed, const BlockVector& values,
                                     BlockVector& rhs) {
  const auto remove = [&](int i, int j, Eigen::Matrix3d& block) {
    if (!fixed[i] && !fixed[j]) return;
    if (!fixed[i]) rhs.col(i) -= block * values.col(j);
    if (!fixed[j]) rhs.col(j) -= block.transpose() * values.col(i);
    block.setZero();
  };
  for (int i = 0; i < size(); ++i) {
    for (int s = row_begin_[i]; s < row_begin_[i + 1]; ++s) remove(i, columns_[s], lower_[s]);
  }
  forEachCoupling(
      [&](int k) { remove(couplings_[k].row, couplings_[k].column, couplings_[k].block); });
  if (outer_scale_ > 0.0) {
    double sum = 0.0;
    for (int i = 0; i < size(); ++i) {
      if (!fixed[i]) continue;
      sum += outer_.col(i).dot(values.col(i));
      outer_.col(i).setZero();
    }
    rhs -= outer_scale_ * sum * outer_;
  }
  for (int i = 0; i < size(); ++i) {
    if (!fixed[i]) continue;
    diagonal_[i].setIdentity();
    rhs.col(i).setZero();
  }
}

void SymmetricBlockMatrix::confine(const std::vector<char>& confined, const BlockVector& normals,
                                   const BlockVector& values, BlockVector& rhs) {
  // With P = I - n n^T: the blocks become P_i A_ij P_j, the right-hand side P (b - A values).
  const auto project = [&](int i, int j, Eigen::Matrix3d& block) {
    if (confined[j]) rhs.col(i) -= block * values.col(j);
    if (confined[i]) rhs.col(j) -= block.transpose() * values.col(i);
    if (confined[j]) block -= (block * normals.col(j)).eval() * normals.col(j).transpose();
    if (confined[i]) block -= normals.col(i) * (normals.col(i).transpose() * block).eval();
  };
  for (int i = 0; i < size(); ++i) {
    for (int s = row_begin_[i]; s < row_begin_[i + 1]; ++s) project(i, columns_[s], lower_[s]);
  }
  forEachCoupling(
      [&](int k) { project(couplings_[k].row, couplings_[k].column, couplings_[k].block); });
  if (outer_scale_ > 0.0) {
    double sum = 0.0;
    for (int i = 0; i < size(); ++i) {
      if (confined[i]) sum += outer_.col(i).dot(values.col(i));
    }
    rhs -= outer_scale_ * sum * outer_;
    for (int i = 0; i < size(); ++i) {
      if (confined[i]) outer_.col(i) -= normals.col(i) * normals.col(i).dot(outer_.col(i));
    }
  }
  for (int i = 0; i < size(); ++i) {
    if (!confined[i]) continue;
    Eigen::Matrix3d& block = diagonal_[i];
    const Eigen::Vector3d n = normals.col(i);
    rhs.col(i) -= block * values.col(i);
    rhs.col(i) -= n * n.dot(rhs.col(i));
    const double scale = block.trace() / 3.0;
    block -= (block * n).eval() * n.transpose();
    block -= n * (n.transpose() * block).eval();
    block += scale * n * n.transpose();
  }
}

}  // namespace haptex::linear
