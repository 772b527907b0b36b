// The node cloth_simulation, see haptex/nodes/cloth_node.h.
#include <ros/ros.h>

#include <exception>

#include "haptex/nodes/cloth_node.h"
#include "haptex/nodes/refusal.h"
#include "haptex/nodes/scheduling.h"

int main(int argc, char** argv) {
  haptex::nodes::preferMessages();
  ros::init(argc, argv, "cloth_simulation");
  const ros::NodeHandle node;  // outlives the exception: without a node ROS_FATAL prints nothing
  try {
    const haptex::nodes::ClothNode cloth_node(node, ros::NodeHandle("~"));
    ros::MultiThreadedSpinner(4).spin();  // a service that waits must not hold up the others
  } catch (const std::exception& error) {
    return haptex::nodes::refuseToRun("cloth_simulation", error);
  }
  return 0;
}
