// Where the emulated person's hand and fingers are to be, from topics and from rviz.
#pragma once

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <interactive_markers/interactive_marker_server.h>
#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "haptex/base/finger.h"
#include "haptex/exoskeleton/emulator/hand_motion.h"
#include "haptex/nodes/common/input_count.h"
#include "haptex/nodes/exoskeleton_emulator/grasp.h"

namespace haptex::nodes {

/// Below the namespace of `node`: subscribes to <finger>/target (geometry_msgs/PointStamped in
/// hand_base or a frame that tf connects with it; the point stays where it is in hand_base) and
/// hand_base/target (geometry_msgs/PoseStamped in world); publishes the fingers' targets as spheres
/// on emulator/target_markers (visualization_msgs/MarkerArray), for subscribers only. With markers,
/// serves interactive ones of both fingertips, of their pinch and of the hand at
/// emulator/interactive_markers.
/// What is refused is counted and changes nothing. The callbacks may run on several threads.
class TargetInput {
 public:
  /// @param motion outlives this
  TargetInput(const ros::NodeHandle& node, exoskeleton::HandMotion& motion, bool markers);

  /// Shows where hand and fingers are to be. By the thread of moveOn().
  void show(const exoskeleton::HandPlace& place);

  /// Moves fingertips that close or open. @param place where they are to be now @param duration s,
  /// since the last time. By one thread.
  void moveOn(double duration, const exoskeleton::HandPlace& place);

  /// From now on the fingertips close, or open again. @returns what they do
  /// @throws std::invalid_argument if they are to open and have not been closed
  std::string grasp(bool close);

  /// Movements of markers count as messages.
  InputStatus status() const { return count_.status(); }

 private:
  using Feedback = visualization_msgs::InteractiveMarkerFeedbackConstPtr;

  void receivePoint(base::Finger finger, const geometry_msgs::PointStamped& message);
  void receivePose(const geometry_msgs::PoseStamped& message);
  void receiveFeedback(const Feedback& feedback);
  void receivePinch(const geometry_msgs::Point& handle);
  void moveFingertips(const Grasp::Fingertips& targets);
  void moveInteractiveMarkers(const exoskeleton::HandPlace& place);

  ros::NodeHandle node_;
  exoskeleton::HandMotion& motion_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener transform_listener_;

  InputCount count_;
  std::mutex mutex_;     // guards the next
  std::string dragged_;  // name of the interactive marker that is held now, or empty
  Grasp grasp_;
  Grasp::Fingertips fingertips_;  // of the last moveOn()
  // While the pinch is dragged: where the handle and the fingertips were when it began.
  std::optional<std::pair<Eigen::Vector3d, Grasp::Fingertips>> pinched_;

  std::unique_ptr<interactive_markers::InteractiveMarkerServer> interactive_;  // or none
  ros::Publisher marker_publisher_;
  base::PerFinger<ros::Subscriber> point_subscribers_;
  ros::Subscriber pose_subscriber_;
};

}  // namespace haptex::nodes
