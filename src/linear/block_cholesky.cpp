#include "haptex/linear/block_cholesky.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <type_traits>

#include "haptex/linear/shared_rows.h"

// The steps of a factorisation. The order of elimination and the panels, each a supernode as a
// dense column-major matrix with its square at the diagonal above the rows below, are those of
// analyse().
//   1. load(): the blocks of A go to their places in the panel that is next, the target.
//   2. applyDescendant(): every earlier panel that has rows among the target's columns subtracts
//      the product of its rows from it. Left-looking: a panel is written once, when all that acts
//      on it is known, and needs no memory for updates of others.
//   3. factoriseNarrow() or factoriseWide(): dense Cholesky within the panel.
//   4. The panel joins the list of the next target that it acts on: that of its first row below.
// Panels of one subtree of the elimination tree act on each other and on the top only, so that
// subtrees are factorised side by side, and then the top, whose large panels are shared by rows.
// Ng and Peyton, Block sparse Cholesky algorithms on advanced uniprocessor computers, SIAM J. Sci.
// Comput. 14 (1993).
namespace haptex::linear {
namespace {

constexpr double kMinCut = 1e7;    // operations of a factorisation that is worth cutting
constexpr double kMaxPart = 0.06;  // of all operations, in one subtree
constexpr int kBlockColumns = 48;  // of a wide panel that are factorised together
constexpr int kShareRows = 96;     // of a wide panel that a thread takes at a time
constexpr int kFetchAhead = 8;     // entries before their blocks are read

}  // namespace

template <typename T>
BasicBlockCholesky<T>::BasicBlockCholesky(const SymmetricBlockMatrix& pattern, ThreadPool* pool)
    : BasicBlockCholesky(pattern, analyse(pattern), pool) {}

template <typename T>
BasicBlockCholesky<T>::BasicBlockCholesky(const SymmetricBlockMatrix& pattern,
                                          const Elimination& elimination, ThreadPool* pool,
                                          std::vector<T>* memory)
    : elimination_(elimination),
      pool_(pool),
      cost_(factorisationCost(elimination_)),
      permuted_(3, pattern.size()) {
  const std::size_t count = elimination_.supernodes.size();
  makePanels(memory);
  cutTree();
  makeEntries(pattern);
  first_descendant_.resize(count);
  next_descendant_.resize(count);
  next_row_.resize(count);
  int tallest = 0;
  for (const Panel& panel : panel_of_) tallest = std::max(tallest, panel.leading);
  work_.resize(pool ? pool->threads() : 1);
  for (Workspace& work : work_) {
    work.panel_row.resize(pattern.size());
    work.columns.resize(std::size_t{3} * kUpdateColumns * tallest);
    work.runs.resize(tallest / 3);
    work.front.resize(tallest);
  }
  outside_.resize(top_.empty() ? 0 : std::size_t{3} * kGroups * top_columns_);
  if constexpr (std::is_same_v<T, float>) {
    scales_.resize(3, pattern.size());
    largest_.assign(std::max(1, sharesOf(pattern.size())), 0.0);
  }
}

/// Panels lie in memory in the order in which they are factorised. What is there does not matter:
/// load() begins with zeros. Lent memory gets an eighth more than is needed, for later factors.
template <typename T>
void BasicBlockCholesky<T>::makePanels(std::vector<T>* lent) {
  std::size_t size = 0;
  for (const Supernode& supernode : elimination_.supernodes) {
    const int below = static_cast<int>(supernode.rows.size());
    const int leading = 3 * (supernode.width() + below);
    panel_of_.push_back({size, leading, 0, 0, below});
    size += static_cast<std::size_t>(leading) * 3 * supernode.width();
  }
  std::vector<T>& memory = lent ? *lent : own_memory_;
  if (memory.capacity() < size) {
    memory = std::vector<T>();  // nothing to be copied
    memory.reserve(lent ? size + size / 8 : size);
  }
  memory.resize(size);
  panels_ = memory.data();
  numbers_ = size;
}

/// Takes the root off the costliest subtree until none is too large, and puts the subtrees into
/// groups of about the same cost.
template <typename T>
void BasicBlockCholesky<T>::cutTree() {
  const int count = static_cast<int>(elimination_.supernodes.size());
  std::vector<double> cost(count, 0.0);
  std::vector<std::vector<int>> children(count + 1);  // of the forest's roots: the last
  std::vector<int> first(count);                      // supernode of the subtree
  for (int s = 0; s < count; ++s) {
    const Supernode& supernode = elimination_.supernodes[s];
    cost[s] += supernodeCost(supernode);
    first[s] = children[s].empty() ? s : first[children[s].front()];
    const int parent =
        supernode.rows.empty() ? count : elimination_.supernode_of[supernode.rows.front()];
    children[parent].push_back(s);
    if (parent < count) cost[parent] += cost[s];
  }
  top_place_.assign(elimination_.order.size(), -1);
  std::vector<int> roots = children[count];
  // What remains of a subtree without its root are its children's: a cut through the tree comes
  // down where the work is.
  const auto cheaper = [&](int a, int b) { return cost[a] < cost[b]; };
  while (cost_ > kMinCut) {
    const auto costliest = std::max_element(roots.begin(), roots.end(), cheaper);
    if (cost[*costliest] <= kMaxPart * cost_) break;
    const int root = *costliest;
    roots.erase(costliest);
    top_.push_back(root);
    roots.insert(roots.end(), children[root].begin(), children[root].end());
  }
  std::sort(top_.begin(), top_.end());
  std::sort(roots.begin(), roots.end());
  for (int s : top_) {
    panel_of_[s].inner_rows = -1;
    const Supernode& supernode = elimination_.supernodes[s];
    for (int k = supernode.first; k < supernode.end; ++k) top_place_[k] = top_columns_++;
  }
  // Neighbours in the postorder share the columns that they act on, so groups are runs of them.
  double all = 0.0, done = 0.0;
  for (int root : roots) all += cost[root];
  for (int root : roots) {
    const int group = std::min(kGroups - 1, static_cast<int>(kGroups * done / all));
    subtrees_.push_back({first[root], root + 1, top_.empty() ? 0 : group});
    done += cost[root];
    for (int s = first[root]; s <= root; ++s) {
      const auto& rows = elimination_.supernodes[s].rows;
      panel_of_[s].inner_rows = static_cast<int>(
          std::lower_bound(rows.begin(), rows.end(), elimination_.supernodes[root].end) -
          rows.begin());
    }
  }
}

/// A block goes to the panel of the one of its two particles that is eliminated first.
template <typename T>
void BasicBlockCholesky<T>::makeEntries(const SymmetricBlockMatrix& pattern) {
  std::vector<std::vector<Entry>> entries_of(elimination_.supernodes.size());
  const auto add_entry = [&](int row, int column, int slot) {
    const int first = std::min(elimination_.position[row], elimination_.position[column]);
    entries_of[elimination_.supernode_of[first]].push_back(entryOf(row, column, slot));
  };
  for (int i = 0; i < pattern.size(); ++i) {
    add_entry(i, i, -1 - i);
    for (int s = pattern.rowBegin(i); s < pattern.rowBegin(i + 1); ++s) {
      add_entry(i, pattern.column(s), s);
    }
  }
  for (std::size_t s = 0; s < entries_of.size(); ++s) {
    panel_of_[s].first_entry = static_cast<int>(entries_.size());
    entries_.insert(entries_.end(), entries_of[s].begin(), entries_of[s].end());
    panel_of_[s].end_entry = static_cast<int>(entries_.size());
  }
  entries_.shrink_to_fit();
}

/// Place of a block of the matrix.
template <typename T>
typename BasicBlockCholesky<T>::Entry BasicBlockCholesky<T>::entryOf(int row, int column,
                                                                     int slot) const {
  int below = elimination_.position[row], right = elimination_.position[column];
  const bool transposed = below < right;
  if (transposed) std::swap(below, right);
  const int s = elimination_.supernode_of[right];
  const Supernode& supernode = elimination_.supernodes[s];
  int local = below - supernode.first;
  if (below >= supernode.end) {
    const auto found = std::lower_bound(supernode.rows.begin(), supernode.rows.end(), below);
    local = supernode.width() + static_cast<int>(found - supernode.rows.begin());
  }
  const int offset = panel_of_[s].leading * 3 * (right - supernode.first) + 3 * local;
  return {slot, offset, transposed, row, column};
}

/// @returns false if a diagonal number is not positive and finite
template <typename T>
bool BasicBlockCholesky<T>::computeScales(const SymmetricBlockMatrix& matrix) {
  std::atomic<bool> sound{true};
  shareRows(pool_, static_cast<int>(scales_.cols()), [&](int begin, int end) {
    bool part_is_sound = true;
    for (int i = begin; i < end; ++i) {
      for (int c = 0; c < 3; ++c) {
        const double number = matrix.diagonal(i)(c, c);
        part_is_sound = part_is_sound && number > 0.0 && std::isfinite(number);
        scales_(c, i) = 1.0 / std::sqrt(number);
      }
    }
    if (!part_is_sound) sound = false;
  });
  return sound;
}

/// Zeros where the factor fills in, and the matrix's blocks at their places.
template <typename T>
void BasicBlockCholesky<T>::load(const SymmetricBlockMatrix& matrix, int target, T shift) {
  const Panel& panel = panel_of_[target];
  T* const base = panels_ + panel.offset;
  const int columns = 3 * elimination_.supernodes[target].width();
  std::fill_n(base, static_cast<std::size_t>(panel.leading) * columns, T(0));
  const auto block_of = [&matrix](const Entry& entry) -> const Eigen::Matrix3d& {
    return entry.slot < 0 ? matrix.diagonal(-1 - entry.slot) : matrix.lower(entry.slot);
  };
  const int last = static_cast<int>(entries_.size()) - 1;
  for (int e = panel.first_entry; e < panel.end_entry; ++e) {
    const Entry& entry = entries_[e];
    // The blocks lie in the order of the particles, anywhere in memory.
    const double* const ahead = block_of(entries_[std::min(last, e + kFetchAhead)]).data();
    __builtin_prefetch(ahead);
    __builtin_prefetch(ahead + 8);
    Eigen::Matrix3d block = block_of(entry);
    if constexpr (std::is_same_v<T, float>) {
      for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) {
          block(r, c) *= scales_(r, entry.row) * scales_(c, entry.column);
        }
      }
      if (entry.slot < 0) block.diagonal().array() += shift;
    }
    T* place = base + entry.offset;
    for (int c = 0; c < 3; ++c, place += panel.leading) {
      for (int r = 0; r < 3; ++r) {
        place[r] = static_cast<T>(entry.transposed ? block(c, r) : block(r, c));
      }
    }
  }
}

