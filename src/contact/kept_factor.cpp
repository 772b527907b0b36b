#include "haptex/contact/kept_factor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "haptex/contact/panel_kernels.h"
#include "haptex/linear/dense_kernels.h"

namespace haptex::contact {
namespace {

// Block columns of a node: more of them cost more to invert, fewer make the products short.
constexpr int kMaxColumns = 8;

int padded(int numbers) { return (numbers + kPanelLanes - 1) / kPanelLanes * kPanelLanes; }

}  // namespace

KeptFactor::KeptFactor(const linear::SymmetricBlockMatrix& pattern) {
  const linear::Elimination elimination = linear::analyse(pattern);
  order_ = elimination.order;
  position_ = elimination.position;
  makeNodes(elimination);
  makeEntries(pattern);
  makeSources();
  int tallest = 0;
  std::size_t largest = 0;
  for (const Node& node : nodes_) {
    tallest = std::max(tallest, node.leading);
    largest = std::max(largest, std::size_t{3} * node.width * node.leading);
  }
  const std::size_t size =
      nodes_.back().offset + std::size_t{3} * nodes_.back().width * nodes_.back().leading;
  lower_.resize(size);
  inverses_.resize(size);
  panel_.resize(largest);
  product_.resize(std::size_t{3} * kMaxColumns * tallest);
  transposed_.resize(std::size_t{9} * kMaxColumns * kMaxColumns);
  front_.resize(tallest);
  values_.resize(std::size_t{3} * pattern.size());
}

void KeptFactor::makeNodes(const linear::Elimination& elimination) {
  node_of_.resize(elimination.order.size());
  std::size_t offset = 0;
  for (const linear::Supernode& supernode : elimination.supernodes) {
    const int parts = (supernode.width() + kMaxColumns - 1) / kMaxColumns;
    for (int part = 0; part < parts; ++part) {
      const int first = supernode.first + supernode.width() * part / parts;
      const int end = supernode.first + supernode.width() * (part + 1) / parts;
      const int first_row = static_cast<int>(rows_.size());
      for (int k = end; k < supernode.end; ++k) rows_.push_back(k);
      rows_.insert(rows_.end(), supernode.rows.begin(), supernode.rows.end());
      const int count = static_cast<int>(rows_.size()) - first_row;
      const int height = 3 * (end - first + count);
      for (int k = first; k < end; ++k) node_of_[k] = static_cast<int>(nodes_.size());
      nodes_.push_back({first, end - first, first_row, count, height, padded(height), offset, 0, 0,
                        0, 0, 4.5 * (end - first) * (end - first) * height});
      offset += std::size_t{3} * (end - first) * padded(height);
    }
  }
}

/// Where a column or row of a node is in its panel, in blocks.
int KeptFactor::placeOf(const Node& node, int row) const {
  if (row < node.first + node.width) return row - node.first;
  const auto begin = rows_.begin() + node.first_row;
  return node.width +
         static_cast<int>(std::lower_bound(begin, begin + node.row_count, row) - begin);
}

void KeptFactor::makeEntries(const linear::SymmetricBlockMatrix& pattern) {
  std::vector<std::vector<Entry>> entries(nodes_.size());
  const auto add = [&](int row, int column, int slot) {
    int below = position_[row], right = position_[column];
    const bool transposed = below < right;
    if (transposed) std::swap(below, right);
    const Node& node = nodes_[node_of_[right]];
    const int offset = 3 * node.leading * (right - node.first) + 3 * placeOf(node, below);
    entries[node_of_[right]].push_back({slot, offset, transposed});
  };
  for (int i = 0; i < pattern.size(); ++i) {
    add(i, i, -1 - i);
    for (int s = pattern.rowBegin(i); s < pattern.rowBegin(i + 1); ++s) {
      add(i, pattern.column(s), s);
    }
  }
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    nodes_[n].first_entry = static_cast<int>(entries_.size());
    entries_.insert(entries_.end(), entries[n].begin(), entries[n].end());
    nodes_[n].end_entry = static_cast<int>(entries_.size());
  }
}

