#include "haptex/linear/elimination.h"

#include <algorithm>
#include <iterator>

#include "haptex/linear/ordering.h"

namespace haptex::linear {
namespace {

std::vector<int> inverseOf(const std::vector<int>& order) {
  std::vector<int> position(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) position[order[k]] = static_cast<int>(k);
  return position;
}

/// For each column of P A P^T the rows of its entries above the diagonal, that is the earlier
/// columns that it is connected with.
std::vector<std::vector<int>> earlierNeighbours(const SymmetricBlockMatrix& pattern,
                                                const std::vector<int>& position) {
  std::vector<std::vector<int>> earlier(pattern.size());
  for (int i = 0; i < pattern.size(); ++i) {
    for (int s = pattern.rowBegin(i); s < pattern.rowBegin(i + 1); ++s) {
      const int a = position[i];
      const int b = position[pattern.column(s)];
      earlier[std::max(a, b)].push_back(std::min(a, b));
    }
  }
  return earlier;
}

/// Parent of each column in the elimination tree, -1 for a root (Liu 1986, path compression).
std::vector<int> eliminationTree(const std::vector<std::vector<int>>& earlier) {
  const int n = static_cast<int>(earlier.size());
  std::vector<int> parent(n, -1), ancestor(n, -1);
  for (int k = 0; k < n; ++k) {
    for (int i : earlier[k]) {
      while (i != -1 && i < k) {
        const int next = ancestor[i];
        ancestor[i] = k;
        if (next == -1) parent[i] = k;
        i = next;
      }
    }
  }
  return parent;
}

/// Columns in postorder of the tree, children in ascending order of index.
std::vector<int> postorder(const std::vector<int>& parent) {
  const int n = static_cast<int>(parent.size());
  std::vector<int> first_child(n, -1), next_sibling(n, -1), order, stack;
  for (int k = n - 1; k >= 0; --k) {
    if (parent[k] == -1) continue;
    next_sibling[k] = first_child[parent[k]];
    first_child[parent[k]] = k;
  }
  for (int root = 0; root < n; ++root) {
    if (parent[root] != -1) continue;
    stack.push_back(root);
    while (!stack.empty()) {
      const int top = stack.back();
      const int child = first_child[top];
      if (child == -1) {
        order.push_back(top);
        stack.pop_back();
      } else {
        first_child[top] = next_sibling[child];
        stack.push_back(child);
      }
    }
  }
  return order;
}

/// Rows below the diagonal of each column of the factor, ascending.
std::vector<std::vector<int>> factorColumns(const std::vector<std::vector<int>>& earlier,
                                            const std::vector<int>& parent) {
  const int n = static_cast<int>(earlier.size());
  std::vector<std::vector<int>> columns(n);
  for (int row = 0; row < n; ++row) {
    for (int column : earlier[row]) columns[column].push_back(row);
  }
  std::vector<int> merged;
  for (int k = 0; k < n; ++k) {
    std::sort(columns[k].begin(), columns[k].end());
    if (parent[k] == -1) continue;
    std::vector<int>& above = columns[parent[k]];
    std::sort(above.begin(), above.end());
    merged.clear();
    std::set_union(above.begin(), above.end(), columns[k].begin() + 1, columns[k].end(),
                   std::back_inserter(merged));
    above = merged;
  }
  return columns;
}

// Share of explicit zeros that a merged panel may hold. Of 0.05 to 0.3, 0.05 gave the shortest
// factorisation and the smallest factor (scripts/bench linear_solver).
constexpr double kMaxZeros = 0.05;
// Panels up to this many block columns are merged whatever zeros that brings: the dense kernels
// need a few columns to be worth their call. Of 1 to 8, 5 was best with and without bending.
constexpr int kNarrow = 5;

std::vector<Supernode> supernodesOf(const std::vector<std::vector<int>>& columns,
                                    const std::vector<int>& parent) {
  std::vector<Supernode> supernodes;
  std::vector<double> zeros;  // explicit zeros held by each, in blocks
  for (int k = 0; k < static_cast<int>(columns.size()); ++k) {
    supernodes.push_back({k, k + 1, columns[k]});
    zeros.push_back(0.0);
    // The postorder puts the last child right before its parent: try to take it up.
    while (supernodes.size() > 1) {
      const Supernode& child = supernodes[supernodes.size() - 2];
      const Supernode& last = supernodes.back();
      if (parent[child.end - 1] < last.first || parent[child.end - 1] >= last.end) break;
      const double missing = child.width() * (last.width() + static_cast<double>(last.rows.size()) -
                                              static_cast<double>(child.rows.size()));
      const double total_zeros = zeros[zeros.size() - 2] + zeros.back() + missing;
      const int width = child.width() + last.width();
      const double entries = width * (0.5 * (width + 1) + static_cast<double>(last.rows.size()));
      if (missing > 0.0 && width > kNarrow && total_zeros > kMaxZeros * entries) break;
      supernodes[supernodes.size() - 2] = {child.first, last.end, last.rows};
      supernodes.pop_back();
      zeros[zeros.size() - 2] = total_zeros;
      zeros.pop_back();
    }
  }
  return supernodes;
}

}  // namespace

Elimination analyse(const SymmetricBlockMatrix& pattern, const std::vector<int>& order) {
  Elimination result;
  const std::vector<int> post =
      postorder(eliminationTree(earlierNeighbours(pattern, inverseOf(order))));
  result.order.resize(post.size());
  for (std::size_t k = 0; k < post.size(); ++k) result.order[k] = order[post[k]];
  result.position = inverseOf(result.order);

  const auto earlier = earlierNeighbours(pattern, result.position);
  const std::vector<int> parent = eliminationTree(earlier);
  result.supernodes = supernodesOf(factorColumns(earlier, parent), parent);
  result.supernode_of.resize(pattern.size());
  for (std::size_t s = 0; s < result.supernodes.size(); ++s) {
    for (int k = result.supernodes[s].first; k < result.supernodes[s].end; ++k) {
      result.supernode_of[k] = static_cast<int>(s);
    }
  }
  return result;
}

Elimination analyse(const SymmetricBlockMatrix& pattern) {
  Elimination by_degree = analyse(pattern, minimumDegreeOrder(pattern));
  Elimination by_dissection = analyse(pattern, nestedDissectionOrder(pattern));
  const bool dissect = factorisationCost(by_dissection) < factorisationCost(by_degree);
  return dissect ? by_dissection : by_degree;
}

double supernodeCost(const Supernode& supernode) {
  double cost = 0.0;
  for (int k = 0; k < supernode.width(); ++k) {
    const double below = 3.0 * (supernode.width() - k + supernode.rows.size());
    cost += 3.0 * 0.5 * below * below;
  }
  return cost;
}

double factorisationCost(const Elimination& elimination) {
  double cost = 0.0;
  for (const Supernode& supernode : elimination.supernodes) cost += supernodeCost(supernode);
  return cost;
}

}  // namespace haptex::linear