/// Three columns at a time: what those before contribute, the 3x3 square, and the rows below.
template <typename T>
bool BasicBlockCholesky<T>::factoriseNarrow(int target) {
  const Panel& panel = panel_of_[target];
  const int columns = 3 * elimination_.supernodes[target].width();
  const int ld = panel.leading;
  T* const base = panels_ + panel.offset;
  for (int c = 0; c < columns; c += 3) {
    T* const top = base + static_cast<std::size_t>(ld) * c + c;
    if (c > 0) subtractProduct(ld - c, 3, c, base + c, ld, base + c, ld, top, ld);
    if (!factoriseThreeColumns(ld - c, top, ld)) return false;
  }
  return true;
}

/// Some columns at a time: first what those before contribute, by shares of the rows, then the
/// square at the diagonal, then the rows below it, by shares.
template <typename T>
bool BasicBlockCholesky<T>::factoriseWide(int target) {
  const int columns = 3 * elimination_.supernodes[target].width();
  const int ld = panel_of_[target].leading;
  T* const base = panels_ + panel_of_[target].offset;
  const auto at = [&](int row, int column) {
    return base + static_cast<std::size_t>(ld) * column + row;
  };
  for (int begin = 0; begin < columns; begin += kBlockColumns) {
    const int end = std::min(columns, begin + kBlockColumns);
    const int shares = (ld - begin + kShareRows - 1) / kShareRows;
    if (begin > 0) {
      share(shares, [&](int task, int) {
        const int row = begin + kShareRows * task;
        subtractProduct(std::min(kShareRows, ld - row), end - begin, begin, at(row, 0), ld,
                        at(begin, 0), ld, at(row, begin), ld);
      });
    }
    for (int c = begin; c < end; c += 3) {
      subtractProduct(end - c, 3, c - begin, at(c, begin), ld, at(c, begin), ld, at(c, c), ld);
      if (!factoriseThreeColumns(end - c, at(c, c), ld)) return false;
    }
    share((ld - end + kShareRows - 1) / kShareRows, [&](int task, int) {
      const int row = end + kShareRows * task;
      const int rows = std::min(kShareRows, ld - row);
      for (int c = begin; c < end; c += 3) {
        subtractProduct(rows, 3, c - begin, at(row, begin), ld, at(c, begin), ld, at(row, c), ld);
        divideThreeColumns(rows, at(c, c), ld, at(row, c), ld);
      }
    });
  }
  return true;
}

