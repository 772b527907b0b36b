// Where the tips of the shipped exoskeleton are, in closed form.
#pragma once

#include <Eigen/Core>
#include <string>

#include "haptex/exoskeleton/finger.h"

namespace haptex::oracles {

/// What the URDF's comment says of a finger, typed here anew.
struct Anthropometry {
  Eigen::Vector3d first_joint;     // m, in hand_base
  Eigen::Vector3d roll_pitch_yaw;  // rad, of the first joint
  double lengths[3];               // m: two phalanges, and from the last joint to the tip
  double multiplier;               // of the coupling
  double offset;                   // rad, of the coupling
};

Anthropometry anthropometry(base::Finger finger);

/// The tip (m) of a finger that turns about z and bends about y, relative to its first joint and in
/// the frame in which that is not turned. @param angles rad, of the joints from the palm on
Eigen::Vector3d planarTip(const Anthropometry& finger, const exoskeleton::JointVector& angles);
/// The same in hand_base.
Eigen::Vector3d closedFormTip(const Anthropometry& finger, const exoskeleton::JointVector& angles);

/// The text of urdf/hand_exoskeleton.urdf beside the directory.
/// @throws std::invalid_argument naming the file if it cannot be read
std::string shippedUrdf(const std::string& config_directory);

}  // namespace haptex::oracles
