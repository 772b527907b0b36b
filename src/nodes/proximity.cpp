// The node proximity, see haptex/nodes/proximity_node.h.
#include <ros/ros.h>

#include <exception>

#include "haptex/nodes/proximity_node.h"
#include "haptex/nodes/refusal.h"
#include "haptex/nodes/scheduling.h"

int main(int argc, char** argv) {
  haptex::nodes::preferMessages();
  ros::init(argc, argv, "proximity");
  const ros::NodeHandle node;  // outlives the exception: without a node ROS_FATAL prints nothing
  try {
    const haptex::nodes::ProximityNode proximity_node(node, ros::NodeHandle("~"));
    ros::MultiThreadedSpinner(4).spin();  // two fingertips, the states, and the rest
  } catch (const std::exception& error) {
    return haptex::nodes::refuseToRun("proximity", error);
  }
  return 0;
}
