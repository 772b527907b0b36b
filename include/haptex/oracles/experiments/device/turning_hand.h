// The weight of the exoskeleton's links that is felt while the hand turns in all directions.
#pragma once

#include <Eigen/Core>
#include <string>

#include "haptex/base/finger.h"

namespace haptex::oracles {

/// Which of the two that act against the weight of the links do so.
struct WeightHeld {
  bool by_feed_forward = true;  ///< the driver knows how the hand is held
  bool by_feedback = true;      ///< the force sensors work
};

/// Of one finger, without contact and with no force commanded. Forces in N.
struct FeltWeight {
  double still = 0.0;    ///< the largest force on the fingertip in a hand at rest
  double turning = 0.0;  ///< and in one that turns
  double weight = 0.0;   ///< the largest one that holds the links, by the URDF's masses
};

/// The hand turns kTurns times by 90 degrees about axes drawn at random, each time at 90 degrees/s,
/// and rests after each. The fingertips stay where they are in the hand. What the driver is told is
/// 20 ms old, once in 10 ms, as by tf.
/// @param urdf text of the exoskeleton's URDF @param fingertips m, in hand_base
/// @throws std::runtime_error if the loop does not get ready or has a fault
base::PerFinger<FeltWeight> feltWeight(const std::string& urdf,
                                       const base::PerFinger<Eigen::Vector3d>& fingertips,
                                       const WeightHeld& held, unsigned seed = 1);

constexpr int kTurns = 24;

}  // namespace haptex::oracles
