// Where the mechanism lets a fingertip go.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "haptex/exoskeleton/control/finger_kinematics.h"

namespace haptex::exoskeleton {

/// Finds motor angles for fingertip positions, within the limits of all four joints. Does not
/// allocate after the construction. Not thread-safe.
class FingertipReach {
 public:
  /// @throws std::invalid_argument as FingerKinematics
  FingertipReach(const std::string& urdf, Finger finger);

  /// rad; the limits of the joints, that of the coupled one included, as those of the motors.
  const MotorVector& lowest() const { return lowest_; }
  const MotorVector& highest() const { return highest_; }

  struct Place {
    MotorVector motor_angles = MotorVector::Zero();  ///< rad, within the limits
    Eigen::Vector3d position =
        Eigen::Vector3d::Zero();  ///< m, in hand_base, of the fingertip there
  };

  /// The place nearest to a target (m, in hand_base, finite). A target within reach is met to
  /// kTolerance. For one out of reach the search starts again from the nearest of a grid of places,
  /// so that where two far apart places are almost as near either may be found.
  /// @param start where to search first (rad): near it a solution is found in a few steps
  Place nearest(const Eigen::Vector3d& target, const MotorVector& start);

  /// The place nearest to a target with one motor held at an angle, found downhill from `start`.
  /// @param motor 0 to 2 @param angle rad, of that motor, within the limits
  Place nearestHolding(int motor, double angle, const Eigen::Vector3d& target,
                       const MotorVector& start);

  static constexpr double kTolerance = 1e-6;  ///< m

 private:
  Place descend(const Eigen::Vector3d& target, const MotorVector& start, const MotorVector& lowest,
                const MotorVector& highest);

  FingerKinematics kinematics_;
  MotorVector lowest_, highest_;
  std::vector<Place> grid_;
};

}  // namespace haptex::exoskeleton
