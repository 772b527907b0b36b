// Small sets of nodes that separate a graph into two halves.
#pragma once

#include <array>
#include <vector>

namespace haptex::linear {

using Graph = std::vector<std::vector<int>>;  ///< neighbours of each node

/// No edge joins the halves.
struct Separation {
  std::array<std::vector<int>, 2> halves;
  std::vector<int> separator;
};

/// Separates parts of a graph. Candidates are cuts across distances from four nodes far apart and
/// across differences of such distances; the best of them are improved by moving nodes (Fiduccia
/// and Mattheyses 1982, here for separators of nodes). The result depends on the graph alone.
class SeparatorFinder {
 public:
  explicit SeparatorFinder(const Graph& graph);

  /// @param part nodes of the graph, at least two; edges to others do not count
  Separation separate(const std::vector<int>& part);

 private:
  using Counts = std::array<int, 3>;  // by place
  struct Candidate {
    double cost;
    int plus, minus;  // which distances make the level of a node; minus -1: none
    int threshold;    // of the level, where the second half begins
  };

  int measure(const std::vector<int>& part, int from, std::vector<int>& distance);
  void measureFromFarNodes(const std::vector<int>& part, int start);
  int level(int node, const Candidate& candidate) const;
  void addCandidates(const std::vector<int>& part, int plus, int minus);
  Counts cut(const std::vector<int>& part, const Candidate& candidate);
  double improve(const std::vector<int>& part, Counts counts);
  bool improveOnce(const std::vector<int>& part, Counts& counts);
  int pulled(int node, int half) const;

  const Graph& graph_;
  std::vector<signed char> place_;            // by node: its half, the separator or outside
  std::vector<char> locked_;                  // by node
  std::array<std::vector<int>, 4> distance_;  // by node
  std::vector<Candidate> candidates_;
  std::vector<int> queue_;
};

}  // namespace haptex::linear
