#include "haptex/linear/block_matrix.h"

#include <algorithm>
#include <stdexcept>
#include <string>

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
}

int SymmetricBlockMatrix::slot(int row, int column) const {
  const auto begin = columns_.begin() + row_begin_.at(row);
  const auto end = columns_.begin() + row_begin_.at(row + 1);
  const auto found = std::lower_bound(begin, end, column);
  if (found == end || *found != column) {
    throw std::out_of_range("no block at row " + std::to_string(row) + ", column " +
                            std::to_string(column) + " of the matrix pattern");
  }
  return static_cast<int>(found - columns_.begin());
}

void SymmetricBlockMatrix::setZero() {
  std::fill(diagonal_.begin(), diagonal_.end(), Eigen::Matrix3d::Zero());
  std::fill(lower_.begin(), lower_.end(), Eigen::Matrix3d::Zero());
}

void SymmetricBlockMatrix::multiply(const BlockVector& x, BlockVector& y) const {
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

void SymmetricBlockMatrix::eliminate(const std::vector<char>& fixed, const BlockVector& values,
                                     BlockVector& rhs) {
  for (int i = 0; i < size(); ++i) {
    for (int s = row_begin_[i]; s < row_begin_[i + 1]; ++s) {
      const int j = columns_[s];
      if (!fixed[i] && !fixed[j]) continue;
      if (!fixed[i]) rhs.col(i) -= lower_[s] * values.col(j);
      if (!fixed[j]) rhs.col(j) -= lower_[s].transpose() * values.col(i);
      lower_[s].setZero();
    }
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
  for (int i = 0; i < size(); ++i) {
    for (int s = row_begin_[i]; s < row_begin_[i + 1]; ++s) {
      const int j = columns_[s];
      Eigen::Matrix3d& block = lower_[s];
      if (confined[j]) rhs.col(i) -= block * values.col(j);
      if (confined[i]) rhs.col(j) -= block.transpose() * values.col(i);
      if (confined[j]) block -= (block * normals.col(j)).eval() * normals.col(j).transpose();
      if (confined[i]) block -= normals.col(i) * (normals.col(i).transpose() * block).eval();
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
