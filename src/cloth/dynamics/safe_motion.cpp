#include "haptex/cloth/dynamics/safe_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "haptex/linear/shared_rows.h"
#include "haptex/proximity/continuous.h"

namespace haptex::cloth {
namespace {

using Eigen::Vector3d;

constexpr int kMostWays = 16, kMostWaysAmongObstacles = 64;
// What comes near stops half way into the thickness, where the pressure is still small, what is
// nearer keeps most of its distance: it is for forces to bring it nearer.
constexpr double kKept = 0.8;
// Needles that are neighbours at rest have no pressure: a fifth less on every way, their distance
// would be below the rounding of their places after a hundred. Below this one (m) it stays.
constexpr double kLeast = 1e-12, kKeptBelow = 1.0 - 1e-9;
// Of the margin: so near, edges that turn past each other part as a solve means it only on ways far
// shorter than it asks for, and would come nearer in every iteration.
constexpr double kPressed = 0.03;
// What is sent aside ends this much farther apart than what it keeps, or that would stop it at
// once.
constexpr double kFarther = 1.1;

}  // namespace

SafeMotion::SafeMotion(std::size_t particles, double margin, std::vector<double> of_sides,
                       linear::ThreadPool* pool)
    : margin_(margin),
      of_sides_(std::move(of_sides)),
      pool_(pool),
      place_(particles),
      left_(particles),
      way_(particles),
      common_(Vector3d::Zero()),
      stopped_by_(particles),
      changed_(particles) {}

MotionCut SafeMotion::go(NearPairs& near, NearObstacles* obstacles,
                         const std::vector<Vector3d>& from, const std::vector<Vector3d>& to,
                         std::vector<Vector3d>& reached) {
  const std::size_t particles = from.size();
  const auto is_finite = [](const Vector3d& place) { return place.allFinite(); };
  if (!std::all_of(to.begin(), to.end(), is_finite)) {
    reached = to;
    return {};
  }
  near_ = &near;
  obstacles_ = obstacles;
  place_ = from;
  to_ = to;
  if (obstacles != nullptr) obstacle_place_ = obstacles->surfaces().atEnd();
  obstacle_pairs_ = nullptr;
  stopped_by_.assign(particles, {-1, -1, -1, -1});
  const int most_ways = obstacles != nullptr ? kMostWaysAmongObstacles : kMostWays;
  for (int pass = 0; pass < most_ways; ++pass) {
    double longest = 0.0;
    for (std::size_t i = 0; i < particles; ++i) {
      const bool stopped = stopped_by_[i][0] >= 0;
      left_[i] = stopped ? Vector3d::Zero() : Vector3d(to_[i] - place_[i]);
      longest = std::max(longest, left_[i].squaredNorm());
    }
    if (longest == 0.0) break;
    // Short ways need no new search: they bring nothing to the margin from farther away.
    const double reach = kOfReach * kKnown * near.searched();
    const double known = std::min(kKnown * near.searched(), 2.0 * std::sqrt(longest) + margin_);
    if (!near.find(place_, known, pool_)) break;
    chooseWays(reach, true);
    if (obstacles != nullptr && !chooseObstaclePairs(*obstacles)) {
      chooseWays(reach, false);
      chooseObstaclePairs(*obstacles);
    }
    if (!stopOnWay(near, obstacles)) {
      chooseWays(reach, false);
      chooseObstaclePairs(*obstacles);
      stopOnWay(near, obstacles);
    }
    for (std::size_t i = 0; i < particles; ++i) {
      const Vector3d way = common_ + way_[i];
      const bool whole = (way - left_[i]).squaredNorm() <= 1e-24 * left_[i].squaredNorm();
      if (stopped_by_[i][0] < 0 && whole) {
        place_[i] = to_[i];
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
  for (const int vertex : cut.between) {
    if (vertex < static_cast<int>(particles)) continue;
    cut.obstacle = obstacles->surfaces().obstacleOf(vertex - static_cast<int>(particles));
  }
  reached = place_;
  return cut;
}

/// The common way is the mean one if far less is left beyond that, and nothing has been stopped,
/// which would have to go with it.
void SafeMotion::chooseWays(double reach, bool common) {
  common_.setZero();
  for (const Vector3d& left : left_) common_ += left;
  common_ /= static_cast<double>(left_.size());
  double most = 0.0, most_beyond = 0.0;
  bool stopped = !common;
  for (std::size_t i = 0; i < left_.size(); ++i) {
    most = std::max(most, left_[i].squaredNorm());
    most_beyond = std::max(most_beyond, (left_[i] - common_).squaredNorm());
    stopped = stopped || stopped_by_[i][0] >= 0;
  }
  constexpr double kLess = 0.25;
  if (stopped || most_beyond > kLess * kLess * most) common_.setZero();
  longest_ = 0.0;
  for (std::size_t i = 0; i < left_.size(); ++i) {
    way_[i] = left_[i] - common_;
    const double length = way_[i].norm();
    if (length > reach) way_[i] *= reach / length;
    longest_ = std::max(longest_, way_[i].squaredNorm());
  }
  longest_ = std::sqrt(longest_);
}

/// On a common way the whole cloth goes up to where it would touch an obstacle.
/// @return false if that is not worth while, and the particles have to go without a common way
bool SafeMotion::chooseObstaclePairs(NearObstacles& obstacles) {
  obstacle_way_.assign(obstacle_place_.size(), -common_);
  if (common_.isZero(0.0)) {
    obstacles.find(place_, obstacle_place_, 0.5 * margin_ + longest_, pool_);
    obstacle_pairs_ = &obstacles.pairs();
    return true;
  }
  obstacle_pairs_ =
      &obstacles.onWays(place_, common_, way_, obstacle_place_, nullptr, 0.5 * margin_, pool_);
  const Pair* first = nullptr;
  const double time = firstTouch(*obstacle_pairs_, &first);
  if (first == nullptr) return true;
  constexpr double kWorthWhile = 0.1;
  const double share = kOfTime * time;
  if (share < kWorthWhile) return false;
  common_ *= share;
  longest_ *= share;
  for (Vector3d& way : way_) way *= share;
  obstacle_way_.assign(obstacle_place_.size(), -common_);
  return true;
}

/// Shortens ways until nothing touches. @return false if a part of the cloth would touch an
/// obstacle while it goes on the common way: nothing has been stopped then
bool SafeMotion::stopOnWay(const NearPairs& near, const NearObstacles* obstacles) {
  static const std::vector<Pair> none;
  const std::vector<Pair>& at_obstacles = obstacles != nullptr ? *obstacle_pairs_ : none;
  const bool is_common = !common_.isZero(0.0);
  stops_.assign(near.pairs().size(), 0);
  asides_.assign(near.pairs().size(), {});
  neighbour_stops_.assign(near.neighbours().size(), 0);
  obstacle_stops_.assign(at_obstacles.size(), 0);
  std::fill(changed_.begin(), changed_.end(), 0);
  is_bounded_.assign(way_.size(), 0);
  // Most pairs do not touch, and threads find those; what others shorten is looked at once more.
  const bool all_are_known = pool_ != nullptr;
  if (all_are_known) touchAll(near);
  bool stopped = true;
  for (round_ = 1; stopped; ++round_) {
    stopped = false;
    for (std::size_t p = 0; p < stops_.size(); ++p) {
      const Pair& pair = near.pairs()[p];
      if (near.isBeyond(pair, margin_ + 2.0 * longest_)) continue;
      const auto* known = all_are_known && round_ == 1 ? &touches_[p] : nullptr;
      // Of obstacles those near the common way alone are known.
      Aside* aside = is_common ? nullptr : &asides_[p];
      stopped = stopBeforeContact(pair, known, stops_[p], aside) || stopped;
    }
    for (std::size_t p = 0; p < neighbour_stops_.size(); ++p) {
      stopped =
          stopBeforeContact(near.neighbours()[p], nullptr, neighbour_stops_[p], nullptr) || stopped;
    }
    for (std::size_t p = 0; p < obstacle_stops_.size(); ++p) {
      if (is_common && mayHaveChanged(at_obstacles[p]) && touch(at_obstacles[p])) {
        stopped_by_.assign(stopped_by_.size(), {-1, -1, -1, -1});
        return false;
      }
      if (is_common || obstacles->isBeyond(at_obstacles[p], 0.5 * margin_ + longest_)) continue;
      stopped = stopBeforeContact(at_obstacles[p], nullptr, obstacle_stops_[p], nullptr) || stopped;
    }
  }
  return true;
}

/// On the ways as they are.
void SafeMotion::touchAll(const NearPairs& near) {
  touches_.resize(near.pairs().size());
  linear::shareRows(pool_, static_cast<int>(touches_.size()), [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      const Pair& pair = near.pairs()[p];
      touches_[p].reset();
      if (!near.isBeyond(pair, margin_ + 2.0 * longest_)) touches_[p] = touch(pair);
    }
  });
}

/// Whether the way of one of its particles has, in this round or the one before.
bool SafeMotion::mayHaveChanged(const Pair& pair) const {
  int changed = 0;
  for (int vertex : pair.vertices) {
    if (isParticle(vertex)) changed = std::max(changed, changed_[vertex]);
  }
  return changed >= round_ - 1;
}

/// m, of an obstacle and the cloth that of the cloth alone.
double SafeMotion::marginOf(const Pair& pair) const {
  if (of_sides_.empty()) return pair.obstacle < 0 ? margin_ : 0.5 * margin_;
  const std::size_t first_end = pair.kind == proximity::ElementPairKind::kVertexTriangle ? 1 : 2;
  std::array<double, 2> least = {margin_, margin_};
  std::array<bool, 2> is_cloth = {false, false};
  for (std::size_t i = 0; i < 4; ++i) {
    if (!isParticle(pair.vertices[i])) continue;
    const std::size_t side = i < first_end ? 0 : 1;
    is_cloth[side] = true;
    least[side] = std::min(least[side], of_sides_[pair.vertices[i]]);
  }
  return (is_cloth[0] ? least[0] : 0.0) + (is_cloth[1] ? least[1] : 0.0);
}

std::optional<SafeMotion::Touch> SafeMotion::touch(const Pair& pair) const {
  const auto& v = pair.vertices;
  std::array<Vector3d, 4> begin, end;
  const Vector3d mean = 0.25 * (wayOf(v[0]) + wayOf(v[1]) + wayOf(v[2]) + wayOf(v[3]));
  const std::size_t first_end = pair.kind == proximity::ElementPairKind::kVertexTriangle ? 1 : 2;
  double longest[2] = {0.0, 0.0};
  for (std::size_t i = 0; i < 4; ++i) {
    begin[i] = placeOf(v[i]);
    end[i] = begin[i] + wayOf(v[i]) - mean;
    double& its = longest[i < first_end ? 0 : 1];
    its = std::max(its, (wayOf(v[i]) - mean).squaredNorm());
  }
  const double relative = std::sqrt(longest[0]) + std::sqrt(longest[1]);
  if (relative == 0.0) return {};
  const double margin = marginOf(pair);
  const double least =
      pair.obstacle < 0 ? near_->leastDistance(pair) : obstacles_->leastDistance(pair);
  if (relative < least - std::min(margin, kKept * least)) return {};
  const double reach = margin + relative / (1.0 - kKept) + pair.radius;
  if (proximity::isSurelyApart(pair.kind, begin, reach)) return {};
  const proximity::PairDistance nearest = proximity::distanceOf(pair.kind, begin);
  if (nearest.distance == 0.0) return {};  // there is no side to keep to
  const double distance = nearest.distance - pair.radius;
  const double kept = std::min(margin, (distance > kLeast ? kKept : kKeptBelow) * distance);
  if (relative < distance - kept) return {};
  const auto time =
      proximity::earliestContact(pair.kind, begin, end, pair.radius + kept, nearest.weights);
  if (!time) return {};
  return Touch{*time, distance, kept};
}

/// @param first of them; null if none touches @return its time, from 0 to 1
double SafeMotion::firstTouch(const std::vector<Pair>& pairs, const Pair** first) const {
  double earliest = 1.0;
  for (const Pair& pair : pairs) {
    const auto found = touch(pair);
    if (!found || (*first != nullptr && found->time >= earliest)) continue;
    earliest = found->time;
    *first = &pair;
  }
  return earliest;
}

/// @param known how it touches if nothing has shortened a way yet; null: that is not known
/// @param stops how often the pair has stopped its particles
/// @param aside where it has sent them; null: it only stops them
/// @return whether it does now
bool SafeMotion::stopBeforeContact(const Pair& pair, const std::optional<Touch>* known, char& stops,
                                   Aside* aside) {
  if (stops > kMostStops || !mayHaveChanged(pair)) return false;
  const bool is_as_known =
      known != nullptr && std::all_of(pair.vertices.begin(), pair.vertices.end(),
                                      [&](int vertex) { return changed_[vertex] == 0; });
  const auto found = is_as_known ? *known : touch(pair);
  if (!found) return false;
  if (aside != nullptr && aside->times < kMostAsides &&
      found->distance < kPressed * marginOf(pair) && sendAside(pair, found->kept, *aside)) {
    return true;
  }
  ++stops;
  if (stops > kMostStops || found->time <= 0.0) {
    stops = kMostStops + 1;
    limit(pair, 1.0, 0.5 * (found->distance - found->kept));
  } else {
    limit(pair, kOfTime * found->time, proximity::kMaxLength);
  }
  return true;
}

/// Lets the ways of a pair end as far apart as they are to first order, and not nearer than what it
/// keeps: a second-order correction (Nocedal and Wright, Numerical Optimization, 2006, section
/// 15.6). What has been stopped, or is to stay, keeps its way: bounds of other pairs rest on that.
/// @param kept m @return whether they are others now
bool SafeMotion::sendAside(const Pair& pair, double kept, Aside& aside) {
  const auto& v = pair.vertices;
  std::array<Vector3d, 4> begin, end;
  for (int i = 0; i < 4; ++i) {
    begin[i] = placeOf(v[i]);
    end[i] = begin[i] + wayOf(v[i]);
  }
  const double margin = marginOf(pair);
  const proximity::Separation from = proximity::separationOf(pair.kind, begin);
  const Vector3d before = from.away.normalized();
  if (aside.times++ == 0) {
    double to_first_order = from.distance;
    for (int i = 0; i < 4; ++i) {
      to_first_order += from.weights[i] * before.dot(wayOf(v[i]));
    }
    aside.distance = std::max(kFarther * kept, std::min(to_first_order, margin));
  }
  proximity::Separation to = proximity::separationOf(pair.kind, end);
  Vector3d normal = to.away.normalized();
  if (normal.dot(before) < 0.0) {
    normal *= -1.0;
    to.distance *= -1.0;
  }
  double mobility = 0.0;
  for (int i = 0; i < 4; ++i) {
    const bool has_been_stopped = is_bounded_[v[i]] || stopped_by_[v[i]][0] >= 0;
    if (has_been_stopped || left_[v[i]].isZero(0.0)) to.weights[i] = 0.0;
    mobility += to.weights[i] * to.weights[i];
  }
  const double missing = aside.distance - to.distance;
  if (!(missing > 0.0) || !(missing < mobility * margin)) return false;
  for (int i = 0; i < 4; ++i) {
    const Vector3d change = missing / mobility * to.weights[i] * normal;
    way_[v[i]] += change;
    const double length = way_[v[i]].norm();
    if (length > longest_) way_[v[i]] *= longest_ / length;
    left_[v[i]] += change;
    to_[v[i]] += change;
    changed_[v[i]] = round_;
  }
  return true;
}

/// Shortens the ways of a pair's particles. @param most m, of each: a bound that rests on them if
/// it is less than proximity::kMaxLength
void SafeMotion::limit(const Pair& pair, double share, double most) {
  for (int vertex : pair.vertices) {
    if (!isParticle(vertex)) continue;
    if (most < proximity::kMaxLength) is_bounded_[vertex] = 1;
    const double length = way_[vertex].norm();
    const double shorter = std::min(share, length > most ? most / length : 1.0);
    if (shorter == 1.0) continue;
    way_[vertex] *= shorter;
    changed_[vertex] = round_;
    stopped_by_[vertex] = pair.vertices;
  }
}

}  // namespace haptex::cloth