/// The subtrees of a group, one after the other, by one thread.
template <typename T>
void BasicBlockCholesky<T>::factoriseGroup(int group, const SymmetricBlockMatrix& matrix, T shift,
                                           Workspace& work) {
  for (const Subtree& subtree : subtrees_) {
    if (subtree.group != group) continue;
    for (int s = subtree.first; s < subtree.end && work.positive; ++s) {
      placeRows(s, work.panel_row);
      load(matrix, s, shift);
      for (int d = first_descendant_[s]; d != -1;) {
        const int next = next_descendant_[d];
        applyDescendant(d, s, 0, panel_of_[s].leading / 3, work.panel_row, work);
        advance(d, s, false);
        d = next;
      }
      work.positive = factoriseNarrow(s);
      next_row_[s] = 0;
      const auto& rows = elimination_.supernodes[s].rows;
      // The lists of the top's targets are made when all threads are done: collectTopDescendants().
      if (rows.empty() || top_place_[rows.front()] != -1) continue;
      const int later = elimination_.supernode_of[rows.front()];
      next_descendant_[s] = first_descendant_[later];
      first_descendant_[later] = s;
    }
  }
}

/// Lists the supernodes of the subtrees with the first supernode of the top that they update.
template <typename T>
void BasicBlockCholesky<T>::collectTopDescendants() {
  for (const Subtree& subtree : subtrees_) {
    for (int s = subtree.first; s < subtree.end; ++s) {
      const auto& rows = elimination_.supernodes[s].rows;
      if (next_row_[s] == static_cast<int>(rows.size())) continue;
      const int later = elimination_.supernode_of[rows[next_row_[s]]];
      next_descendant_[s] = first_descendant_[later];
      first_descendant_[later] = s;
    }
  }
}

