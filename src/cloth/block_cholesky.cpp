#include "haptex/cloth/block_cholesky.h"

#include <algorithm>
#include <cmath>

#include "haptex/cloth/dense_kernels.h"

namespace haptex::cloth {

BlockCholesky::BlockCholesky(const SymmetricBlockMatrix& pattern)
    : elimination_(analyse(pattern)),
      cost_(factorisationCost(elimination_)),
      permuted_(3, pattern.size()) {
  const std::size_t count = elimination_.supernodes.size();
  std::size_t size = 0;
  std::size_t largest_update = 0;
  for (const Supernode& supernode : elimination_.supernodes) {
    const int leading = 3 * (supernode.width() + static_cast<int>(supernode.rows.size()));
    panel_of_.push_back({size, leading});
    size += static_cast<std::size_t>(leading) * 3 * supernode.width();
  }
  panels_.resize(size);
  for (const Supernode& supernode : elimination_.supernodes) {
    // The widest stretch of rows that falls into one later supernode.
    const auto& rows = supernode.rows;
    for (std::size_t begin = 0, end = 0; begin < rows.size(); begin = end) {
      while (end < rows.size() &&
             elimination_.supernode_of[rows[end]] == elimination_.supernode_of[rows[begin]]) {
        ++end;
      }
      largest_update = std::max(largest_update, 9 * (end - begin) * (rows.size() - begin));
    }
  }
  update_.resize(largest_update);
  first_descendant_.resize(count);
  next_descendant_.resize(count);
  next_row_.resize(count);
  panel_row_.resize(pattern.size());

  for (int i = 0; i < pattern.size(); ++i) {
    diagonal_entries_.push_back(entryOf(elimination_.position[i], elimination_.position[i]));
    for (int s = pattern.rowBegin(i); s < pattern.rowBegin(i + 1); ++s) {
      lower_entries_.push_back(
          entryOf(elimination_.position[i], elimination_.position[pattern.column(s)]));
    }
  }
}

BlockCholesky::Entry BlockCholesky::entryOf(int row, int column) const {
  const bool transposed = row < column;
  if (transposed) std::swap(row, column);
  const int s = elimination_.supernode_of[column];
  const Supernode& supernode = elimination_.supernodes[s];
  int local = row - supernode.first;
  if (row >= supernode.end) {
    const auto found = std::lower_bound(supernode.rows.begin(), supernode.rows.end(), row);
    local = supernode.width() + static_cast<int>(found - supernode.rows.begin());
  }
  const Panel& panel = panel_of_[s];
  const std::size_t offset =
      panel.offset + static_cast<std::size_t>(panel.leading) * 3 * (column - supernode.first) +
      3 * local;
  return {offset, panel.leading, transposed};
}

void BlockCholesky::load(const SymmetricBlockMatrix& matrix) {
  std::fill(panels_.begin(), panels_.end(), 0.0);
  const auto put = [this](const Entry& entry, const Eigen::Matrix3d& block) {
    double* target = panels_.data() + entry.offset;
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) {
        target[c * entry.leading + r] = entry.transposed ? block(c, r) : block(r, c);
      }
    }
  };
  const int size = static_cast<int>(diagonal_entries_.size());
  const int lower_count = static_cast<int>(lower_entries_.size());
  for (int i = 0; i < size; ++i) put(diagonal_entries_[i], matrix.diagonal(i));
  for (int s = 0; s < lower_count; ++s) put(lower_entries_[s], matrix.lower(s));
}

void BlockCholesky::applyDescendant(int descendant, int target) {
  const Supernode& source = elimination_.supernodes[descendant];
  const Supernode& sink = elimination_.supernodes[target];
  const Panel& from = panel_of_[descendant];
  const Panel& to = panel_of_[target];
  const int begin = next_row_[descendant];
  const int total = static_cast<int>(source.rows.size());
  int end = begin;
  while (end < total && source.rows[end] < sink.end) ++end;

  const int height = 3 * (total - begin);
  const int width = 3 * (end - begin);
  std::fill_n(update_.begin(), static_cast<std::size_t>(height) * width, 0.0);
  const double* rows = panels_.data() + from.offset + 3 * (source.width() + begin);
  subtractProduct(height, width, 3 * source.width(), rows, from.leading, rows, from.leading,
                  update_.data(), height);
  for (int b = begin; b < end; ++b) {
    const double* column = update_.data() + static_cast<std::size_t>(height) * 3 * (b - begin);
    double* destination = panels_.data() + to.offset +
                          static_cast<std::size_t>(to.leading) * 3 * (source.rows[b] - sink.first);
    for (int c = 0; c < 3; ++c, column += height, destination += to.leading) {
      for (int a = b; a < total; ++a) {
        const double* value = column + 3 * (a - begin);
        double* place = destination + 3 * panel_row_[source.rows[a]];
        place[0] += value[0];
        place[1] += value[1];
        place[2] += value[2];
      }
    }
  }

  next_row_[descendant] = end;
  if (end < total) {
    const int later = elimination_.supernode_of[source.rows[end]];
    next_descendant_[descendant] = first_descendant_[later];
    first_descendant_[later] = descendant;
  }
}

