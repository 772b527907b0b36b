// Fingers and times as every room counts them, and the sizes of the vectors of a finger.
#pragma once

#include <Eigen/Core>

#include "haptex/base/clock.h"
#include "haptex/base/finger.h"

namespace haptex::exoskeleton {

using base::Finger;
using base::kFingers;
using base::name;
using base::PerFinger;
using base::seconds;
using base::Time;

/// Joints of a finger, from the palm to the tip, of which the last is coupled to the one before.
constexpr int kJoints = 4;
/// Motors of a finger. Motor i drives joint i.
constexpr int kMotors = 3;

using JointVector = Eigen::Matrix<double, kJoints, 1>;
using MotorVector = Eigen::Matrix<double, kMotors, 1>;

}  // namespace haptex::exoskeleton
