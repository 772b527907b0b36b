#include "haptex/cloth/block_cholesky.h"

#include <algorithm>

#include "haptex/cloth/dense_kernels.h"

namespace haptex::cloth {

BlockCholesky::BlockCholesky(const SymmetricBlockMatrix& pattern)
    : elimination_(analyse(pattern)),
      cost_(factorisationCost(elimination_)),
      permuted_(3, pattern.size()) {
  const std::size_t count = elimination_.supernodes.size();
  std::size_t size = 0;
  std::size_t largest_update = 0;
  int largest_front = 0;
  for (const Supernode& supernode : elimination_.supernodes) {
    const int leading = 3 * (supernode.width() + static_cast<int>(supernode.rows.size()));
    panel_of_.push_back({size, leading, 0, 0});
    largest_front = std::max(largest_front, leading);
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
  front_.resize(largest_front);
  first_descendant_.resize(count);
  next_descendant_.resize(count);
  next_row_.resize(count);
  panel_row_.resize(pattern.size());

  std::vector<std::vector<Entry>> entries_of(count);
  const auto addEntry = [&](int row, int column, int slot) {
    row = elimination_.position[row];
    column = elimination_.position[column];
    const Entry entry = entryOf(std::max(row, column), std::min(row, column), slot, row < column);
    entries_of[elimination_.supernode_of[std::min(row, column)]].push_back(entry);
  };
  for (int i = 0; i < pattern.size(); ++i) {
    addEntry(i, i, -1 - i);
    for (int s = pattern.rowBegin(i); s < pattern.rowBegin(i + 1); ++s) {
      addEntry(i, pattern.column(s), s);
    }
  }
  for (std::size_t s = 0; s < count; ++s) {
    panel_of_[s].first_entry = static_cast<int>(entries_.size());
    entries_.insert(entries_.end(), entries_of[s].begin(), entries_of[s].end());
    panel_of_[s].end_entry = static_cast<int>(entries_.size());
  }
}

/// Place of the block (row, column), row >= column, in the order of elimination.
BlockCholesky::Entry BlockCholesky::entryOf(int row, int column, int slot, bool transposed) const {
  const int s = elimination_.supernode_of[column];
  const Supernode& supernode = elimination_.supernodes[s];
  int local = row - supernode.first;
  if (row >= supernode.end) {
    const auto found = std::lower_bound(supernode.rows.begin(), supernode.rows.end(), row);
    local = supernode.width() + static_cast<int>(found - supernode.rows.begin());
  }
  return {slot, panel_of_[s].leading * 3 * (column - supernode.first) + 3 * local, transposed};
}

void BlockCholesky::load(const SymmetricBlockMatrix& matrix, int target) {
  const Panel& panel = panel_of_[target];
  double* const base = panels_.data() + panel.offset;
  const int columns = 3 * elimination_.supernodes[target].width();
  std::fill_n(base, static_cast<std::size_t>(panel.leading) * columns, 0.0);
  for (int e = panel.first_entry; e < panel.end_entry; ++e) {
    const Entry& entry = entries_[e];
    const Eigen::Matrix3d& block =
        entry.slot < 0 ? matrix.diagonal(-1 - entry.slot) : matrix.lower(entry.slot);
    double* place = base + entry.offset;
    for (int c = 0; c < 3; ++c, place += panel.leading) {
      for (int r = 0; r < 3; ++r) place[r] = entry.transposed ? block(c, r) : block(r, c);
    }
  }
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
  const double* rows = panels_.data() + from.offset + 3 * (source.width() + begin);
  multiplyByOwnTop(height, width, 3 * source.width(), rows, from.leading, update_.data(), height);
  for (int b = begin; b < end; ++b) {
    const double* column = update_.data() + static_cast<std::size_t>(height) * 3 * (b - begin);
    double* destination = panels_.data() + to.offset +
                          static_cast<std::size_t>(to.leading) * 3 * (source.rows[b] - sink.first);
    for (int c = 0; c < 3; ++c, column += height, destination += to.leading) {
      for (int a = b; a < total; ++a) {
        const double* value = column + 3 * (a - begin);
        double* place = destination + 3 * panel_row_[source.rows[a]];
        place[0] -= value[0];
        place[1] -= value[1];
        place[2] -= value[2];
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
  const Panel& panel = panel_of_[target];
  const int columns = 3 * elimination_.supernodes[target].width();
  const int ld = panel.leading;
  double* const base = panels_.data() + panel.offset;
  for (int c = 0; c < columns; c += 3) {
    double* const top = base + static_cast<std::size_t>(ld) * c + c;
    subtractProduct(ld - c, 3, c, base + c, ld, base + c, ld, top, ld);
    if (!factoriseThreeColumns(ld - c, top, ld)) return false;
  }
  return true;
}

bool BlockCholesky::factorise(const SymmetricBlockMatrix& matrix) {
  std::fill(first_descendant_.begin(), first_descendant_.end(), -1);
  for (int s = 0; s < static_cast<int>(elimination_.supernodes.size()); ++s) {
    const Supernode& supernode = elimination_.supernodes[s];
    for (int k = 0; k < supernode.width(); ++k) panel_row_[supernode.first + k] = k;
    for (std::size_t r = 0; r < supernode.rows.size(); ++r) {
      panel_row_[supernode.rows[r]] = supernode.width() + static_cast<int>(r);
    }
    load(matrix, s);
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
  double* const front = front_.data();  // the unknowns that a panel couples, in its order

  for (std::size_t s = 0; s < panel_of_.size(); ++s) {  // L y = b
    const Supernode& supernode = elimination_.supernodes[s];
    const Panel& panel = panel_of_[s];
    const int width = 3 * supernode.width();
    double* const own = values + 3 * supernode.first;
    std::copy_n(own, width, front);
    std::fill(front + width, front + panel.leading, 0.0);
    substituteForward(panel.leading, width, panels_.data() + panel.offset, panel.leading, front);
    std::copy_n(front, width, own);
    const double* change = front + width;
    for (int row : supernode.rows) {
      double* other = values + 3 * row;
      other[0] += change[0];
      other[1] += change[1];
      other[2] += change[2];
      change += 3;
    }
  }
  for (std::size_t s = panel_of_.size(); s-- > 0;) {  // L^T x = y
    const Supernode& supernode = elimination_.supernodes[s];
    const Panel& panel = panel_of_[s];
    const int width = 3 * supernode.width();
    double* const own = values + 3 * supernode.first;
    std::copy_n(own, width, front);
    double* below = front + width;
    for (int row : supernode.rows) {
      const double* other = values + 3 * row;
      below[0] = other[0];
      below[1] = other[1];
      below[2] = other[2];
      below += 3;
    }
    substituteBackward(panel.leading, width, panels_.data() + panel.offset, panel.leading, front);
    std::copy_n(front, width, own);
  }
  for (int k = 0; k < n; ++k) x.col(elimination_.order[k]) = permuted_.col(k);
}

}  // namespace haptex::cloth
