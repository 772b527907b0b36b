#include "haptex/linear/separator.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptex::linear {
namespace {

constexpr signed char kOutside = -1;
constexpr signed char kSeparator = 2;  // 0 and 1 are the halves
constexpr int kImproved = 3;           // candidates that are worth the work
constexpr int kMaxPasses = 8;
constexpr int kFruitlessMoves = 50;

/// Size of the separator, weighted by how uneven the halves are; an empty half separates nothing.
double costOf(const std::array<int, 3>& counts) {
  const double smaller = std::min(counts[0], counts[1]);
  if (smaller == 0.0) return std::numeric_limits<double>::infinity();
  const double halves = counts[0] + counts[1];
  return counts[kSeparator] * std::sqrt((halves + 1.0) / (2.0 * smaller + 1.0));
}

}  // namespace

SeparatorFinder::SeparatorFinder(const Graph& graph)
    : graph_(graph), place_(graph.size(), kOutside), locked_(graph.size(), 0) {
  for (std::vector<int>& distance : distance_) distance.assign(graph.size(), -1);
}

/// Distances within the part; returns the last node reached, which is one of the farthest.
int SeparatorFinder::measure(const std::vector<int>& part, int from, std::vector<int>& distance) {
  for (int node : part) distance[node] = -1;
  queue_.assign(1, from);
  distance[from] = 0;
  for (std::size_t head = 0; head < queue_.size(); ++head) {
    const int node = queue_[head];
    for (int other : graph_[node]) {
      if (place_[other] == kOutside || distance[other] != -1) continue;
      distance[other] = distance[node] + 1;
      queue_.push_back(other);
    }
  }
  return queue_.back();
}

/// From the ends of the part's longest way and of the longest way across its middle.
void SeparatorFinder::measureFromFarNodes(const std::vector<int>& part, int start) {
  const int first = measure(part, start, distance_[0]);
  const int second = measure(part, first, distance_[0]);
  measure(part, second, distance_[1]);
  const auto nearer = [&](int node) { return std::min(distance_[0][node], distance_[1][node]); };
  int most = 0;
  for (int node : part) most = std::max(most, nearer(node));
  const auto farthest_in_the_middle = [&](const std::vector<int>& distance) {
    int found = -1;
    for (int node : part) {
      if (nearer(node) < most - 1) continue;
      if (found == -1 || distance[node] > distance[found]) found = node;
    }
    return found;
  };
  std::fill(distance_[2].begin(), distance_[2].end(), 0);
  measure(part, farthest_in_the_middle(distance_[2]), distance_[2]);
  const int third = farthest_in_the_middle(distance_[2]);
  measure(part, third, distance_[2]);
  measure(part, farthest_in_the_middle(distance_[2]), distance_[3]);
}

int SeparatorFinder::level(int node, const Candidate& candidate) const {
  const int minus = candidate.minus == -1 ? 0 : distance_[candidate.minus][node];
  return distance_[candidate.plus][node] - minus;
}

/// Puts every node of the part in its place; the separator is the edge of the second half.
SeparatorFinder::Counts SeparatorFinder::cut(const std::vector<int>& part,
                                             const Candidate& candidate) {
  Counts counts{};
  for (int node : part) place_[node] = level(node, candidate) >= candidate.threshold;
  for (int node : part) {
    if (place_[node] == 1) {
      for (int other : graph_[node]) {
        if (place_[other] == 0) place_[node] = kSeparator;
      }
    }
    ++counts[place_[node]];
  }
  return counts;
}

/// Cuts near the middle of the levels.
void SeparatorFinder::addCandidates(const std::vector<int>& part, int plus, int minus) {
  Candidate candidate{0.0, plus, minus, 0};
  std::vector<int> levels;
  for (int node : part) levels.push_back(level(node, candidate));
  std::sort(levels.begin(), levels.end());
  int last = levels.front();
  for (double share : {0.42, 0.5, 0.58}) {
    candidate.threshold = levels[static_cast<std::size_t>(share * levels.size())];
    if (candidate.threshold == last) continue;
    last = candidate.threshold;
    candidate.cost = costOf(cut(part, candidate));
    candidates_.push_back(candidate);
  }
}

