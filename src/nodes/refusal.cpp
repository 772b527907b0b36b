#include "haptex/nodes/refusal.h"

#include <ros/ros.h>

namespace haptex::nodes {

int refuseToRun(const char* node, const std::exception& why) {
  ROS_FATAL("%s: %s", node, why.what());
  if (ros::param::param("~stay", false)) ros::waitForShutdown();
  return 1;
}

}  // namespace haptex::nodes
