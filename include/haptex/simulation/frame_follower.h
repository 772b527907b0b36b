// A moving frame whose pose is told now and then, as a smooth motion. Knows no ROS.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "haptex/base/clock.h"

namespace haptex::simulation {

/// Pose and velocity of a frame in another one, by whose axes the velocities are.
struct FrameMotion {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< m/s, of its origin
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< rad/s
};

/// Extrapolates with the velocity between the last two poses, so that there is no delay, and blends
/// the error of the extrapolation out within a period, so that there is no step: a fingertip on a
/// hand that moves with 0.1 m/s and is told 100 times a second would step by 1 mm otherwise.
/// Allocates nothing.
class FrameFollower {
 public:
  using Time = base::Time;

  /// Nobody extrapolates further than so many periods, or than kLongestPeriod.
  static constexpr int kPeriods = 2;
  static constexpr Time kLongestPeriod = std::chrono::milliseconds(50);

  /// @param time when the frame was there
  /// @param now >= all earlier ones of receive() and at()
  void receive(const Eigen::Isometry3d& pose, Time time, Time now);

  /// Whether it has received one.
  bool knowsPose() const { return time_.has_value(); }
  /// Before the first pose the identity at rest.
  FrameMotion at(Time now) const;

 private:
  FrameMotion extrapolate(Time now) const;

  std::optional<Time> time_;  // of the last pose
  FrameMotion last_;
  Time period_{0};  // between the last two poses; 0: there is only one

  // What remains of the error when the last pose came.
  Time blend_begin_{0};
  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();       // m
  Eigen::AngleAxisd turn_{0.0, Eigen::Vector3d::UnitX()};  // from the last pose's extrapolation
};

}  // namespace haptex::simulation
