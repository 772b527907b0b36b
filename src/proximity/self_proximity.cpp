#include "haptex/proximity/self_proximity.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace haptex::proximity {
namespace {

using Eigen::Vector3d;

// Elements of the reference state that are nearer than this part of its size touch: between those
// that are farther apart no slit is so narrow that FlatRegions could take it for rounding.
constexpr double kTouching = 1e-5;

constexpr int kFindsPerFront = 32;  // at most, then a traversal begins at the root again

constexpr int kAtATime = 32;  // pairs of volumes that the kernel takes

double requireDistance(double distance) {
  if (distance >= 0.0 && distance <= kMaxLength) return distance;
  std::ostringstream message;
  message << "distance " << distance << " m: must be from 0 to " << kMaxLength;
  throw std::invalid_argument(message.str());
}

const std::vector<Vector3d>& requireReference(const std::vector<Vector3d>& reference,
                                              const KdopHierarchy& hierarchy) {
  if (reference.size() == hierarchy.positions().size()) return reference;
  throw std::invalid_argument(std::to_string(reference.size()) +
                              " reference positions for a hierarchy over " +
                              std::to_string(hierarchy.positions().size()) + " vertices");
}

std::array<Vector3d, 4> placesOf(const std::array<int, 4>& vertices,
                                 const std::vector<Vector3d>& positions) {
  return {positions[vertices[0]], positions[vertices[1]], positions[vertices[2]],
          positions[vertices[3]]};
}

}  // namespace

struct SelfProximity::Answer {
  std::vector<NearPair>& found;
  double* bounds;

  void limit(const std::array<int, 4>& vertices, double distance) const {
    if (bounds == nullptr) return;
    for (int vertex : vertices) bounds[vertex] = std::min(bounds[vertex], 0.5 * distance);
  }
};

SelfProximity::SelfProximity(const KdopHierarchy& hierarchy, const std::vector<Vector3d>& reference,
                             double distance)
    : hierarchy_(hierarchy),
      elements_(hierarchy.triangles()),
      leaf_elements_(hierarchy, elements_),
      flat_(hierarchy, requireReference(reference, hierarchy)),
      reference_(reference),
      distance_(requireDistance(distance)) {
  KdopHierarchy at_reference = hierarchy;
  at_reference.refit(reference);
  for (Part& part : parts_) part.scratch = leaf_elements_.scratch();
  // Rounding of distances must not tell apart what is a neighbour and what is flat.
  reach_ = std::max(distance_ / FlatRegions::kLeastStretch, kTouching * at_reference.extent());
  reach_ *= 1.0 + 1e-6;
  for (const Edge& edge : elements_.edges) {
    longest_edge_ = std::max(longest_edge_, (reference[edge[0]] - reference[edge[1]]).norm());
  }
  bool reference_touches = false;
  findNeighbours(at_reference, reference_touches);
  flat_is_known_ = !reference_touches;
}

SelfProximity::SelfProximity(const KdopHierarchy& hierarchy, double distance)
    : hierarchy_(hierarchy),
      elements_(hierarchy.triangles()),
      leaf_elements_(hierarchy, elements_),
      flat_(hierarchy, hierarchy.positions()),
      distance_(requireDistance(distance)) {
  for (Part& part : parts_) part.scratch = leaf_elements_.scratch();
}

void SelfProximity::findNeighbours(const KdopHierarchy& hierarchy, bool& reference_touches) {
  hierarchy.computePairLimits(reach_, limits_);
  leaf_elements_.begin(hierarchy, reach_);
  front_.assign(1, {0, 0});
  traverse(hierarchy, false);
  testCandidates(hierarchy, nullptr, [&](const ElementPair& pair, Part& part) {
    if (isNeighbour(pair, verticesOf(pair, elements_)))
      part.found.push_back({pair, {0.0, Eigen::Vector4d::Zero()}});
  });
  for (const Part& part : parts_) {
    for (const NearPair& pair : part.found) neighbours_.push_back(pair.elements);
  }
  std::sort(neighbours_.begin(), neighbours_.end());
  for (const ElementPair& pair : neighbours_) {
    const double apart =
        distanceOf(pair.kind, placesOf(verticesOf(pair, elements_), reference_)).distance;
    is_excluded_.push_back(apart <= distance_);
    reference_touches = reference_touches || apart <= kTouching * hierarchy.extent();
  }
}

