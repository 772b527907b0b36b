// The node exoskeleton_emulator: parameters, topics, services and diagnostics of the emulated
// exoskeleton on a person's hand.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <haptex/InjectFault.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/transform_broadcaster.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

#include "haptex/base/finger.h"
#include "haptex/exoskeleton/emulator/emulator.h"
#include "haptex/exoskeleton/emulator/hand_motion.h"
#include "haptex/exoskeleton/emulator/hand_path.h"
#include "haptex/nodes/common/message_threads.h"
#include "haptex/nodes/exoskeleton_emulator/target_input.h"
#include "haptex/realtime/periodic_thread.h"
#include "haptex/realtime/ring.h"
#include "haptex/realtime/triple_buffer.h"

namespace haptex::nodes {

/// Parameters of the node, read once at the start.
struct EmulatorNodeParameters {
  std::string link;  ///< ~link: where the symbolic link to the emulator's port is made
  std::string urdf;  ///< robot_description, of the nearest namespace that has one
  /// ~path: of a path file, or a name in config/paths; empty or not set: config/paths/rest.yaml,
  /// the hand stays still with its fingers open.
  exoskeleton::HandPath path;
  bool markers = false;  ///< ~markers: interactive ones, default false

  /// @throws std::exception naming the parameter or file, what is wrong with it and what is allowed
  static EmulatorNodeParameters read(const ros::NodeHandle& private_node);
};

/// Of a finger.
struct TruthTopics {
  ros::Publisher contact_force;
  ros::Publisher motor_force;
};

/// Below the namespace of `node`: what TargetInput does; advertises emulator/<finger>/contact_force
/// and emulator/<finger>/motor_force (geometry_msgs/WrenchStamped, what is true and no device can
/// know, by the axes of hand_base), one message per period of the emulator, for subscribers only,
/// and emulator/phase (std_msgs/String, latched, which phase of its path the hand is in); services
/// emulator/inject_fault (srv/InjectFault), emulator/power_cycle (std_srvs/Trigger) and
/// emulator/grasp (std_srvs/SetBool: the fingertips close, or open again). Broadcasts
/// world -> hand_base on tf, 100 times a second.
///
/// The emulator runs on a thread of its own, which waits neither for topics nor for services.
class EmulatorNode {
 public:
  /// @throws std::exception with a message naming what was wrong with a parameter, file or port
  EmulatorNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);
  ~EmulatorNode();

  /// Ends the device. Afterwards only to be destroyed.
  void stop();

 private:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  EmulatorNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
               EmulatorNodeParameters parameters);

  void advertise();
  void work(base::Time now);
  void publishTruth();
  void publishHand();
  bool injectFault(haptex::InjectFault::Request& request, haptex::InjectFault::Response& response);
  bool grasp(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool cyclePower(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void diagnose(Status& status);

  ros::NodeHandle node_;
  MessageThreads hand_thread_;
  std::string link_;
  exoskeleton::HandMotion motion_;
  TargetInput targets_;
  tf2_ros::TransformBroadcaster broadcaster_;

  realtime::TripleBuffer<exoskeleton::HandPlace>
      places_;  // from the emulator's thread to hand_timer_
  // From the emulator's thread to the publishing one.
  realtime::Ring<exoskeleton::EmulatorSample, 64> truth_;
  std::atomic<bool> truth_wanted_{false};
  base::PerFinger<TruthTopics> truth_topics_;

  exoskeleton::Emulator emulator_;

  ros::Publisher phase_topic_;
  ros::ServiceServer fault_service_;
  ros::ServiceServer power_service_;
  ros::ServiceServer grasp_service_;
  ros::SteadyTimer hand_timer_;
  std::uint64_t hands_ = 0;  // published, used by that timer only, and so is the next
  int phase_ = 0;            // published
  diagnostic_updater::Updater diagnostics_;  // used by its timer only, and so are the next
  exoskeleton::EmulatorStatus diagnosed_;
  std::uint64_t diagnosed_refusals_ = 0;
  ros::SteadyTimer diagnostics_timer_;

  std::atomic<bool> stopping_{false};
  std::thread publishing_thread_;
  realtime::PeriodicThread emulator_thread_;  // last: it uses the members above
};

}  // namespace haptex::nodes
