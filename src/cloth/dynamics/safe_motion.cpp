#include "haptex/cloth/dynamics/safe_motion.h"

#include <algorithm>
#include <cmath>

#include "haptex/proximity/continuous.h"

namespace haptex::cloth {
namespace {

using Eigen::Vector3d;

constexpr int kMostWays = 16;
constexpr double kOfReach = 0.49;  // of the distance up to which all pairs are known
// What comes near stops half way into the thickness, where the pressure is still small, what is
// nearer keeps most of its distance: it is for forces to bring it nearer.
constexpr double kKept = 0.8;
constexpr double kOfTime = 0.95;  // up to where the kept distance is reached
// A pair whose particles were stopped so often stops both elements half way to what is kept, which
// is safe whatever the other does.
constexpr char kMostStops = 3;

}  // namespace

SafeMotion::SafeMotion(std::size_t particles, double margin)
    : margin_(margin),
      place_(particles),
      left_(particles),
      way_(particles),
      stopped_by_(particles),
      changed_(particles) {}

MotionCut SafeMotion::go(NearPairs& near, const std::vector<Vector3d>& from,
                         const std::vector<Vector3d>& to, std::vector<Vector3d>& reached) {
  const std::size_t particles = from.size();
  const auto is_finite = [](const Vector3d& place) { return place.allFinite(); };
  if (!std::all_of(to.begin(), to.end(), is_finite)) {
    reached = to;
    return {};
  }
  place_ = from;
  stopped_by_.assign(particles, {-1, -1, -1, -1});
  for (int pass = 0; pass < kMostWays; ++pass) {
    bool arrived = true;
    for (std::size_t i = 0; i < particles; ++i) {
      const bool stopped = stopped_by_[i][0] >= 0;
      left_[i] = stopped ? Vector3d::Zero() : Vector3d(to[i] - place_[i]);
      arrived = arrived && left_[i].isZero(0.0);
    }
    if (arrived) break;
    constexpr double kKnown = 0.9;  // of what is looked for
    const double known = kKnown * near.searched();
    if (!near.find(place_, known)) break;
    chooseWays(kOfReach * known);
    stops_.assign(near.pairs().size(), 0);
    neighbour_stops_.assign(near.neighbours().size(), 0);
    std::fill(changed_.begin(), changed_.end(), 0);
    bool stopped = true;
    for (round_ = 1; stopped; ++round_) {
      stopped = false;
      for (std::size_t p = 0; p < stops_.size(); ++p) {
        stopped = stopBeforeContact(near.pairs()[p], stops_[p]) || stopped;
      }
      for (std::size_t p = 0; p < neighbour_stops_.size(); ++p) {
        stopped = stopBeforeContact(near.neighbours()[p], neighbour_stops_[p]) || stopped;
      }
    }
    for (std::size_t i = 0; i < particles; ++i) {
      const Vector3d way = common_ + way_[i];
      const bool whole = (way - left_[i]).squaredNorm() <= 1e-24 * left_[i].squaredNorm();
      if (stopped_by_[i][0] < 0 && whole) {
        place_[i] = to[i];
      } else {
        place_[i] += way;
      }
    }
  }
  MotionCut cut;
  for (std::size_t i = 0; i < particles; ++i) {
    if (place_[i] == to[i]) continue;
    ++cut.particles;
    const double missing = (to[i] - place_[i]).norm();
    if (!(missing > cut.longest)) continue;
    cut.longest = missing;
    cut.between = stopped_by_[i];
  }
  reached = place_;
  return cut;
}

/// The common way is the mean one if far less is left beyond that, and nothing has been stopped,
/// which would have to go with it.
void SafeMotion::chooseWays(double reach) {
  common_.setZero();
  for (const Vector3d& left : left_) common_ += left;
  common_ /= static_cast<double>(left_.size());
  double most = 0.0, most_beyond = 0.0;
  bool stopped = false;
  for (std::size_t i = 0; i < left_.size(); ++i) {
    most = std::max(most, left_[i].squaredNorm());
    most_beyond = std::max(most_beyond, (left_[i] - common_).squaredNorm());
    stopped = stopped || stopped_by_[i][0] >= 0;
  }
  constexpr double kLess = 0.25;
  if (stopped || most_beyond > kLess * kLess * most) common_.setZero();
  for (std::size_t i = 0; i < left_.size(); ++i) {
    way_[i] = left_[i] - common_;
    const double length = way_[i].norm();
    if (length > reach) way_[i] *= reach / length;
  }
}

/// @param stops how often the pair has stopped its particles
/// @return whether it does now
bool SafeMotion::stopBeforeContact(const Pair& pair, char& stops) {
  if (stops > kMostStops) return false;
  const auto& v = pair.vertices;
  int changed = 0;
  for (int vertex : v) changed = std::max(changed, changed_[vertex]);
  if (changed < round_ - 1) return false;
  std::array<Vector3d, 4> begin, end;
  const Vector3d mean = 0.25 * (way_[v[0]] + way_[v[1]] + way_[v[2]] + way_[v[3]]);
  const std::size_t first_end = pair.kind == proximity::ElementPairKind::kVertexTriangle ? 1 : 2;
  double longest[2] = {0.0, 0.0};
  for (std::size_t i = 0; i < 4; ++i) {
    begin[i] = place_[v[i]];
    end[i] = begin[i] + way_[v[i]] - mean;
    double& its = longest[i < first_end ? 0 : 1];
    its = std::max(its, (way_[v[i]] - mean).squaredNorm());
  }
  const double relative = std::sqrt(longest[0]) + std::sqrt(longest[1]);
  if (relative == 0.0) return false;
  if (proximity::isSurelyApart(pair.kind, begin, margin_ + relative / (1.0 - kKept))) return false;
  const double distance = proximity::distanceOf(pair.kind, begin).distance;
  const double kept = std::min(margin_, kKept * distance);
  if (relative < distance - kept) return false;
  const auto time = proximity::earliestContact(pair.kind, begin, end, kept);
  if (!time) return false;
  ++stops;
  if (stops > kMostStops || *time <= 0.0) {
    stops = kMostStops + 1;
    limit(pair, 1.0, 0.5 * (distance - kept));
  } else {
    limit(pair, kOfTime * *time, proximity::kMaxLength);
  }
  return true;
}

/// Shortens the ways of a pair's particles. @param most m, of each
void SafeMotion::limit(const Pair& pair, double share, double most) {
  for (int vertex : pair.vertices) {
    const double length = way_[vertex].norm();
    const double shorter = std::min(share, length > most ? most / length : 1.0);
    if (shorter == 1.0) continue;
    way_[vertex] *= shorter;
    changed_[vertex] = round_;
    stopped_by_[vertex] = pair.vertices;
  }
}

}  // namespace haptex::cloth
