// Which poses and velocities of a fingertip are believed. Messages come from outside: nothing in
// them is.
#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <haptex/Fingertips.h>
#include <ros/time.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "haptex/base/clock.h"
#include "haptex/base/finger.h"
#include "haptex/simulation/fingertip_motion.h"

namespace haptex::nodes {

/// Takes exoskeleton/fingertips, measured_cp and measured_cv of one finger, in handFrame(). Drops
/// and counts those that are in another frame, not finite or beyond what a hand does, stamped more
/// than kStampTolerance before or after ROS's clock, or not later than the one before of their
/// kind.
class FingertipFilter {
 public:
  using Time = base::Time;

  static constexpr Time kStampTolerance = std::chrono::milliseconds(20);
  /// After this long without a message taken the next may have any stamp within the tolerance, so
  /// that a driver that was started anew is believed again.
  static constexpr Time kForgetAfter = std::chrono::milliseconds(100);
  static constexpr double kFarthest = 10.0;          ///< m
  static constexpr double kFastest = 100.0;          ///< m/s
  static constexpr double kFastestTurning = 1000.0;  ///< rad/s

  /// By one thread. @param now of ROS @param steady_now of the steady clock
  std::optional<Eigen::Isometry3d> receive(const geometry_msgs::PoseStamped& message,
                                           const ros::Time& now, Time steady_now);
  std::optional<simulation::FingertipTwist> receive(const geometry_msgs::TwistStamped& message,
                                                    const ros::Time& now, Time steady_now);
  /// What is in it of `finger`.
  std::optional<simulation::FingertipMotion> receive(const haptex::Fingertips& message,
                                                     base::Finger finger, const ros::Time& now,
                                                     Time steady_now);

  /// By any thread: messages dropped since the construction, and why the last of them was.
  std::uint64_t dropped() const;
  std::string lastDrop() const;

 private:
  struct Last {
    ros::Time stamp;
    std::optional<Time> time;
  };

  /// Runs `convert`, which throws what is wrong, and remembers what was.
  template <typename Value, typename Message, typename Convert>
  std::optional<Value> receive(const char* topic, const Message& message, const ros::Time& now,
                               Time steady_now, Last& last, const Convert& convert);

  Last last_pose_;
  Last last_twist_;
  Last last_motion_;

  mutable std::mutex mutex_;  // guards the next
  std::uint64_t dropped_ = 0;
  std::string last_drop_;
};

}  // namespace haptex::nodes