void SelfProximity::find(std::vector<NearPair>& found, std::vector<double>* bounds,
                         SelfProximityCost* cost, linear::ThreadPool* pool) {
  found.clear();
  if (bounds != nullptr) bounds->assign(hierarchy_.positions().size(), 0.5 * distance_);
  hierarchy_.computePairLimits(distance_, limits_);
  leaf_elements_.begin(hierarchy_, distance_);
  cost_ = {};
  if (age_of_front_ == kFindsPerFront || last_tests_ > tests_from_root_) age_of_front_ = 0;
  if (age_of_front_ == 0) front_.assign(1, {0, 0});
  traverse(hierarchy_, flat_is_known_);
  last_tests_ = cost_.volume_pairs;
  if (age_of_front_++ == 0) tests_from_root_ = last_tests_;
  const Answer answer = {found, bounds == nullptr ? nullptr : bounds->data()};
  testCandidates(hierarchy_, pool, [&](const ElementPair& pair, Part& part) {
    const std::array<int, 4> vertices = verticesOf(pair, elements_);
    const std::array<Vector3d, 4> places = placesOf(vertices, hierarchy_.positions());
    if (isSurelyApart(pair.kind, places, distance_)) return;
    const PairDistance nearest = distanceOf(pair.kind, places);
    ++part.distances;
    if (!(nearest.distance <= distance_)) return;
    if (!neighbours_.empty() && isNeighbour(pair, vertices)) return;  // follows below
    part.found.push_back({pair, nearest});
  });
  for (const Part& part : parts_) {
    cost_.distances += part.distances;
    found.insert(found.end(), part.found.begin(), part.found.end());
  }
  if (bounds != nullptr) {
    for (const NearPair& pair : found) {
      answer.limit(verticesOf(pair.elements, elements_), pair.nearest.distance);
    }
  }
  for (std::size_t i = 0; i < neighbours_.size(); ++i) {
    const std::array<int, 4> vertices = verticesOf(neighbours_[i], elements_);
    const PairDistance nearest =
        distanceOf(neighbours_[i].kind, placesOf(vertices, hierarchy_.positions()));
    ++cost_.distances;
    if (!(nearest.distance <= distance_)) continue;
    answer.limit(vertices, nearest.distance);
    if (!is_excluded_[i]) found.push_back({neighbours_[i], nearest});
  }
  if (cost == nullptr) return;
  cost->volume_pairs += cost_.volume_pairs;
  cost->flat_tests += cost_.flat_tests;
  cost->leaf_pairs += cost_.leaf_pairs;
  cost->distances += cost_.distances;
}

bool SelfProximity::isNeighbour(const ElementPair& pair, const std::array<int, 4>& vertices) const {
  const double farthest = 2.0 * longest_edge_ + reach_;
  if ((reference_[vertices[0]] - reference_[vertices[3]]).squaredNorm() > farthest * farthest) {
    return false;
  }
  return distanceOf(pair.kind, placesOf(vertices, reference_)).distance <= reach_;
}

/// Collects the pairs of leaves, beginning at the front, downwards where volumes are near. What has
/// moved apart, or has become flat, is seen when it begins at the root again: after some steps, or
/// when that takes less. The front keeps the order of a traversal from there, so that the order of
/// what is found does not depend on it.
void SelfProximity::traverse(const KdopHierarchy& hierarchy, bool leave_out) {
  leaf_pairs_.clear();
  new_leaves_.clear();
  next_front_.clear();
  for (std::size_t at = 0; at < front_.size();) {
    if (front_[at].first == front_[at].second) {
      visit(hierarchy, front_[at++].first, leave_out);
      continue;
    }
    int count = 1;
    while (count < kAtATime && at + count < front_.size() &&
           front_[at + count].first != front_[at + count].second) {
      ++count;
    }
    visit(hierarchy, &front_[at], count);
    at += count;
  }
  front_.swap(next_front_);
}

