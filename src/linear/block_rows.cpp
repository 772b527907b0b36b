#include "haptex/linear/block_rows.h"

#include <Eigen/LU>
#include <algorithm>

namespace haptex::linear {

BlockRows::BlockRows(const SymmetricBlockMatrix& pattern) : begin_(pattern.size() + 1, 0) {
  const int size = pattern.size();
  for (int i = 0; i < size; ++i) {
    begin_[i + 1] += 1 + pattern.rowBegin(i + 1) - pattern.rowBegin(i);
    for (int s = pattern.rowBegin(i); s < pattern.rowBegin(i + 1); ++s) {
      ++begin_[pattern.column(s) + 1];
    }
  }
  for (int i = 0; i < size; ++i) begin_[i + 1] += begin_[i];
  columns_.resize(begin_[size]);
  sources_.resize(begin_[size]);
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  const auto add = [&](int row, int column, int source) {
    columns_[next[row]] = column;
    sources_[next[row]++] = source;
  };
  for (int i = 0; i < size; ++i) add(i, i, 0);
  for (int i = 0; i < size; ++i) {
    for (int s = pattern.rowBegin(i); s < pattern.rowBegin(i + 1); ++s) {
      add(i, pattern.column(s), s);
      add(pattern.column(s), i, ~s);
    }
  }
  allocate();
}

BlockRows::BlockRows(std::vector<int> begin, std::vector<int> columns)
    : begin_(std::move(begin)), columns_(std::move(columns)) {
  allocate();
}

void BlockRows::allocate() {
  blocks_.assign(9 * columns_.size() + 1, 0.0f);
  inverse_diagonal_.assign(9 * static_cast<std::size_t>(size()) + 1, 0.0f);
  is_alone_.assign(size(), 0);
}

void BlockRows::setZero() { std::fill(blocks_.begin(), blocks_.end(), 0.0f); }

void BlockRows::take(const SymmetricBlockMatrix& matrix, ThreadPool* pool) {
  shareRows(pool, size(), [&](int first, int end) {
    for (int i = first; i < end; ++i) {
      Eigen::Map<Eigen::Matrix3f>(block(begin_[i])) = matrix.diagonal(i).cast<float>();
      for (int s = begin_[i] + 1; s < begin_[i + 1]; ++s) {
        Eigen::Map<Eigen::Matrix3f> target(block(s));
        if (sources_[s] >= 0) {
          target = matrix.lower(sources_[s]).cast<float>();
        } else {
          target = matrix.lower(~sources_[s]).transpose().cast<float>();
        }
      }
    }
  });
  finish(pool);
}

void BlockRows::finish(ThreadPool* pool) {
  shareRows(pool, size(), [&](int first, int end) {
    for (int i = first; i < end; ++i) {
      const Eigen::Map<const Eigen::Matrix3f> diagonal(block(begin_[i]));
      Eigen::Map<Eigen::Matrix3f> inverse(&inverse_diagonal_[9 * static_cast<std::size_t>(i)]);
      inverse = diagonal.cast<double>().inverse().cast<float>();
      is_alone_[i] = std::all_of(block(begin_[i] + 1), block(begin_[i + 1]),
                                 [](float number) { return number == 0.0f; });
    }
  });
}

}  // namespace haptex::linear
