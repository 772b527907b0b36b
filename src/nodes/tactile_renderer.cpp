// The node tactile_renderer, see haptex/nodes/tactile_node.h.
#include <ros/ros.h>

#include <exception>

#include "haptex/nodes/refusal.h"
#include "haptex/nodes/scheduling.h"
#include "haptex/nodes/tactile_node.h"

int main(int argc, char** argv) {
  haptex::nodes::preferMessages();
  ros::init(argc, argv, "tactile_renderer");
  const ros::NodeHandle node;  // outlives the exception: without a node ROS_FATAL prints nothing
  try {
    const haptex::nodes::TactileNode tactile_node(node, ros::NodeHandle("~"));
    ros::spin();
  } catch (const std::exception& error) {
    return haptex::nodes::refuseToRun("tactile_renderer", error);
  }
  return 0;
}
