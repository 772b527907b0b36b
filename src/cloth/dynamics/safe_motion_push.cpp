// Obstacles that move through a step, and carry what is in their way.
#include <algorithm>

#include "haptex/cloth/dynamics/safe_motion.h"

namespace haptex::cloth {

using Eigen::Vector3d;

MotionCut SafeMotion::push(NearPairs& near, NearObstacles& obstacles, const Vectors& from,
                           Vectors& reached) {
  constexpr int kMostPasses = 1000, kMostConflicts = 8;
  ObstacleSurfaces& surfaces = obstacles.surfaces();
  const Vectors& end = surfaces.atEnd();
  place_ = from;
  if (end == surfaces.atBegin()) {
    reached = place_;
    return {};
  }
  obstacle_place_ = surfaces.atBegin();
  obstacle_way_.resize(end.size());
  for (std::size_t k = 0; k < end.size(); ++k) obstacle_way_[k] = end[k] - obstacle_place_[k];
  common_.setZero();
  way_.assign(place_.size(), Vector3d::Zero());
  const Pair* first = nullptr;
  const double time = firstTouch(
      obstacles.onWays(place_, common_, way_, obstacle_place_, &obstacle_way_, 0.5 * margin_),
      &first);
  advanceObstacles(first == nullptr ? 1.0 : kOfTime * time, end);
  MotionCut cut;
  int conflicts = 0;
  for (int pass = 0; pass < kMostPasses && obstacle_place_ != end; ++pass) {
    if (pushOn(near, obstacles, cut) < 1.0 && ++conflicts == kMostConflicts) break;
  }
  reached = place_;
  if (obstacle_place_ == end) return {};
  for (std::size_t k = 0; k < end.size(); ++k) {
    const double missing = (end[k] - obstacle_place_[k]).norm();
    cut.particles += missing > 0.0;
    cut.longest = std::max(cut.longest, missing);
  }
  surfaces.stopAt(obstacle_place_);
  return cut;
}

/// @param share of obstacle_way_; 1: if that leads to the end, exactly there
void SafeMotion::advanceObstacles(double share, const Vectors& end) {
  for (std::size_t k = 0; k < end.size(); ++k) {
    const Vector3d left = end[k] - obstacle_place_[k];
    const bool whole =
        share == 1.0 && (obstacle_way_[k] - left).squaredNorm() <= 1e-24 * left.squaredNorm();
    obstacle_place_[k] = whole ? end[k] : Vector3d(obstacle_place_[k] + share * obstacle_way_[k]);
  }
}

/// One pass, as far as all pairs are known.
/// @param cut by which pair, if something could not be carried
/// @return the share of the pass that was possible
double SafeMotion::pushOn(NearPairs& near, NearObstacles& obstacles, MotionCut& cut) {
  const Vectors& end = obstacles.surfaces().atEnd();
  const double known = kKnown * near.searched();
  if (!near.find(place_, known)) return 0.0;
  obstacles.find(place_, obstacle_place_, known);
  double longest = 0.0;
  for (std::size_t k = 0; k < end.size(); ++k) {
    obstacle_way_[k] = end[k] - obstacle_place_[k];
    longest = std::max(longest, obstacle_way_[k].norm());
  }
  const double reach = kOfReach * known;
  if (longest > reach) {
    for (Vector3d& way : obstacle_way_) way *= reach / longest;
  }
  std::fill(way_.begin(), way_.end(), Vector3d::Zero());
  carry(near, obstacles);
  const Pair* first = nullptr;
  double time = 1.0;
  for (const auto* pairs : {&obstacles.pairs(), &near.pairs(), &near.neighbours()}) {
    const Pair* its_first = nullptr;
    const double its = firstTouch(*pairs, &its_first);
    if (its_first == nullptr || (first != nullptr && its >= time)) continue;
    first = its_first;
    time = its;
  }
  const double share = first == nullptr ? 1.0 : kOfTime * time;
  for (std::size_t i = 0; i < place_.size(); ++i) place_[i] += share * way_[i];
  advanceObstacles(share, end);
  if (first != nullptr) {
    cut.between = first->vertices;
    cut.obstacle = first->obstacle;
  }
  return share;
}

/// Whatever would touch is to go with what runs into it.
void SafeMotion::carry(const NearPairs& near, const NearObstacles& obstacles) {
  stops_.assign(near.pairs().size(), 0);
  neighbour_stops_.assign(near.neighbours().size(), 0);
  obstacle_stops_.assign(obstacles.pairs().size(), 0);
  std::fill(changed_.begin(), changed_.end(), 0);
  bool carried = true;
  for (round_ = 1; carried; ++round_) {
    carried = false;
    for (std::size_t p = 0; p < obstacle_stops_.size(); ++p) {
      carried = carry(obstacles.pairs()[p], obstacle_stops_[p]) || carried;
    }
    // At first only obstacles move.
    if (round_ == 1 && !carried) return;
    for (std::size_t p = 0; p < stops_.size(); ++p) {
      carried = carry(near.pairs()[p], stops_[p]) || carried;
    }
    for (std::size_t p = 0; p < neighbour_stops_.size(); ++p) {
      carried = carry(near.neighbours()[p], neighbour_stops_[p]) || carried;
    }
  }
}

/// @param times that the pair has been carried
/// @return whether it is now
bool SafeMotion::carry(const Pair& pair, char& times) {
  if (times > kMostStops || !mayHaveChanged(pair) || !touch(pair)) return false;
  ++times;
  const Vector3d way = wayOfCarrier(pair);
  for (const int vertex : pair.vertices) {
    if (!isParticle(vertex) || way_[vertex].squaredNorm() >= way.squaredNorm()) continue;
    way_[vertex] = way;
    changed_[vertex] = round_;
  }
  return true;
}

/// That of the obstacle at its nearest point, or else the longest of the particles.
Vector3d SafeMotion::wayOfCarrier(const Pair& pair) const {
  const auto& v = pair.vertices;
  Vector3d way = Vector3d::Zero();
  if (pair.obstacle < 0) {
    for (const int vertex : v) {
      if (way_[vertex].squaredNorm() > way.squaredNorm()) way = way_[vertex];
    }
    return way;
  }
  const Eigen::Vector4d weights =
      proximity::distanceOf(pair.kind, {placeOf(v[0]), placeOf(v[1]), placeOf(v[2]), placeOf(v[3])})
          .weights;
  for (int i = 0; i < 4; ++i) {
    if (!isParticle(v[i])) way += weights[i] * wayOf(v[i]);
  }
  return way;
}

}  // namespace haptex::cloth
