// The node force_renderer: parameters, topics and diagnostics of the forces between fingertips and
// cloth.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <haptex/ClothMesh.h>
#include <haptex/ClothState.h>
#include <haptex/Contact.h>
#include <haptex/ServoForce.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/Header.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include "haptex/exoskeleton/finger.h"
#include "haptex/nodes/contact_markers.h"
#include "haptex/nodes/duration_histogram.h"
#include "haptex/nodes/fingertip_filter.h"
#include "haptex/nodes/force_loop.h"
#include "haptex/nodes/loop_diagnostics.h"
#include "haptex/nodes/patch_supplier.h"
#include "haptex/nodes/periodic_thread.h"
#include "haptex/nodes/rate_meter.h"

namespace haptex::nodes {

/// Parameters of the node, read once at the start.
struct ForceRendererParameters {
  std::string scene_path;  ///< ~scene: as of cloth_simulation
  /// ~index_radius, ~thumb_radius: m, > 0, at most 0.1; default 0.0075 and 0.009, the round ends
  /// in urdf/hand_exoskeleton.urdf
  exoskeleton::PerFinger<double> radii;
  bool tactile = false;  ///< whether the scene lists it: forces under contactors are needed

  /// @throws std::invalid_argument naming the parameter, its value and what is allowed
  static ForceRendererParameters read(const ros::NodeHandle& private_node);
};

/// Below the namespace of `node`: subscribes to cloth/mesh, cloth/state, cloth/heartbeat and, for
/// each finger, <finger>/measured_cp and measured_cv; needs the transform of hand_base to world and
/// the service proximity/query; advertises <finger>/servo_cf (ServoForce) and <finger>/contact
/// (Contact) at 1 kHz, cloth/contact_forces (ContactForces) once per state of the cloth that is
/// touched, and contact/markers (visualization_msgs/MarkerArray, 30 Hz), for subscribers only.
///
/// The loop of 1 kHz runs on a thread of its own and waits for none of the others: one takes what
/// comes in, one asks the proximity service and prepares patches, and markers and diagnostics run
/// wherever the caller spins.
class ForceRendererNode {
 public:
  /// @throws std::exception with a message naming what was wrong with a parameter or a file
  ForceRendererNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);
  ~ForceRendererNode();

 private:
  using Finger = exoskeleton::Finger;
  using Time = exoskeleton::Time;
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  struct FingerTopics {
    FingerTopics(ros::NodeHandle node, Finger finger);

    ros::Subscriber pose;
    ros::Subscriber twist;
    ros::Publisher force;
    ros::Publisher contact;
    FingertipFilter filter;
    std::atomic<std::uint64_t> poses{0};  // taken
    bool has_array = false;               // of the thread of what comes in
    // Of the loop's thread.
    haptex::ServoForce force_message;
    haptex::Contact contact_message;
  };

  ForceRendererNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                    const ForceRendererParameters& parameters);

  void subscribe();
  void subscribeToFinger(Finger finger);

  // On the thread of what comes in.
  void takeState(const haptex::ClothState& message);
  void takeTransforms();
  void takeHandBase();
  void takeArray(Finger finger);

  void work(Time now);  // on the loop's thread
  void publishMarkers();

  void addDiagnostics();
  void diagnoseLoop(Status& status);
  void diagnoseSources(Status& status);
  void diagnoseForce(Finger finger, Status& status);

  ros::NodeHandle node_;
  ros::NodeHandle input_node_;  // whose callbacks run on a thread of their own
  ros::CallbackQueue input_queue_;
  ros::AsyncSpinner input_spinner_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener transform_listener_;

  const bool tactile_;  // the scene lists it
  ForceLoop loop_;
  exoskeleton::PerFinger<FingerTopics> fingers_;
  DurationHistogram tick_durations_;

  // Of the thread of what comes in.
  LargeScaleState state_;
  ros::Time hand_base_stamp_;
  bool has_hand_base_ = false;
  Eigen::Isometry3d fixed_hand_base_ = Eigen::Isometry3d::Identity();
  ros::Subscriber state_subscriber_;
  ros::Subscriber heartbeat_subscriber_;
  ros::SteadyTimer transform_timer_;

  mutable std::mutex mutex_;  // guards the next
  std::uint64_t dropped_states_ = 0;
  std::string last_dropped_state_;

  ros::Subscriber mesh_subscriber_;
  ros::Publisher marker_publisher_;
  ContactMarkers markers_;  // used by its timer only, and so are the next
  RateMeter force_rate_, cloth_rate_, proximity_rate_, exoskeleton_rate_;
  ros::SteadyTimer marker_timer_;

  diagnostic_updater::Updater diagnostics_;  // used by its timer only, and so are the next
  LoopDiagnostics loop_diagnostics_;
  DurationHistogram::Counts diagnosed_durations_;
  ros::SteadyTimer diagnostics_timer_;

  PatchSupplier supplier_;
  PeriodicThread loop_thread_;  // last: it uses the members above
};

}  // namespace haptex::nodes
