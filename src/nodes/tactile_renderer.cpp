// The node tactile_renderer, see haptex/nodes/tactile_node.h.
#include <ros/ros.h>

#include <exception>

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
    ROS_FATAL("tactile_renderer: %s", error.what());
    return 1;
  }
  return 0;
}
