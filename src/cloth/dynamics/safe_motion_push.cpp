// Obstacles that move through a step, and carry what is in their way.
#include <algorithm>

#include "haptex/cloth/dynamics/safe_motion.h"

namespace haptex::cloth {

using Eigen::Vector3d;

MotionCut SafeMotion::push(NearPairs& near, NearObstacles& obstacles, const Vectors& from,
                           Vectors& reached) {
  constexpr int kMostPasses = 1000, kMostConflicts = 8;
  constexpr double kLittle = 0.5;
  ObstacleSurfaces& surfaces = obstacles.surfaces();
  const Vectors& end = surfaces.atEnd();
  near_ = &near;
  obstacles_ = &obstacles;
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
  const double time = firstTouch(obstacles.onWays(place_, common_, way_, obstacle_place_,
                                                  &obstacle_way_, 0.5 * margin_, pool_),
                                 &first);
  advanceObstacles(first == nullptr ? 1.0 : kOfTime * time, end);
  MotionCut cut;
  int conflicts = 0;
  for (int pass = 0; pass < kMostPasses && obstacle_place_ != end; ++pass) {
    if (pushOn(near, obstacles, cut) < kLittle && ++conflicts == kMostConflicts) break;
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
  if (!near.find(place_, known, pool_)) return 0.0;
  obstacles.find(place_, obstacle_place_, known, pool_);
  double longest = 0.0;
  for (std::size_t k = 0; k < end.size(); ++k) {
    obstacle_way_[k] = end[k] - obstacle_place_[k];
    longest = std::max(longest, obstacle_way_[k].norm());
  }
  // What is carried may have to go farther.
  reach_ = kOfReach * known;
  if (longest > 0.5 * reach_) {
    for (Vector3d& way : obstacle_way_) way *= 0.5 * reach_ / longest;
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

/// First one side of a pair goes as the nearest point of the other one does. If they still would
/// touch, because something turns or both go somewhere else, it goes out of the way, too.
/// @param times that the pair has been carried
/// @return whether it is now
bool SafeMotion::carry(const Pair& pair, char& times) {
  constexpr char kMostTimes = 12;
  constexpr double kMore = 0.02;  // of the way, each time, where something turns
  if (times == kMostTimes || !mayHaveChanged(pair) || !touch(pair)) return false;
  ++times;
  const auto& v = pair.vertices;
  const Eigen::Vector4d weights =
      proximity::distanceOf(pair.kind, {placeOf(v[0]), placeOf(v[1]), placeOf(v[2]), placeOf(v[3])})
          .weights;
  const int first_end = pair.kind == proximity::ElementPairKind::kVertexTriangle ? 1 : 2;
  Vector3d points[2], ways[2];
  for (int side : {0, 1}) points[side] = ways[side] = Vector3d::Zero();
  for (int i = 0; i < 4; ++i) {
    const int side = i < first_end ? 0 : 1;
    points[side] += weights[i] * placeOf(v[i]);
    ways[side] += weights[i] * wayOf(v[i]);
  }
  const bool longer = ways[1].squaredNorm() > ways[0].squaredNorm();
  const int carrier = pair.obstacle < 0 ? longer : isParticle(v[0]);
  const int other = 1 - carrier;
  const Vector3d out = (points[other] - points[carrier]).normalized();
  const double aside =
      std::max(0.0, out.dot(ways[carrier] - ways[other])) + kMore * times * ways[carrier].norm();
  for (int i = other == 0 ? 0 : first_end; i < (other == 0 ? first_end : 4); ++i) {
    Vector3d way = times == 1 ? ways[carrier] : Vector3d(way_[v[i]] + aside * out);
    if (times == 1 && way.squaredNorm() <= way_[v[i]].squaredNorm()) continue;
    if (way.norm() > reach_) way *= reach_ / way.norm();
    way_[v[i]] = way;
    changed_[v[i]] = round_;
  }
  return true;
}

}  // namespace haptex::cloth
