// How far particles of a cloth may go without any part of it passing through another.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/cloth/forces/self_contact/near_pairs.h"

namespace haptex::cloth {

/// What a motion was short of.
struct MotionCut {
  int particles = 0;     ///< that did not get where they were to go
  double longest = 0.0;  ///< m, that one of them was short of
  /// The pair that stopped this one (proximity::verticesOf()); -1 if none did, but the number of
  /// ways was spent.
  std::array<int, 4> between = {-1, -1, -1, -1};
};

/// Moves particles from one state without intersections to another, along straight ways between
/// states that it looks at. On each way no particle goes farther, beyond what all have in common,
/// than half of the distance up to which pairs are known; pairs that might touch within that are
/// tested by continuous detection (proximity::earliestContact()), and their particles stopped
/// before they touch. So two elements keep a margin, or where they are nearer already a part of
/// their distance, on every way.
///
/// Allocates nothing once its buffers have had the size that they need.
class SafeMotion {
 public:
  /// @param margin m, > 0
  SafeMotion(std::size_t particles, double margin);

  /// @param near of the cloth
  /// @param from m, without intersections
  /// @param to   m, where the particles are to go
  /// @param reached m, where they get without touching on the way: exactly `to` where nothing is
  ///   cut, or a number of it is not finite. May be `to`.
  MotionCut go(NearPairs& near, const std::vector<Eigen::Vector3d>& from,
               const std::vector<Eigen::Vector3d>& to, std::vector<Eigen::Vector3d>& reached);

 private:
  using Pair = NearPairs::Pair;

  void chooseWays(double reach);
  bool stopBeforeContact(const Pair& pair, char& stops);
  void limit(const Pair& pair, double share, double most);

  double margin_;                       // m
  std::vector<Eigen::Vector3d> place_;  // m, reached
  std::vector<Eigen::Vector3d> left_;   // m, of the way of each particle that is not stopped
  std::vector<Eigen::Vector3d> way_;    // m, beyond the common one
  Eigen::Vector3d common_;              // m
  std::vector<std::array<int, 4>> stopped_by_;  // per particle; -1: not stopped
  std::vector<int> changed_;                    // round in which the way last did
  std::vector<char> stops_, neighbour_stops_;   // per pair, how often it has stopped something
  int round_ = 0;
};

}  // namespace haptex::cloth