bool BlockCholesky::factorisePanel(int target) {
  constexpr int kGroup = 12;  // columns that are finished before the next product
  const Panel& panel = panel_of_[target];
  const int columns = 3 * elimination_.supernodes[target].width();
  const int ld = panel.leading;
  double* const base = panels_.data() + panel.offset;
  for (int group = 0; group < columns; group += kGroup) {
    const int group_end = std::min(group + kGroup, columns);
    subtractProduct(ld - group, group_end - group, group, base + group, ld, base + group, ld,
                    base + static_cast<std::size_t>(ld) * group + group, ld);
    for (int c = group; c < group_end; ++c) {
      double* column = base + static_cast<std::size_t>(ld) * c;
      for (int k = group; k < c; ++k) {
        const double* left = base + static_cast<std::size_t>(ld) * k;
        const double factor = left[c];
        for (int r = c; r < ld; ++r) column[r] -= factor * left[r];
      }
      if (!(column[c] > 0.0) || !std::isfinite(column[c])) return false;
      const double inverse = 1.0 / std::sqrt(column[c]);
      for (int r = c; r < ld; ++r) column[r] *= inverse;
    }
  }
  return true;
}

bool BlockCholesky::factorise(const SymmetricBlockMatrix& matrix) {
  load(matrix);
  std::fill(first_descendant_.begin(), first_descendant_.end(), -1);
  for (int s = 0; s < static_cast<int>(elimination_.supernodes.size()); ++s) {
    const Supernode& supernode = elimination_.supernodes[s];
    for (int k = 0; k < supernode.width(); ++k) panel_row_[supernode.first + k] = k;
    for (std::size_t r = 0; r < supernode.rows.size(); ++r) {
      panel_row_[supernode.rows[r]] = supernode.width() + static_cast<int>(r);
    }
    for (int d = first_descendant_[s]; d != -1;) {
      const int next = next_descendant_[d];
      applyDescendant(d, s);
      d = next;
    }
    if (!factorisePanel(s)) return false;
    next_row_[s] = 0;
    if (!supernode.rows.empty()) {
      const int later = elimination_.supernode_of[supernode.rows.front()];
      next_descendant_[s] = first_descendant_[later];
      first_descendant_[later] = s;
    }
  }
  return true;
}

void BlockCholesky::solve(BlockVector& x) {
  const int n = static_cast<int>(permuted_.cols());
  for (int k = 0; k < n; ++k) permuted_.col(k) = x.col(elimination_.order[k]);
  double* const values = permuted_.data();

  for (std::size_t s = 0; s < panel_of_.size(); ++s) {  // L y = b
    const Supernode& supernode = elimination_.supernodes[s];
    const int ld = panel_of_[s].leading;
    const int width = 3 * supernode.width();
    double* const own = values + 3 * supernode.first;
    for (int c = 0; c < width; ++c) {
      const double* column =
          panels_.data() + panel_of_[s].offset + static_cast<std::size_t>(ld) * c;
      own[c] /= column[c];
      for (int r = c + 1; r < width; ++r) own[r] -= column[r] * own[c];
      const double* below = column + width;
      for (int row : supernode.rows) {
        double* other = values + 3 * row;
        other[0] -= below[0] * own[c];
        other[1] -= below[1] * own[c];
        other[2] -= below[2] * own[c];
        below += 3;
      }
    }
  }
  for (std::size_t s = panel_of_.size(); s-- > 0;) {  // L^T x = y
    const Supernode& supernode = elimination_.supernodes[s];
    const int ld = panel_of_[s].leading;
    const int width = 3 * supernode.width();
    double* const own = values + 3 * supernode.first;
    for (int c = width - 1; c >= 0; --c) {
      const double* column =
          panels_.data() + panel_of_[s].offset + static_cast<std::size_t>(ld) * c;
      double sum = own[c];
      const double* below = column + width;
      for (int row : supernode.rows) {
        const double* other = values + 3 * row;
        sum -= below[0] * other[0] + below[1] * other[1] + below[2] * other[2];
        below += 3;
      }
      for (int r = c + 1; r < width; ++r) sum -= column[r] * own[r];
      own[c] = sum / column[c];
    }
  }
  for (int k = 0; k < n; ++k) x.col(elimination_.order[k]) = permuted_.col(k);
}

}  // namespace haptex::cloth
