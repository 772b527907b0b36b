#include "haptex/cloth/dynamics/untangling/regions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <utility>

namespace haptex::cloth {
namespace {

using Eigen::Vector3d;
using Positions = std::vector<Vector3d>;

/// Zero of what has no direction.
Vector3d unit(const Vector3d& vector) {
  const double length = vector.norm();
  return length > 1e-12 ? Vector3d(vector / length) : Vector3d::Zero();
}

constexpr int kRings = 2;  // of edges around a crossing

}  // namespace

TangleRegions::TangleRegions(const MeshTopology& topology, std::size_t particles)
    : topology_(topology),
      cut_(topology.elements.edges.size()),
      region_of_(particles),
      was_wrong_(particles),
      reached_(particles) {
  sides_.first.resize(particles);
  sides_.second.resize(particles);
}

void TangleRegions::find(const Positions& positions,
                         const std::vector<proximity::TrianglePair>& pairs,
                         const IntersectionContours& contours) {
  const std::vector<Crossing>& crossings = contours.crossings();
  cutIntoRegions(crossings);
  chooseWrong(contours);
  ways_.resize(crossings.size());
  of_contour_.assign(contours.count(), Vector3d::Zero());
  for (std::size_t c = 0; c < crossings.size(); ++c) {
    const Crossing& crossing = crossings[c];
    const bool is_parted = wrong_[crossing.contour] >= 0;
    ways_[c] = is_parted ? wayBack(positions, crossing) : crossing.shorter;
    of_contour_[crossing.contour] += (crossing.on_first ? 1.0 : -1.0) * ways_[c];
  }
  for (std::size_t c = 0; c < crossings.size(); ++c) {
    const bool is_parted = wrong_[crossings[c].contour] >= 0;
    if (is_parted && !ways_[c].isZero(0.0)) continue;
    ways_[c] = (crossings[c].on_first ? 1.0 : -1.0) * unit(of_contour_[crossings[c].contour]);
  }
  markSides(pairs, contours);
}

void TangleRegions::cutIntoRegions(const std::vector<Crossing>& crossings) {
  std::fill(cut_.begin(), cut_.end(), 0);
  for (const Crossing& crossing : crossings) cut_[crossing.edge] ^= 1;
  std::fill(region_of_.begin(), region_of_.end(), -1);
  sizes_.clear();
  wrong_before_.clear();
  for (int seed = 0; seed < static_cast<int>(region_of_.size()); ++seed) {
    if (region_of_[seed] >= 0) continue;
    const int region = static_cast<int>(sizes_.size());
    sizes_.push_back(0);
    wrong_before_.push_back(0);
    front_.assign(1, seed);
    region_of_[seed] = region;
    while (!front_.empty()) {
      const int particle = front_.back();
      front_.pop_back();
      ++sizes_[region];
      wrong_before_[region] += was_wrong_[particle];
      for (const int other : topology_.neighbours_of[particle]) {
        if (region_of_[other] >= 0) continue;
        if (cut_[topology_.elements.indexOf(proximity::edgeBetween(particle, other))]) continue;
        region_of_[other] = region;
        front_.push_back(other);
      }
    }
  }
}

void TangleRegions::chooseWrong(const IntersectionContours& contours) {
  wrong_.assign(contours.count(), -1);
  wrong_on_first_.assign(contours.count(), 0);
  for (const Crossing& crossing : contours.crossings()) {
    const auto& [a, b] = topology_.elements.edges[crossing.edge];
    if (region_of_[a] == region_of_[b]) continue;
    int& wrong = wrong_[crossing.contour];
    for (const int region : {region_of_[a], region_of_[b]}) {
      if (wrong >= 0 && !isMoreWrong(region, wrong)) continue;
      wrong = region;
      wrong_on_first_[crossing.contour] = crossing.on_first;
    }
  }
  std::fill(was_wrong_.begin(), was_wrong_.end(), 0);
  for (std::size_t i = 0; i < region_of_.size(); ++i) {
    was_wrong_[i] = std::find(wrong_.begin(), wrong_.end(), region_of_[i]) != wrong_.end();
  }
}

bool TangleRegions::isMoreWrong(int region, int other) const {
  const bool was = 2 * wrong_before_[region] > sizes_[region];
  const bool other_was = 2 * wrong_before_[other] > sizes_[other];
  return was != other_was ? was : sizes_[region] < sizes_[other];
}

void TangleRegions::forget() { std::fill(was_wrong_.begin(), was_wrong_.end(), 0); }

/// The contour has to go into the wrong region, which is on one side of it in the edge that is cut,
/// or else in the triangle.
Vector3d TangleRegions::wayBack(const Positions& positions, const Crossing& crossing) const {
  const int wrong = wrong_[crossing.contour];
  const proximity::Edge& ends = topology_.elements.edges[crossing.edge];
  const std::array<int, 3>& corners = topology_.elements.triangles[crossing.triangle];
  const auto along = [](const Vector3d& normal, const Vector3d& back) {
    const double height = normal.dot(back);
    return Vector3d(height == 0.0 ? Vector3d::Zero() : Vector3d(height > 0.0 ? normal : -normal));
  };
  if ((region_of_[ends[0]] == wrong) != (region_of_[ends[1]] == wrong)) {
    const Vector3d back = positions[ends[1]] - positions[ends[0]];
    return along(topology_.normalOf(positions, crossing.triangle),
                 region_of_[ends[0]] == wrong ? back : Vector3d(-back));
  }
  Vector3d of_wrong = Vector3d::Zero(), of_others = Vector3d::Zero();
  int wrong_corners = 0;
  for (const int corner : corners) {
    const bool is_wrong = region_of_[corner] == wrong;
    wrong_corners += is_wrong;
    (is_wrong ? of_wrong : of_others) += positions[corner];
  }
  if (wrong_corners == 0 || wrong_corners == 3) return Vector3d::Zero();
  Vector3d normal = Vector3d::Zero();
  for (const int triangle : topology_.triangles_at[crossing.edge]) {
    normal += topology_.normalOf(positions, triangle);
  }
  const Vector3d back = of_others / (3 - wrong_corners) - of_wrong / wrong_corners;
  return -along(unit(normal), back);
}

void TangleRegions::markSides(const std::vector<proximity::TrianglePair>& pairs,
                              const IntersectionContours& contours) {
  std::fill(sides_.first.begin(), sides_.first.end(), 0);
  std::fill(sides_.second.begin(), sides_.second.end(), 0);
  std::fill(reached_.begin(), reached_.end(), -1);
  order_.resize(pairs.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::sort(order_.begin(), order_.end(), [&](int a, int b) {
    const int of_a = contours.contourOf(a), of_b = contours.contourOf(b);
    return of_a != of_b ? of_a < of_b : a < b;
  });
  for (std::size_t begin = 0, end = 0; begin < order_.size(); begin = end) {
    const int contour = contours.contourOf(order_[begin]);
    while (end < order_.size() && contours.contourOf(order_[end]) == contour) ++end;
    const auto start = [&](bool first_side) {
      front_.clear();
      for (std::size_t i = begin; i < end; ++i) {
        const bool is_first = contours.isFirstOnFirst(order_[i]) == first_side;
        const auto& corners = topology_.elements.triangles[pairs[order_[i]][is_first ? 0 : 1]];
        front_.insert(front_.end(), corners.begin(), corners.end());
      }
    };
    const int wrong = wrong_[contour];
    int depth = 0;
    if (wrong >= 0) {
      start(wrong_on_first_[contour]);
      depth = spread(3 * contour + 2, static_cast<int>(region_of_.size()), wrong,
                     wrong_on_first_[contour] ? sides_.first : sides_.second);
    }
    start(true);
    spread(3 * contour, kRings + (wrong_on_first_[contour] ? 0 : depth), -1, sides_.first);
    start(false);
    spread(3 * contour + 1, kRings + (wrong_on_first_[contour] ? depth : 0), -1, sides_.second);
  }
}

/// Marks what is within so many edges of front_.
/// @param stamp another number in every call of a find(), the contour its third part
/// @param within region that it does not leave; -1: any
/// @return how many edges it came away from there
int TangleRegions::spread(int stamp, int rings, int within, std::vector<std::uint64_t>& side) {
  const std::uint64_t mark = std::uint64_t{1} << (stamp / 3 % 64);
  for (const int particle : front_) {
    reached_[particle] = stamp;
    side[particle] |= mark;
  }
  int ring = 0;
  for (; ring < rings && !front_.empty(); ++ring) {
    next_.clear();
    for (const int particle : front_) {
      for (const int other : topology_.neighbours_of[particle]) {
        if (reached_[other] == stamp || (within >= 0 && region_of_[other] != within)) continue;
        reached_[other] = stamp;
        side[other] |= mark;
        next_.push_back(other);
      }
    }
    std::swap(front_, next_);
  }
  return ring;
}

}  // namespace haptex::cloth
