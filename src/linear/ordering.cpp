#include "haptex/linear/ordering.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "haptex/linear/separator.h"

namespace haptex::linear {
namespace {

// Parts of this many rows are not cut any further. Of 30 to 250, 30 gave the fewest operations.
constexpr int kLeaf = 30;
constexpr std::size_t kFewNeighbours = 4;

Graph graphOf(const SymmetricBlockMatrix& pattern) {
  Graph graph(pattern.size());
  for (int i = 0; i < pattern.size(); ++i) {
    for (int s = pattern.rowBegin(i); s < pattern.rowBegin(i + 1); ++s) {
      graph[i].push_back(pattern.column(s));
      graph[pattern.column(s)].push_back(i);
    }
  }
  for (std::vector<int>& neighbours : graph) std::sort(neighbours.begin(), neighbours.end());
  return graph;
}

/// Takes rows with few neighbours, none of them neighbours of each other, out of the graph and
/// connects their neighbours with each other.
std::vector<int> eliminateFewNeighbours(Graph& graph) {
  std::vector<int> eliminated;
  std::vector<char> touched(graph.size(), 0);
  for (int i = 0; i < static_cast<int>(graph.size()); ++i) {
    if (touched[i] || graph[i].size() > kFewNeighbours) continue;
    eliminated.push_back(i);
    for (int j : graph[i]) touched[j] = 1;
  }
  for (int i : eliminated) {
    for (int j : graph[i]) {
      std::vector<int>& row = graph[j];
      row.erase(std::remove(row.begin(), row.end(), i), row.end());
      for (int k : graph[i]) {
        if (k != j) row.push_back(k);
      }
    }
    graph[i].clear();
  }
  for (std::vector<int>& row : graph) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
  }
  return eliminated;
}

/// Minimum degree of a few rows, counting their neighbours outside, which are eliminated later.
class LeafOrder {
 public:
  LeafOrder(const Graph& graph, const std::vector<char>& ordered)
      : graph_(graph), ordered_(ordered), local_(graph.size(), -1) {}

  void append(const std::vector<int>& rows, std::vector<int>& order) {
    all_ = rows;
    for (std::size_t i = 0; i < all_.size(); ++i) local_[all_[i]] = static_cast<int>(i);
    for (int row : rows) {
      for (int other : graph_[row]) {
        if (local_[other] != -1 || ordered_[other]) continue;
        local_[other] = static_cast<int>(all_.size());
        all_.push_back(other);
      }
    }
    const std::size_t size = all_.size();
    connected_.assign(size, std::vector<char>(size, 0));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (int other : graph_[rows[i]]) {
        const int j = local_[other];
        if (j != -1) connected_[i][j] = connected_[j][i] = 1;
      }
    }
    for (int row : all_) local_[row] = -1;
    eliminate(static_cast<int>(rows.size()), order);
  }

 private:
  void eliminate(int count, std::vector<int>& order) {
    const int size = static_cast<int>(all_.size());
    std::vector<char> left(size, 1);
    std::vector<int> neighbours;
    for (int step = 0; step < count; ++step) {
      int best = -1, fewest = std::numeric_limits<int>::max();
      for (int i = 0; i < count; ++i) {
        if (!left[i]) continue;
        int degree = 0;
        for (int j = 0; j < size; ++j) degree += connected_[i][j];
        if (degree < fewest) {
          fewest = degree;
          best = i;
        }
      }
      order.push_back(all_[best]);
      left[best] = 0;
      neighbours.clear();
      for (int j = 0; j < size; ++j) {
        if (connected_[best][j]) neighbours.push_back(j);
        connected_[j][best] = 0;
      }
      for (int j : neighbours) {
        for (int k : neighbours) connected_[j][k] = j != k;
      }
    }
  }

  const Graph& graph_;
  const std::vector<char>& ordered_;
  std::vector<int> local_;
  std::vector<int> all_;
  std::vector<std::vector<char>> connected_;
};

}  // namespace

std::vector<int> minimumDegreeOrder(const SymmetricBlockMatrix& pattern) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < pattern.size(); ++i) {
    entries.emplace_back(i, i, 1.0);
    for (int s = pattern.rowBegin(i); s < pattern.rowBegin(i + 1); ++s) {
      entries.emplace_back(i, pattern.column(s), 1.0);
      entries.emplace_back(pattern.column(s), i, 1.0);
    }
  }
  Eigen::SparseMatrix<double> adjacency(pattern.size(), pattern.size());
  adjacency.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  Eigen::AMDOrdering<int>()(adjacency, permutation);
  return {permutation.indices().data(), permutation.indices().data() + pattern.size()};
}

std::vector<int> nestedDissectionOrder(const SymmetricBlockMatrix& pattern) {
  Graph graph = graphOf(pattern);
  std::vector<int> order = eliminateFewNeighbours(graph);
  std::vector<char> ordered(graph.size(), 0);
  for (int row : order) ordered[row] = 1;
  std::vector<int> last;  // the separators, in reverse
  std::vector<std::vector<int>> parts(1);
  for (int i = 0; i < pattern.size(); ++i) {
    if (!ordered[i]) parts[0].push_back(i);
  }
  SeparatorFinder finder(graph);
  LeafOrder leaf_order(graph, ordered);
  while (!parts.empty()) {
    const std::vector<int> part = std::move(parts.back());
    parts.pop_back();
    if (static_cast<int>(part.size()) <= kLeaf) {
      leaf_order.append(part, order);
      for (int row : part) ordered[row] = 1;
      continue;
    }
    Separation separation = finder.separate(part);
    last.insert(last.end(), separation.separator.rbegin(), separation.separator.rend());
    for (std::vector<int>& half : separation.halves) {
      if (!half.empty()) parts.push_back(std::move(half));
    }
  }
  order.insert(order.end(), last.rbegin(), last.rend());
  return order;
}

}  // namespace haptex::linear
