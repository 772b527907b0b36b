// How far particles of a cloth may go without any part of it passing through another, or through an
// obstacle.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "haptex/cloth/forces/self_contact/near_obstacles.h"
#include "haptex/cloth/forces/self_contact/near_pairs.h"

namespace haptex::cloth {

/// What a motion was short of.
struct MotionCut {
  int particles = 0;     ///< that did not get where they were to go
  double longest = 0.0;  ///< m, that one of them was short of
  /// The pair that stopped this one (proximity::verticesOf()); -1 if none did, but it was sent
  /// aside or the number of ways was spent. Vertices of obstacles are numbered after the particles.
  std::array<int, 4> between = {-1, -1, -1, -1};
  int obstacle = -1;  ///< that the pair has an element of; -1: none
};

/// Moves particles from one state without intersections to another, along straight ways between
/// states that it looks at. On each way no particle goes farther, beyond what all have in common,
/// than half of the distance up to which pairs are known; pairs that might touch within that are
/// tested by continuous detection (proximity::earliestContact()), and their particles stopped
/// before they touch. So two elements keep a margin, or where they are nearer already a part of
/// their distance, on every way. Of obstacles it is half of the margin. Particles of elements of
/// the cloth that are pressed on each other do not end on the straight way, but aside of it, where
/// these are as far apart as to the first order of their motion.
///
/// Allocates nothing once its buffers have had the size that they need.
class SafeMotion {
 public:
  /// @param margin    m, > 0, of all pairs at most
  /// @param of_sides m, of each particle; the margin of a pair is the sum of the least ones of its
  ///   two elements. Empty: each has half of the margin
  /// @param pool shares the work if it is given, to the same ways; has to outlive this
  SafeMotion(std::size_t particles, double margin, std::vector<double> of_sides = {},
             linear::ThreadPool* pool = nullptr);

  /// @param near of the cloth
  /// @param obstacles null if there are none. Stay where they are at the end of the step
  /// @param from m, without intersections
  /// @param to   m, where the particles are to go
  /// @param reached m, where they get without touching on the way: exactly `to` where nothing is
  ///   cut, or a number of it is not finite. May be `to`.
  MotionCut go(NearPairs& near, NearObstacles* obstacles, const std::vector<Eigen::Vector3d>& from,
               const std::vector<Eigen::Vector3d>& to, std::vector<Eigen::Vector3d>& reached);

  /// Lets obstacles go through their step while the cloth stays, but for what is in their way: that
  /// is carried with them, and whatever this runs into. Where they cannot go on, because they would
  /// press cloth against each other, they stop (ObstacleSurfaces::stopAt()), all at once.
  /// @param from m, without intersections with the obstacles at the beginning of the step
  /// @param reached m, without intersections with them at its end. May be `from`
  /// @return what the obstacles were short of: `particles` counts their vertices
  MotionCut push(NearPairs& near, NearObstacles& obstacles,
                 const std::vector<Eigen::Vector3d>& from, std::vector<Eigen::Vector3d>& reached);

 private:
  using Pair = NearPairs::Pair;
  using Vectors = std::vector<Eigen::Vector3d>;
  /// How a pair would touch.
  struct Touch {
    double time;      // of the way, from 0 to 1
    double distance;  // m, at its beginning
    double kept;      // m
  };

  /// Of a pair that is pressed.
  struct Aside {
    char times = 0;         // that its particles were sent
    double distance = 0.0;  // m, that it is to have in the end
  };

  static constexpr double kKnown = 0.9;     // of the distance that is searched for
  static constexpr double kOfReach = 0.49;  // of the distance up to which all pairs are known
  static constexpr double kOfTime = 0.95;   // up to where the kept distance is reached
  // A pair whose particles were stopped so often stops both elements half way to what is kept,
  // which is safe whatever the other does.
  static constexpr char kMostStops = 3;
  static constexpr char kMostAsides = 8;  // ways that a pressed pair is sent

  void chooseWays(double reach, bool common);
  bool chooseObstaclePairs(NearObstacles& obstacles);
  bool stopOnWay(const NearPairs& near, const NearObstacles* obstacles);
  void touchAll(const NearPairs& near);
  bool stopBeforeContact(const Pair& pair, const std::optional<Touch>* known, char& stops,
                         Aside* aside);
  bool sendAside(const Pair& pair, double kept, Aside& aside);
  void limit(const Pair& pair, double share, double most);
  std::optional<Touch> touch(const Pair& pair) const;
  bool mayHaveChanged(const Pair& pair) const;
  double firstTouch(const std::vector<Pair>& pairs, const Pair** first) const;

  double pushOn(NearPairs& near, NearObstacles& obstacles, MotionCut& cut);
  void advanceObstacles(double share, const Vectors& end);
  void carry(const NearPairs& near, const NearObstacles& obstacles);
  bool carry(const Pair& pair, char& times);

  double marginOf(const Pair& pair) const;
  bool isParticle(int vertex) const { return vertex < static_cast<int>(place_.size()); }
  const Eigen::Vector3d& placeOf(int vertex) const {
    return isParticle(vertex) ? place_[vertex] : obstacle_place_[vertex - place_.size()];
  }
  const Eigen::Vector3d& wayOf(int vertex) const {
    return isParticle(vertex) ? way_[vertex] : obstacle_way_[vertex - place_.size()];
  }

  double margin_;                 // m
  std::vector<double> of_sides_;  // m
  linear::ThreadPool* pool_;
  // Of the motion at hand.
  const NearPairs* near_ = nullptr;
  const NearObstacles* obstacles_ = nullptr;  // null if there are none
  double reach_ = 0.0;                        // m, of a pass of push()
  Vectors to_;                                // m, where the particles are to go
  Vectors place_;                             // m, reached
  Vectors left_;                              // m, of the way of each particle that is not stopped
  Vectors way_;                               // m, beyond the common one
  Eigen::Vector3d common_;                    // m
  Vectors obstacle_place_;                    // m
  Vectors obstacle_way_;                      // m, beyond the common one of the cloth
  const std::vector<Pair>* obstacle_pairs_ = nullptr;  // of this way; null: there are none
  std::vector<std::array<int, 4>> stopped_by_;         // per particle; -1: not stopped
  std::vector<int> changed_;                           // round in which the way last did
  // Per pair, how often it has stopped or carried something.
  std::vector<char> stops_, neighbour_stops_, obstacle_stops_;
  std::vector<Aside> asides_;     // of the cloth's pairs
  std::vector<char> is_bounded_;  // per particle, whether a bound rests on its way
  double longest_ = 0.0;          // m, of the ways beyond the common one before any was changed
  int round_ = 0;
  std::vector<std::optional<Touch>> touches_;  // of the pairs on ways that nothing has shortened
};

}  // namespace haptex::cloth
