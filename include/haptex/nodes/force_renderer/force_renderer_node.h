// The node force_renderer: parameters, topics and diagnostics of the forces between fingertips and
// cloth.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <haptex/ClothMesh.h>
#include <haptex/ClothState.h>
#include <haptex/Contact.h>
#include <haptex/Fingertips.h>
#include <haptex/ServoForce.h>
#include <haptex/ServoForces.h>
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

#include "haptex/base/finger.h"
#include "haptex/nodes/common/immediate_queue.h"
#include "haptex/nodes/common/loop_diagnostics.h"
#include "haptex/nodes/common/message_pool.h"
#include "haptex/nodes/common/message_threads.h"
#include "haptex/nodes/force_renderer/contact_markers.h"
#include "haptex/nodes/force_renderer/fingertip_filter.h"
#include "haptex/nodes/force_renderer/patch_supplier.h"
#include "haptex/nodes/force_renderer/subscriber_names.h"
#include "haptex/realtime/duration_histogram.h"
#include "haptex/realtime/periodic_thread.h"
#include "haptex/realtime/rate_meter.h"
#include "haptex/simulation/force_loop.h"

namespace haptex::nodes {

/// Parameters of the node, read once at the start.
struct ForceRendererParameters {
  std::string scene_path;  ///< ~scene: as of cloth_simulation
  /// ~index_radius, ~thumb_radius: m, > 0, at most 0.1; default 0.0075 and 0.009, the round ends
  /// in urdf/hand_exoskeleton.urdf
  base::PerFinger<double> radii;
  /// ~fingers: both (default), index or thumb; one that does not touch feels nothing, and is not
  /// missed
  base::PerFinger<bool> touches{{true, true}};
  bool tactile = false;  ///< whether the scene lists it: forces under contactors are needed

  /// @throws std::invalid_argument naming the parameter, its value and what is allowed
  static ForceRendererParameters read(const ros::NodeHandle& private_node);
};

/// Below the namespace of `node`: subscribes to cloth/mesh, cloth/state, cloth/heartbeat,
/// exoskeleton/fingertips and, for each finger, <finger>/measured_cp and measured_cv, which count
/// where a device has no exoskeleton/fingertips; needs the transform of hand_base to world and the
/// service proximity/query; advertises exoskeleton/servo_cf (ServoForces) and, for nodes that do
/// not subscribe to that, <finger>/servo_cf (ServoForce) at 1 kHz, <finger>/contact (Contact) at
/// 250 Hz, cloth/contact_forces (ContactForces) once per state of the cloth that is touched, and
/// contact/markers (visualization_msgs/MarkerArray, 30 Hz), for subscribers only.
///
/// The loop of 1 kHz runs on a thread of its own, which exoskeleton/fingertips wakes up, and waits
/// for none of the others: one takes what comes in from the cloth and tf, one asks the proximity
/// service and prepares patches, and markers and diagnostics run wherever the caller spins.
class ForceRendererNode {
 public:
  /// @throws std::exception with a message naming what was wrong with a parameter or a file
  ForceRendererNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);
  ~ForceRendererNode();

  /// Commands no force and ends the threads. Afterwards only to be destroyed.
  void stop();

 private:
  using Finger = base::Finger;
  using Time = base::Time;
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  struct FingerTopics {
    ros::Subscriber pose;
    ros::Subscriber twist;
    SubscriberNames force_subscribers;
    ros::Publisher force;
    std::atomic<bool> force_wanted{false};  // by a node that does not take both forces at once
    ros::Publisher contact;
    FingertipFilter filter;
    std::atomic<std::uint64_t> poses{0};  // taken
    bool has_array = false;               // of the thread of what comes in
    // Of the loop's thread.
    MessagePool<haptex::ServoForce> force_messages;
    haptex::Contact contact_message;
  };

  ForceRendererNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                    const ForceRendererParameters& parameters);

  void advertise();
  void findWhoTakesSingles();
  void subscribe();
  void subscribeToFinger(Finger finger);

  // Where the messages of the device arrive.
  void receiveFingertips(const haptex::Fingertips& message);
  bool receivesSingly(Time arrival) const;

  // On the thread of what comes in.
  void receiveState(const haptex::ClothState& message);
  void receiveTransforms();
  void receiveHandBase();
  void receiveArray(Finger finger);

  // On the loop's thread.
  void work(Time now);
  void publishForces(const ros::Time& stamp);
  void publishContact(Finger finger, const ros::Time& stamp);

  void publishMarkers();

  void addDiagnostics();
  void diagnoseLoop(Status& status);
  void diagnoseSources(Status& status);
  void diagnoseForce(Finger finger, Status& status);
  std::string whyNoForce(Finger finger, const simulation::RendererNews& news, Time now) const;
  std::string whyAnyNoForce(const simulation::RendererNews& news, Time now) const;

  ros::NodeHandle node_;
  ros::NodeHandle device_node_;  // whose callbacks run where the messages arrive
  ImmediateQueue device_queue_;
  MessageThreads input_thread_;
  ros::NodeHandle input_node_;  // whose callbacks run there
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener transform_listener_;

  const base::PerFinger<bool> touches_;
  const bool tactile_;  // the scene lists it
  simulation::ForceLoop loop_;
  base::PerFinger<FingerTopics> fingers_;
  SubscriberNames both_forces_subscribers_;
  ros::Publisher both_forces_publisher_;
  MessagePool<haptex::ServoForces> both_forces_messages_;  // of the loop's thread
  realtime::DurationHistogram tick_durations_;
  int ticks_to_contact_ = 0;  // of the loop's thread
  ros::Subscriber fingertip_subscriber_;
  // Where they arrive; read where single poses do, which within one process is another thread.
  std::atomic<Time> last_fingertips_{Time{0}};

  // Of the thread of what comes in.
  simulation::LargeScaleState state_;
  ros::Time hand_base_stamp_;
  bool has_hand_base_ = false;
  Eigen::Isometry3d fixed_hand_base_ = Eigen::Isometry3d::Identity();
  ros::Subscriber state_subscriber_;
  ros::Subscriber heartbeat_subscriber_;
  ros::Subscriber transform_subscriber_, static_transform_subscriber_;

  mutable std::mutex mutex_;  // guards the next
  std::uint64_t dropped_states_ = 0;
  std::string last_dropped_state_;

  ros::Subscriber mesh_subscriber_;
  ros::Publisher marker_publisher_;
  ContactMarkers markers_;  // used by its timer only, and so are the next
  realtime::RateMeter force_rate_, cloth_rate_, proximity_rate_, exoskeleton_rate_;
  ros::SteadyTimer marker_timer_;

  diagnostic_updater::Updater diagnostics_;  // used by its timer only, and so are the next
  LoopDiagnostics loop_diagnostics_;
  realtime::DurationHistogram::Counts diagnosed_durations_;
  ros::SteadyTimer diagnostics_timer_;

  std::atomic<bool> stopping_{false};
  std::atomic<int> last_commands_{0};  ///< of no force, since it is stopping
  PatchSupplier supplier_;
  realtime::PeriodicThread loop_thread_;  // last: it uses the members above
};

}  // namespace haptex::nodes
