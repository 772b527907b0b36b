// From the steady clock to ROS's.
#pragma once

#include <ros/time.h>

#include "haptex/exoskeleton/clock.h"

namespace haptex::nodes {

/// What ROS's clock showed at a time of the steady clock not long ago, see steadyNow().
ros::Time rosTimeOf(exoskeleton::Time time);

}  // namespace haptex::nodes
