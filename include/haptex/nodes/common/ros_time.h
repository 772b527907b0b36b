// From the steady clock to ROS's.
#pragma once

#include <ros/time.h>

#include "haptex/base/clock.h"

namespace haptex::nodes {

/// What ROS's clock showed at a time of the steady clock not long ago, see steadyNow().
ros::Time rosTimeOf(base::Time time);

}  // namespace haptex::nodes