void KeptFactor::makeSources() {
  std::vector<std::vector<Source>> sources(nodes_.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const Node& from = nodes_[n];
    const int* rows = rows_.data() + from.first_row;
    for (int begin = 0, end = 0; begin < from.row_count; begin = end) {
      const int target = node_of_[rows[begin]];
      while (end < from.row_count && node_of_[rows[end]] == target) ++end;
      sources[target].push_back(
          {static_cast<int>(n), begin, end, static_cast<int>(places_.size())});
      for (int r = begin; r < from.row_count; ++r) {
        places_.push_back(3 * placeOf(nodes_[target], rows[r]));
      }
      nodes_[target].cost += 9.0 * from.width * (end - begin) * 3.0 * (from.row_count - begin);
    }
  }
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    nodes_[n].first_source = static_cast<int>(sources_.size());
    sources_.insert(sources_.end(), sources[n].begin(), sources[n].end());
    nodes_[n].end_source = static_cast<int>(sources_.size());
    cost_ += nodes_[n].cost;
  }
}

void KeptFactor::load(const Node& node, const linear::SymmetricBlockMatrix& matrix) {
  std::fill_n(panel_.data(), std::size_t{3} * node.width * node.leading, 0.0f);
  for (int e = node.first_entry; e < node.end_entry; ++e) {
    const Entry& entry = entries_[e];
    const double* block =
        (entry.slot < 0 ? matrix.diagonal(-1 - entry.slot) : matrix.lower(entry.slot)).data();
    float* place = panel_.data() + entry.offset;
    const int across = entry.transposed ? 3 : 1, down = entry.transposed ? 1 : 3;
    for (int c = 0; c < 3; ++c, place += node.leading) {
      for (int r = 0; r < 3; ++r) {
        place[r] = static_cast<float>(scale_ * block[across * r + down * c]);
      }
    }
  }
}

/// Subtracts what an earlier node contributes.
void KeptFactor::subtractSource(const Source& source, const Node& node) {
  const Node& from = nodes_[source.node];
  const int height = 3 * (from.row_count - source.begin);
  const int columns = 3 * (source.end - source.begin);
  const float* rows = lower_.data() + from.offset + 3 * (from.width + source.begin);
  std::fill_n(product_.data(), static_cast<std::size_t>(height) * columns, 0.0f);
  linear::subtractProduct(height, columns, 3 * from.width, rows, from.leading, rows, from.leading,
                          product_.data(), height);
  const int* places = places_.data() + source.first_place;
  for (int c = 0; c < columns; ++c) {
    float* target =
        panel_.data() + static_cast<std::size_t>(node.leading) * (places[c / 3] + c % 3);
    const float* value = product_.data() + static_cast<std::size_t>(height) * c;
    for (int r = c / 3; r < height / 3; ++r) {
      float* to = target + places[r];
      to[0] += value[3 * r];
      to[1] += value[3 * r + 1];
      to[2] += value[3 * r + 2];
    }
  }
}

bool KeptFactor::factorisePanel(const Node& node) {
  const int ld = node.leading;
  float* const base = panel_.data();
  for (int c = 0; c < 3 * node.width; c += 3) {
    float* const top = base + static_cast<std::size_t>(ld) * c + c;
    if (c > 0) {
      linear::subtractProduct(node.height - c, 3, c, base + c, ld, base + c, ld, top, ld);
    }
    if (!linear::factoriseThreeColumns(node.height - c, top, ld)) return false;
  }
  return true;
}

/// Makes [L11^-1; -L21 L11^-1] of a panel of L, whose diagonal is stored inverted.
void KeptFactor::invertPanel(const Node& node) {
  const int width = 3 * node.width, ld = node.leading;
  const float* const l = panel_.data();
  float* const result = inverses_.data() + node.offset;
  std::fill_n(result, static_cast<std::size_t>(width) * ld, 0.0f);
  for (int j = 0; j < width; ++j) {
    float* const column = result + static_cast<std::size_t>(ld) * j;
    column[j] = 1.0f;
    for (int k = j; k < width; ++k) {
      const float* const below = l + static_cast<std::size_t>(ld) * k;
      column[k] *= below[k];
      for (int i = k + 1; i < width; ++i) column[i] -= below[i] * column[k];
      transposed_[j + width * k] = column[k];
    }
    for (int k = 0; k < j; ++k) transposed_[j + width * k] = 0.0f;
  }
  const int below = node.height - width;
  if (below == 0) return;
  linear::subtractProduct(below, width, width, l + width, ld, transposed_.data(), width,
                          result + width, ld);
}

