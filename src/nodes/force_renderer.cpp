// The node force_renderer, see haptex/nodes/force_renderer_node.h.
#include <ros/ros.h>

#include <exception>

#include "haptex/nodes/force_renderer_node.h"
#include "haptex/nodes/refusal.h"
#include "haptex/nodes/scheduling.h"

int main(int argc, char** argv) {
  haptex::nodes::preferMessages();
  ros::init(argc, argv, "force_renderer");
  const ros::NodeHandle node;  // outlives the exception: without a node ROS_FATAL prints nothing
  try {
    const haptex::nodes::ForceRendererNode force_renderer_node(node, ros::NodeHandle("~"));
    ros::spin();
  } catch (const std::exception& error) {
    return haptex::nodes::refuseToRun("force_renderer", error);
  }
  return 0;
}