/// Nodes of the other half that have to become part of the separator if `node` leaves it.
int SeparatorFinder::pulled(int node, int half) const {
  int count = 0;
  for (int other : graph_[node]) count += place_[other] == 1 - half;
  return count;
}

/// Moves nodes of the separator into a half, each at most once and each time the one that is best,
/// and goes back to the best state seen.
bool SeparatorFinder::improveOnce(const std::vector<int>& part, Counts& counts) {
  struct Move {
    int node;
    signed char from;
  };
  std::vector<Move> moves;
  std::vector<int> separator;
  for (int node : part) {
    locked_[node] = 0;
    if (place_[node] == kSeparator) separator.push_back(node);
  }
  const double before = costOf(counts);
  double best = before;
  std::size_t best_moves = 0;
  Counts best_counts = counts;
  for (int fruitless = 0; fruitless < kFruitlessMoves && !separator.empty(); ++fruitless) {
    double lowest = std::numeric_limits<double>::infinity();
    std::size_t chosen = 0;
    int into = 0;
    Counts after{};
    for (std::size_t i = 0; i < separator.size(); ++i) {
      if (locked_[separator[i]]) continue;
      for (int half : {0, 1}) {
        const int pull = pulled(separator[i], half);
        Counts trial = counts;
        ++trial[half];
        trial[1 - half] -= pull;
        trial[kSeparator] += pull - 1;
        const double cost = costOf(trial);
        if (cost >= lowest) continue;
        lowest = cost;
        chosen = i;
        into = half;
        after = trial;
      }
    }
    if (std::isinf(lowest)) break;
    const int node = separator[chosen];
    separator[chosen] = separator.back();
    separator.pop_back();
    locked_[node] = 1;
    moves.push_back({node, kSeparator});
    place_[node] = static_cast<signed char>(into);
    for (int other : graph_[node]) {
      if (place_[other] != 1 - into) continue;
      moves.push_back({other, place_[other]});
      place_[other] = kSeparator;
      separator.push_back(other);
    }
    counts = after;
    if (lowest < best) {
      best = lowest;
      best_moves = moves.size();
      best_counts = counts;
      fruitless = 0;
    }
  }
  for (; moves.size() > best_moves; moves.pop_back()) place_[moves.back().node] = moves.back().from;
  counts = best_counts;
  return best < before;
}

double SeparatorFinder::improve(const std::vector<int>& part, Counts counts) {
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    if (!improveOnce(part, counts)) break;
  }
  return costOf(counts);
}

Separation SeparatorFinder::separate(const std::vector<int>& part) {
  Separation result;
  for (int node : part) place_[node] = 0;
  measure(part, part.front(), distance_[0]);
  if (queue_.size() < part.size()) {  // in several pieces: no separator is needed
    for (int node : part) result.halves[distance_[0][node] == -1].push_back(node);
    for (int node : part) place_[node] = kOutside;
    return result;
  }
  measureFromFarNodes(part, part.front());
  candidates_.clear();
  for (int plus = 0; plus < 4; ++plus) {
    addCandidates(part, plus, -1);
    for (int minus = 0; minus < plus; ++minus) addCandidates(part, plus, minus);
  }
  std::stable_sort(candidates_.begin(), candidates_.end(),
                   [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  double best = std::numeric_limits<double>::infinity();
  std::vector<signed char> best_place(part.size(), kSeparator);
  for (std::size_t c = 0; c < candidates_.size() && c < kImproved; ++c) {
    const double cost = improve(part, cut(part, candidates_[c]));
    if (cost >= best) continue;
    best = cost;
    for (std::size_t i = 0; i < part.size(); ++i) best_place[i] = place_[part[i]];
  }
  for (std::size_t i = 0; i < part.size(); ++i) {
    (best_place[i] == kSeparator ? result.separator : result.halves[best_place[i]])
        .push_back(part[i]);
    place_[part[i]] = kOutside;
  }
  return result;
}

}  // namespace haptex::linear
