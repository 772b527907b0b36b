// Which of some items belong together.
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace haptex::base {

/// Disjoint sets of the items 0, 1, ... (union-find with halved paths: Tarjan and van Leeuwen,
/// Worst-case analysis of set union algorithms, J. ACM 31, 1984). At first each item is alone.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t items) : parents_(items) {
    std::iota(parents_.begin(), parents_.end(), 0);
  }

  /// The item that stands for all of the set. @param item >= 0, < items
  int root(int item) {
    while (parents_[item] != item) item = parents_[item] = parents_[parents_[item]];
    return item;
  }

  /// Makes one set of two; the root of the first stands for it.
  void join(int first, int second) { parents_[root(second)] = root(first); }

 private:
  std::vector<int> parents_;
};

}  // namespace haptex::base
