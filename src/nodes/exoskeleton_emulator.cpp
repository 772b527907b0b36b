// The node exoskeleton_emulator, see haptex/nodes/emulator_node.h.
#include <ros/ros.h>

#include <exception>

#include "haptex/nodes/emulator_node.h"
#include "haptex/nodes/scheduling.h"

int main(int argc, char** argv) {
  haptex::nodes::preferMessages();
  ros::init(argc, argv, "exoskeleton_emulator");
  const ros::NodeHandle node;  // outlives the exception: without a node ROS_FATAL prints nothing
  try {
    const haptex::nodes::EmulatorNode emulator_node(node, ros::NodeHandle("~"));
    ros::MultiThreadedSpinner(2).spin();  // the hand, and the rest
  } catch (const std::exception& error) {
    ROS_FATAL("exoskeleton_emulator: %s", error.what());
    return 1;
  }
  return 0;
}
