// How the two fingertips of the exoskeleton meet.
#pragma once

#include <optional>
#include <string>

#include "haptex/exoskeleton/control/finger_kinematics.h"

namespace haptex::oracles {

/// Which frames of the two fingers are in one place.
enum class Meeting {
  kTips,  ///< <finger>_tip: the centres of the round ends, as if there were no flesh
  kPads,  ///< <finger>_tactile: the skin of one touches that of the other
};

/// A configuration of both fingers, pad against pad.
struct Pinch {
  exoskeleton::JointVector index, thumb;  ///< rad
  Eigen::Vector3d index_tip, thumb_tip;   ///< m, in hand_base
  double distance = 0.0;                  ///< m, between the frames that meet
  double angle = 0.0;                     ///< rad, between the z axis of index_tactile and the
                                          ///< reverse of that of thumb_tactile
  double smallest_singular_value = 0.0;   ///< m/rad, the smaller one of the two fingers
};

/// A pinch must stay this far (m/rad) from what exoskeleton::Configuration calls singular.
constexpr double kPinchSingularValue = 2.0 * exoskeleton::kSingular;

/// Of the pinches on a grid of the thumb's joint space that are within all limits and well
/// conditioned the one whose pads face each other best; nothing if there is none.
/// @param urdf text of the URDF
/// @throws std::invalid_argument as FingerKinematics, or if there is no link <finger>_tactile fixed
///   to <finger>_tip
std::optional<Pinch> findPinch(const std::string& urdf, Meeting meeting);

}  // namespace haptex::oracles