/// One volume against itself.
void SelfProximity::visit(const KdopHierarchy& hierarchy, int volume, bool leave_out) {
  if (leave_out) {
    ++cost_.flat_tests;
    if (flat_.isFlat(hierarchy, volume)) {
      next_front_.push_back({volume, volume});
      return;
    }
  }
  if (volume >= hierarchy.tree().first_leaf) {
    compare(hierarchy, {volume, volume});
    return;
  }
  const int half = 2 * volume + 1;
  visit(hierarchy, half, leave_out);
  const Pair halves = {half, half + 1};
  visit(hierarchy, &halves, 1);
  visit(hierarchy, half + 1, leave_out);
}

/// At most kAtATime pairs of different volumes.
void SelfProximity::visit(const KdopHierarchy& hierarchy, const Pair* pairs, int count) {
  cost_.volume_pairs += count;
  const std::uint32_t near =
      hierarchy.kernels().nearPairs(hierarchy.tree(), pairs, count, limits_.data());
  for (int i = 0; i < count; ++i) {
    const Pair pair = pairs[i];
    if ((near >> i & 1) == 0) {
      next_front_.push_back(pair);
    } else if (pair.first >= hierarchy.tree().first_leaf) {
      compare(hierarchy, pair);
    } else {
      const int a = 2 * pair.first + 1, b = 2 * pair.second + 1;
      const Pair below[4] = {{a, b}, {a, b + 1}, {a + 1, b}, {a + 1, b + 1}};
      visit(hierarchy, below, 4);
    }
  }
}

void SelfProximity::compare(const KdopHierarchy& hierarchy, const Pair& leaves) {
  next_front_.push_back(leaves);
  ++cost_.leaf_pairs;
  const int first_leaf = hierarchy.tree().first_leaf;
  const Pair numbers = {leaves.first - first_leaf, leaves.second - first_leaf};
  leaf_pairs_.push_back(numbers);
  for (const int leaf : {numbers.first, numbers.second}) {
    if (leaf_elements_.isNew(leaf)) new_leaves_.push_back(leaf);
  }
}

/// Calls test(pair of elements, part) with all candidates, in parts of the pairs of leaves whose
/// order is that of the traversal.
template <typename Test>
void SelfProximity::testCandidates(const KdopHierarchy& hierarchy, linear::ThreadPool* pool,
                                   const Test& test) {
  const auto in_parts = [&](std::size_t count, const auto& function) {
    linear::runTasks(pool, kParts, [&](int part, int) {
      for (std::size_t i = count * part / kParts; i < count * (part + 1) / kParts; ++i) {
        function(i, parts_[part]);
      }
    });
  };
  in_parts(new_leaves_.size(),
           [&](std::size_t i, Part&) { leaf_elements_.fit(hierarchy, new_leaves_[i]); });
  for (Part& part : parts_) {
    part.found.clear();
    part.distances = 0;
  }
  in_parts(leaf_pairs_.size(), [&](std::size_t i, Part& part) {
    part.candidates.clear();
    leaf_elements_.findCandidates(leaf_pairs_[i].first, leaf_pairs_[i].second, part.scratch,
                                  part.candidates);
    for (const ElementPair& pair : part.candidates) test(pair, part);
  });
  // Parts have some more room than any has needed: what is near is not always in the same ones.
  std::size_t most = 0, most_candidates = 0;
  for (const Part& part : parts_) {
    most = std::max(most, part.found.size());
    most_candidates = std::max(most_candidates, part.candidates.capacity());
  }
  for (Part& part : parts_) {
    if (part.found.capacity() < most) part.found.reserve(2 * most);
    part.candidates.reserve(most_candidates);
  }
}

}  // namespace haptex::proximity
