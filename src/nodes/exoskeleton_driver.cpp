// The node exoskeleton_driver, see haptex/nodes/driver_node.h.
#include <ros/ros.h>

#include <exception>

#include "haptex/nodes/driver_node.h"
#include "haptex/nodes/scheduling.h"

int main(int argc, char** argv) {
  haptex::nodes::preferMessages();
  ros::init(argc, argv, "exoskeleton_driver");
  const ros::NodeHandle node;  // outlives the exception: without a node ROS_FATAL prints nothing
  try {
    const haptex::nodes::DriverNode driver_node(node, ros::NodeHandle("~"));
    ros::MultiThreadedSpinner(4).spin();  // one homes, the others answer meanwhile
  } catch (const std::exception& error) {
    ROS_FATAL("exoskeleton_driver: %s", error.what());
    return 1;
  }
  return 0;
}
