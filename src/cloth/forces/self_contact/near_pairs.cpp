#include "haptex/cloth/forces/self_contact/near_pairs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "haptex/base/require.h"
#include "haptex/linear/shared_rows.h"

namespace haptex::cloth {
namespace {

using Eigen::Vector3d;

/// As far as it costs little: below half of the altitudes a mesh has no neighbours to look at one
/// by one (proximity::SelfProximity), and in layers pairs grow with the square of the distance.
double distanceToSearch(double altitude, double distance) {
  constexpr double kOfAltitude = 0.45, kLeast = 1.5, kMost = 8.0;
  return std::clamp(kOfAltitude * altitude, kLeast * distance, kMost * distance);
}

}  // namespace

NearPairs::NearPairs(const RestSurface& rest, double distance)
    : hierarchy_(rest.triangles, rest.places()), self_(makeProximity(hierarchy_, rest, distance)) {
  for (const proximity::ElementPair& pair : self_.neighbours()) {
    all_neighbours_.push_back(named(pair));
  }
  neighbours_ = all_neighbours_;
}

proximity::SelfProximity NearPairs::makeProximity(const proximity::KdopHierarchy& hierarchy,
                                                  const RestSurface& rest, double distance) {
  const double altitude = rest.shortestAltitude();
  const double searched = distanceToSearch(altitude, distance);
  if (rest.isFlat()) return {hierarchy, rest.places(), searched};
  if (!(altitude > distance)) {
    base::refuse("the shortest altitude of a triangle is ", base::shortNumber(altitude),
                 " m; where panels that are sewn together collide with each other it must be above "
                 "the thickness of the fabric, ",
                 base::shortNumber(distance), " m: allowed are longer edges");
  }
  return {hierarchy, searched};
}

bool NearPairs::leaveOut(const TangleSides& sides) {
  if (sides == sides_) return false;
  sides_ = sides;
  searched_at_.clear();
  neighbours_.clear();
  for (const Pair& pair : all_neighbours_) {
    if (!isInTangle(pair)) neighbours_.push_back(pair);
  }
  return true;
}

bool NearPairs::isInTangle(const Pair& pair) const {
  if (sides_.first.empty()) return false;
  const int first_end = pair.kind == proximity::ElementPairKind::kVertexTriangle ? 1 : 2;
  std::array<std::uint64_t, 2> first = {0, 0}, second = {0, 0};  // of both elements
  for (int i = 0; i < 4; ++i) {
    const int element = i < first_end ? 0 : 1;
    first[element] |= sides_.first[pair.vertices[i]];
    second[element] |= sides_.second[pair.vertices[i]];
  }
  return ((first[0] & second[1]) | (first[1] & second[0])) != 0;
}

bool NearPairs::find(const std::vector<Vector3d>& positions, double distance,
                     linear::ThreadPool* pool) {
  if (!searched_at_.empty()) {
    const double moved = farthestBeyondCommon(positions, searched_at_);
    if (moved <= 0.5 * (searched() - distance)) {
      moved_ = moved;
      return true;
    }
  }
  const auto is_allowed = [](const Vector3d& place) {
    return place.allFinite() && place.cwiseAbs().maxCoeff() <= proximity::kMaxLength;
  };
  if (!std::all_of(positions.begin(), positions.end(), is_allowed)) return false;
  hierarchy_.refit(positions);
  self_.find(found_, nullptr, nullptr, pool);
  searched_at_ = positions;
  moved_ = 0.0;
  sortFound(pool);
  pairs_.resize(sorted_.size());
  linear::shareRows(pool, static_cast<int>(sorted_.size()), [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const proximity::NearPair& pair = found_[sorted_[i].place];
      pairs_[i] = named(pair.elements);
      pairs_[i].distance = pair.nearest.distance;
    }
  });
  if (!sides_.first.empty()) {
    const auto in_tangle = [&](const Pair& pair) { return isInTangle(pair); };
    pairs_.erase(std::remove_if(pairs_.begin(), pairs_.end(), in_tangle), pairs_.end());
  }
  return true;
}

int NearPairs::bucketOf(const proximity::ElementPair& pair) const {
  const bool are_edges = pair.kind == proximity::ElementPairKind::kEdgeEdge;
  return pair.first + (are_edges ? static_cast<int>(particleCount()) : 0);
}

/// Counts the pairs of each first element, of which none has many.
void NearPairs::sortFound(linear::ThreadPool* pool) {
  const std::size_t buckets = particleCount() + self_.elements().edges.size();
  std::vector<int>& end = end_of_bucket_;  // their beginnings, until they have been filled
  end.assign(buckets + 1, 0);
  for (const proximity::NearPair& pair : found_) ++end[bucketOf(pair.elements) + 1];
  std::partial_sum(end.begin(), end.end(), end.begin());
  sorted_.resize(found_.size());
  for (std::size_t place = 0; place < found_.size(); ++place) {
    const proximity::ElementPair& pair = found_[place].elements;
    sorted_[end[bucketOf(pair)]++] = {pair.second, static_cast<int>(place)};
  }
  linear::shareRows(pool, static_cast<int>(buckets), [&](int first, int last) {
    const auto less = [](const Found& a, const Found& b) { return a.second < b.second; };
    for (int bucket = first; bucket < last; ++bucket) {
      const int begin = bucket == 0 ? 0 : end[bucket - 1];
      std::sort(sorted_.begin() + begin, sorted_.begin() + end[bucket], less);
    }
  });
}

/// Infinite where one is not a number.
double NearPairs::farthest(const std::vector<Vector3d>& now, const std::vector<Vector3d>& before) {
  double square = 0.0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const double its = (now[i] - before[i]).squaredNorm();
    if (std::isnan(its)) return std::numeric_limits<double>::infinity();
    square = std::max(square, its);
  }
  return std::sqrt(square);
}

/// What all have in common is the middle of their box.
double NearPairs::farthestBeyondCommon(const std::vector<Vector3d>& now,
                                       const std::vector<Vector3d>& before) {
  Eigen::AlignedBox3d ways;
  for (std::size_t i = 0; i < now.size(); ++i) ways.extend(now[i] - before[i]);
  const Vector3d common = ways.center();
  double square = 0.0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const double its = (now[i] - before[i] - common).squaredNorm();
    if (std::isnan(its)) return std::numeric_limits<double>::infinity();
    square = std::max(square, its);
  }
  return std::sqrt(square);
}

NearPairs::Pair NearPairs::named(const proximity::ElementPair& pair) const {
  return {pair.kind, pair.first, pair.second, verticesOf(pair, self_.elements())};
}

}  // namespace haptex::cloth