/// A panel of the top: every thread applies all descendants to its share of the rows, always in the
/// order of the list.
template <typename T>
bool BasicBlockCholesky<T>::factoriseTop(int target, const SymmetricBlockMatrix& matrix, T shift) {
  std::vector<int>& panel_row = work_[0].panel_row;
  placeRows(target, panel_row);
  load(matrix, target, shift);
  const int rows = panel_of_[target].leading / 3;
  const int most = pool_ ? kShareRows / 3 : rows;  // no sum depends on it
  share((rows + most - 1) / most, [&](int task, int thread) {
    const int first = most * task;
    for (int d = first_descendant_[target]; d != -1; d = next_descendant_[d]) {
      applyDescendant(d, target, first, std::min(rows, first + most), panel_row, work_[thread]);
    }
  });
  for (int d = first_descendant_[target]; d != -1;) {
    const int next = next_descendant_[d];
    advance(d, target, true);
    d = next;
  }
  if (!factoriseWide(target)) return false;
  next_row_[target] = 0;
  const auto& below = elimination_.supernodes[target].rows;
  if (below.empty()) return true;
  const int later = elimination_.supernode_of[below.front()];
  next_descendant_[target] = first_descendant_[later];
  first_descendant_[later] = target;
  return true;
}

template <typename T>
bool BasicBlockCholesky<T>::factorise(const SymmetricBlockMatrix& matrix, T shift) {
  if constexpr (std::is_same_v<T, float>) {
    if (!computeScales(matrix)) return false;
  }
  std::fill(first_descendant_.begin(), first_descendant_.end(), -1);
  for (Workspace& work : work_) work.positive = true;
  share(top_.empty() ? 1 : kGroups,
        [&](int group, int thread) { factoriseGroup(group, matrix, shift, work_[thread]); });
  for (const Workspace& work : work_) {
    if (!work.positive) return false;
  }
  if (top_.empty()) return true;
  collectTopDescendants();
  for (int target : top_) {
    if (!factoriseTop(target, matrix, shift)) return false;
  }
  return true;
}

template class BasicBlockCholesky<double>;
template class BasicBlockCholesky<float>;

}  // namespace haptex::linear
