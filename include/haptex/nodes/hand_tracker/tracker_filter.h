// Which poses of a tracker are believed. Messages come from outside: nothing in them is.
#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <ros/time.h>
#include <tf2_ros/buffer.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "haptex/base/clock.h"

namespace haptex::nodes {

/// x y z (m) yaw pitch roll (rad), as tf2_ros's static_transform_publisher takes them.
/// @throws std::invalid_argument naming the text and what is allowed unless it is six finite
///   numbers with a place within TrackerFilter::kFarthest
Eigen::Isometry3d parseMounting(const std::string& text);

/// From the poses of a tracked body to those of hand_base in world. By one thread.
class TrackerFilter {
 public:
  /// A stamp may be this much before the clock here, or after it. Forces end when a pose is older
  /// than 55 ms.
  static constexpr base::Time kOldest = std::chrono::milliseconds(100);
  static constexpr base::Time kNewest = std::chrono::milliseconds(20);
  static constexpr double kFarthest = 10.0;  ///< m, of each coordinate: no hand is further away
  /// m/s and rad/s: from one pose to the next no hand is faster. What is, is another marker or a
  /// reflection that the tracker took for the hand.
  static constexpr double kFastest = 5.0, kFastestTurning = 30.0;
  /// After this long without a pose taken the next is taken wherever it is: the hand may have
  /// moved.
  static constexpr base::Time kForgetAfter = std::chrono::milliseconds(250);

  /// @param mounting pose of hand_base in the frame of the tracked body
  explicit TrackerFilter(const Eigen::Isometry3d& mounting) : mounting_(mounting) {}

  /// @param transforms from the message's frame to world @param now of ROS
  /// @returns pose of hand_base in world (m)
  /// @throws std::invalid_argument naming what is wrong with the message and what is allowed; it is
  ///   as if it had not come then
  Eigen::Isometry3d receive(const geometry_msgs::PoseStamped& message,
                            const tf2_ros::Buffer& transforms, const ros::Time& now);

 private:
  struct Taken {
    Eigen::Isometry3d hand;
    ros::Time stamp;
  };

  void requireReachable(const Taken& next) const;

  Eigen::Isometry3d mounting_;
  std::optional<Taken> last_;
};

}  // namespace haptex::nodes