bool KeptFactor::renewNode(int index, const linear::SymmetricBlockMatrix& matrix) {
  const Node& node = nodes_[index];
  load(node, matrix);
  for (int s = node.first_source; s < node.end_source; ++s) subtractSource(sources_[s], node);
  if (!factorisePanel(node)) return false;
  std::copy_n(panel_.data(), std::size_t{3} * node.width * node.leading,
              lower_.data() + node.offset);
  invertPanel(node);
  return true;
}

bool KeptFactor::factorise(const linear::SymmetricBlockMatrix& matrix) {
  double largest = 0.0;
  for (std::size_t i = 0; i < order_.size(); ++i) {
    largest = std::max(largest, matrix.diagonal(static_cast<int>(i)).diagonal().maxCoeff());
  }
  if (!(largest > 0.0 && std::isfinite(largest))) return false;
  scale_ = 1.0 / largest;
  next_ = 0;
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    if (!renewNode(static_cast<int>(n), matrix)) return false;
  }
  return true;
}

bool KeptFactor::renew(const linear::SymmetricBlockMatrix& matrix, double share) {
  bool sound = true;
  const int count = static_cast<int>(nodes_.size());
  double left = share * cost_;
  for (int n = 0; n < count && left > 0.0; ++n) {
    left -= nodes_[next_].cost;
    sound = renewNode(next_, matrix) && sound;
    next_ = (next_ + 1) % count;
  }
  return sound;
}

void KeptFactor::solve(const linear::BlockVector& r, linear::BlockVector& z) {
  const int n = static_cast<int>(order_.size());
  const double largest = r.leftCols(n).cwiseAbs().maxCoeff();
  const double size = largest > 0.0 ? largest : 1.0;
  const double by = 1.0 / size;
  for (int k = 0; k < n; ++k) {
    const double* from = r.data() + std::ptrdiff_t{3} * order_[k];
    for (int c = 0; c < 3; ++c) values_[3 * k + c] = static_cast<float>(by * from[c]);
  }
  for (const Node& node : nodes_) forward(node);
  for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node) backward(*node);
  const double back = size * scale_;
  for (int k = 0; k < n; ++k) {
    double* to = z.data() + std::ptrdiff_t{3} * order_[k];
    for (int c = 0; c < 3; ++c) to[c] = back * values_[3 * k + c];
  }
}

void KeptFactor::forward(const Node& node) {
  const int width = 3 * node.width;
  float* const own = values_.data() + 3 * node.first;
  multiplyPanel(node.leading, width, inverses_.data() + node.offset, own, front_.data());
  const float* change = front_.data();
  for (int i = 0; i < width; ++i) own[i] = *change++;
  for (const int *row = rows_.data() + node.first_row, *end = row + node.row_count; row != end;
       ++row, change += 3) {
    float* const to = values_.data() + 3 * *row;
    to[0] += change[0];
    to[1] += change[1];
    to[2] += change[2];
  }
}

void KeptFactor::backward(const Node& node) {
  const int width = 3 * node.width;
  float* const own = values_.data() + 3 * node.first;
  float* to = front_.data();
  for (int i = 0; i < width; ++i) *to++ = own[i];
  for (const int *row = rows_.data() + node.first_row, *end = row + node.row_count; row != end;
       ++row, to += 3) {
    const float* const from = values_.data() + 3 * *row;
    to[0] = from[0];
    to[1] = from[1];
    to[2] = from[2];
  }
  for (float* const end = front_.data() + node.leading; to != end; ++to) *to = 0.0f;
  multiplyTransposed(node.leading, width, inverses_.data() + node.offset, front_.data(), own);
}

}  // namespace haptex::contact
