#include "haptex/nodes/hand_tracker/hand_tracker_node.h"

#include <geometry_msgs/TransformStamped.h>

#include <stdexcept>

#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/common/diagnostics_timer.h"
#include "haptex/nodes/common/driver_messages.h"
#include "haptex/nodes/common/node_parameters.h"
#include "haptex/nodes/common/transforms.h"
#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr char kTopic[] = "tracker/pose";

Eigen::Isometry3d readMounting(const ros::NodeHandle& private_node) {
  if (!private_node.hasParam("mounting")) return Eigen::Isometry3d::Identity();
  try {
    return parseMounting(
        readText(private_node, "mounting", "x y z (m) yaw pitch roll (rad) of hand_base"));
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("parameter " + private_node.resolveName("mounting") + " = " +
                                error.what());
  }
}

}  // namespace

HandTrackerNode::HandTrackerNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : node_(node),
      filter_(readMounting(private_node)),
      transform_listener_(transforms_, node_, false),
      diagnostics_(node, private_node) {
  // Only the latest pose counts.
  subscriber_ = node_.subscribe(kTopic, 1, &HandTrackerNode::receive, this,
                                ros::TransportHints().tcpNoDelay());
  diagnostics_.setHardwareID(subscriber_.getTopic());
  diagnostics_.add("hand tracker", [this](Status& status) { diagnose(status); });
  diagnostics_timer_ = publishOnceASecond(node_, diagnostics_);
}

void HandTrackerNode::stop() {
  subscriber_.shutdown();
  diagnostics_timer_.stop();
}

void HandTrackerNode::receive(const geometry_msgs::PoseStamped& message) {
  input_.count(subscriber_.getTopic(), [&] {
    const Eigen::Isometry3d hand = filter_.receive(message, transforms_, ros::Time::now());
    geometry_msgs::TransformStamped transform;
    transform.header.stamp = message.header.stamp;
    transform.header.frame_id = fixedFrame();
    transform.child_frame_id = handFrame();
    transform.transform = transformMessage(hand);
    broadcaster_.sendTransform(transform);
  });
}

void HandTrackerNode::diagnose(Status& status) {
  const InputStatus now = input_.status();
  if (now.refused > diagnosed_.refused) {
    status.summary(DiagnosticStatus::WARN, "poses are dropped: " + now.refused_why);
  } else if (now.taken == diagnosed_.taken) {
    status.summary(DiagnosticStatus::ERROR,
                   "no poses on " + subscriber_.getTopic() + ": there is no hand, and no force");
  } else {
    status.summary(DiagnosticStatus::OK, "the hand is tracked");
  }
  status.add("topic", subscriber_.getTopic());
  status.add("poses taken", now.taken);
  status.add("poses dropped", now.refused);
  status.add("why the last pose was dropped", now.refused_why);
  diagnosed_ = now;
}

}  // namespace haptex::nodes
