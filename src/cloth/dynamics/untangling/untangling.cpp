#include "haptex/cloth/dynamics/untangling/untangling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "haptex/proximity/cursor.h"

namespace haptex::cloth {
namespace {

using Eigen::Vector3d;
using Positions = std::vector<Vector3d>;

// The longest way of a step: kSpeed of the mean length of edges per second, at most kLongest of it.
constexpr double kSpeed = 16.0;  // 1/s
constexpr double kLongest = 0.25;
// Of what sticks where it crosses, in masses of a particle per step.
constexpr double kDamping = 5.0;

/// m, at rest.
double meanLength(const proximity::MeshElements& elements, const RestSurface& rest) {
  std::vector<double> lengths(elements.edges.size());
  for (std::size_t t = 0; t < rest.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int next = (i + 1) % 3;
      const auto edge = proximity::edgeBetween(rest.triangles[t][i], rest.triangles[t][next]);
      lengths[elements.indexOf(edge)] = (rest.corners[t][next] - rest.corners[t][i]).norm();
    }
  }
  double sum = 0.0;
  for (const double length : lengths) sum += length;
  return sum / static_cast<double>(lengths.size());
}

}  // namespace

Untangling::Untangling(const Cloth& cloth)
    : topology_(cloth.mesh().triangles, cloth.particleCount()),
      intersections_(cloth.mesh().triangles, RestSurface(cloth.mesh()).places()),
      contours_(topology_),
      regions_(topology_, cloth.particleCount()),
      motion_(cloth.particleCount(), cloth.selfContact()->margin(),
              cloth.selfContact()->particleMargins()),
      edge_length_(meanLength(topology_.elements, RestSurface(cloth.mesh()))),
      ways_(cloth.particleCount()),
      weights_(cloth.particleCount()) {
  last_.reserve(cloth.particleCount());
  targets_.reserve(cloth.particleCount());
}

/// @return whether anything intersects
bool Untangling::find(const Positions& positions) {
  pairs_.clear();
  if (!std::all_of(positions.begin(), positions.end(), proximity::isPlace)) return false;
  pairs_ = intersections_.find(positions);
  if (pairs_.empty()) return false;
  contours_.find(positions, pairs_);
  regions_.find(positions, pairs_, contours_);
  return true;
}

/// @return whether that is a change
bool Untangling::leaveOut(const Cloth& cloth) {
  static const TangleSides none;
  links_.clear();
  if (!pairs_.empty()) linkCrossings();
  return cloth.selfContact()->leaveOut(pairs_.empty() ? none : regions_.sides(), links_);
}

void Untangling::linkCrossings() {
  for (const Crossing& crossing : contours_.crossings()) {
    const auto& [a, b] = topology_.elements.edges[crossing.edge];
    const auto& [p, q, r] = topology_.elements.triangles[crossing.triangle];
    const Vector3d& w = crossing.weights;
    links_.push_back(
        {{a, b, p, q, r}, {1.0 - crossing.share, crossing.share, -w[0], -w[1], -w[2]}, damping_});
  }
}

void Untangling::begin(const Cloth& cloth, const ClothState& state, double h) {
  if (state.positions != last_) {
    regions_.forget();
    find(state.positions);
  }
  if (!pairs_.empty()) {
    const std::vector<double>& masses = cloth.masses();
    const double sum = std::accumulate(masses.begin(), masses.end(), 0.0);
    damping_ = kDamping * sum / (static_cast<double>(masses.size()) * h);
  }
  leaveOut(cloth);
}

bool Untangling::end(const Cloth& cloth, double h, StageSolver& stages, ClothState& end,
                     TangleReport& report) {
  const bool was_free = pairs_.empty();
  bool changed = false;
  if (!was_free) {
    const double before = cloth.potentialEnergy(end);
    if (find(end.positions)) {
      links_.clear();  // they are not to hold back what is moved out
      cloth.selfContact()->leaveOut(regions_.sides(), links_);
      moveOut(cloth, h, stages, end);
      find(end.positions);
      changed = true;
    }
    changed = leaveOut(cloth) || changed;
    if (changed) report.energy = cloth.potentialEnergy(end) - before;
  }
  if (pairs_.empty() && !was_free) regions_.forget();
  last_ = end.positions;
  report.pairs = static_cast<int>(pairs_.size());
  if (!pairs_.empty()) report.first = pairs_.front();
  return changed;
}

void Untangling::moveOut(const Cloth& cloth, double h, StageSolver& stages, ClothState& end) {
  const double most = std::min(kSpeed * h, kLongest) * edge_length_;
  chooseWays(end.positions);
  stages.respond(cloth, end, h, ways_);
  double longest = 0.0;
  for (const Vector3d& way : ways_) longest = std::max(longest, way.norm());
  if (!(longest > 0.0) || !std::isfinite(longest)) return;
  const double scale = most / longest;
  targets_ = end.positions;
  for (std::size_t i = 0; i < ways_.size(); ++i) targets_[i] += scale * ways_[i];
  motion_.go(cloth.selfContact()->nearPairs(), cloth.selfContact()->obstacles(), end.positions,
             targets_, end.positions);
}

/// Mean unit ways of what crosses, zero of all else. Triangles that lie in each other without
/// crossing go out along the normal of the first.
void Untangling::chooseWays(const Positions& positions) {
  std::fill(ways_.begin(), ways_.end(), Vector3d::Zero());
  std::fill(weights_.begin(), weights_.end(), 0.0);
  const auto add = [&](int particle, const Vector3d& its) {
    ways_[particle] += its;
    weights_[particle] += 1.0;
  };
  const std::vector<Crossing>& crossings = contours_.crossings();
  is_crossed_.assign(contours_.count(), 0);
  for (std::size_t c = 0; c < crossings.size(); ++c) {
    is_crossed_[crossings[c].contour] = 1;
    const Vector3d& out = regions_.wayOut(c);
    if (out.isZero(0.0)) continue;
    for (const int end : topology_.elements.edges[crossings[c].edge]) add(end, out);
    for (const int corner : topology_.elements.triangles[crossings[c].triangle]) add(corner, -out);
  }
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    if (is_crossed_[contours_.contourOf(p)] != 0) continue;
    const auto& [first, second] = pairs_[p];
    const Vector3d normal = topology_.normalOf(positions, first);
    for (const int particle : topology_.elements.triangles[first]) add(particle, normal);
    for (const int particle : topology_.elements.triangles[second]) add(particle, -normal);
  }
  for (std::size_t i = 0; i < ways_.size(); ++i) {
    if (weights_[i] > 0.0) ways_[i] /= weights_[i];
  }
}

}  // namespace haptex::cloth
