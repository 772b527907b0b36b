// Between the steady clock and ROS's, and between stamps.
#pragma once

#include <ros/time.h>

#include "haptex/base/clock.h"

namespace haptex::nodes {

/// What ROS's clock showed at a time of the steady clock not long ago, see steadyNow().
ros::Time rosTimeOf(base::Time time);

/// From one stamp to another, also where the nanoseconds of one are more than a second.
/// (ros::Duration would throw for stamps beyond 68 years.)
base::Time between(const ros::Time& earlier, const ros::Time& later);

/// How long ago the stamp of a transform was: 0 of a static one, whose stamp is zero, and of one
/// that is ahead.
base::Time ageOf(const ros::Time& stamp);

}  // namespace haptex::nodes
