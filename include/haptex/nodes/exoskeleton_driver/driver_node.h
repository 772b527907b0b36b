// The node exoskeleton_driver: parameters, topics, services and diagnostics of the exoskeleton.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <haptex/Fingertips.h>
#include <haptex/ServoForce.h>
#include <haptex/ServoForces.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "haptex/exoskeleton/control/auto_recovery.h"
#include "haptex/exoskeleton/control/finger_kinematics.h"
#include "haptex/exoskeleton/driver/commander_watch.h"
#include "haptex/exoskeleton/driver/driver_loop.h"
#include "haptex/nodes/common/immediate_queue.h"
#include "haptex/nodes/common/loop_diagnostics.h"
#include "haptex/nodes/common/message_pool.h"
#include "haptex/nodes/exoskeleton_driver/hand_watch.h"
#include "haptex/nodes/exoskeleton_driver/servo_force_filter.h"
#include "haptex/nodes/exoskeleton_driver/workspace_watch.h"
#include "haptex/realtime/periodic_thread.h"

namespace haptex::nodes {

/// Parameters of the node, read once at the start.
struct DriverNodeParameters {
  std::string port;  ///< ~port: path of the device's serial port; it need not be there yet
  std::string urdf;  ///< robot_description, of the nearest namespace that has one
  base::PerFinger<exoskeleton::FingerKinematics> kinematics;  ///< of the urdf
  bool auto_recover = false;  ///< ~auto_recover: see exoskeleton::AutoRecovery

  /// @throws std::invalid_argument naming the parameter, what is wrong with it and what is allowed
  static DriverNodeParameters read(const ros::NodeHandle& private_node);
};

/// Below the namespace of `node`, for each finger: subscribes to <finger>/servo_cf (ServoForce),
/// and to exoskeleton/servo_cf (ServoForces), which says the same of both; advertises
/// exoskeleton/fingertips (Fingertips) and <finger>/measured_cf (geometry_msgs), one message for
/// every state of the device, <finger>/measured_cp and measured_cv at 250 Hz, joint_states at 100
/// Hz, exoskeleton/force_markers (visualization_msgs/MarkerArray, 25 Hz) and
/// exoskeleton/operating_state (latched); nothing is measured before the device is homed. Services
/// exoskeleton/enable, disable, pause, home, clear_fault (std_srvs/Trigger). Every change of the
/// operating state is said on the console, and the state with why there is no force is a text in
/// the markers. Nothing is computed for topics without subscribers. HandWatch and WorkspaceWatch
/// say what they do.
///
/// The loop of 1 kHz has a thread of its own, which the device's states wake up. It publishes
/// exoskeleton/fingertips, which the forces are computed from, and renders the forces that answer
/// it; these are taken where they arrive. A second thread publishes what is to be looked at, a
/// third opens the port, and services and diagnostics run wherever the caller spins.
class DriverNode {
 public:
  /// @throws std::exception with a message naming what was wrong with a parameter
  DriverNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);
  ~DriverNode();

  /// Forces to zero, then the motors off and the loop ended. Afterwards only to be destroyed.
  void stop();

 private:
  using Finger = base::Finger;
  using Time = base::Time;
  using Trigger = std_srvs::Trigger;
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  struct FingerTopics {
    ros::Publisher pose;
    ros::Publisher twist;
    ros::Publisher wrench;
    ros::Subscriber forces;
    ServoForceFilter filter;      // guarded by commanders_mutex_, but for its counts
    bool came_with_both = false;  // the last command; guarded likewise
    std::mutex mutex;             // guards the next
    std::string last_drop;        // why the last command was dropped
    Time last_drop_time{0};       // when
    bool has_dropped = false;
  };

  DriverNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
             DriverNodeParameters parameters);

  void advertiseTopics();
  void receiveForce(Finger finger, const haptex::ServoForce& message, const std::string& commander,
                    bool with_both);
  void subscriberGone(const ros::SingleSubscriberPublisher& subscriber);

  void publishFingertips(const exoskeleton::DriverSnapshot& snapshot);  // on the loop's thread

  // On the publishing thread.
  void publish();
  void publishMeasured(const exoskeleton::DriverSnapshot& snapshot);
  void publishMotion(Finger finger, const exoskeleton::DriverSnapshot& snapshot,
                     const ros::Time& stamp);
  void publishOperatingState(const exoskeleton::DriverSnapshot& snapshot);
  void publishStateMarker(const exoskeleton::DriverSnapshot& snapshot);
  void recover(const exoskeleton::DriverSnapshot& snapshot);

  void advertiseServices();
  bool enable(Trigger::Request& request, Trigger::Response& response);
  bool disable(Trigger::Request& request, Trigger::Response& response);
  bool pause(Trigger::Request& request, Trigger::Response& response);
  bool home(Trigger::Request& request, Trigger::Response& response);
  bool clearFault(Trigger::Request& request, Trigger::Response& response);

  void addDiagnostics();
  void diagnoseLink(Status& status);
  void diagnoseLoop(Status& status);
  void diagnoseForce(Finger finger, Status& status);
  void diagnosePlace(Finger finger, Status& status);
  std::string whyNoDevice(const exoskeleton::DriverSnapshot& snapshot) const;
  std::string whyNoForce(Finger finger, const exoskeleton::DriverSnapshot& snapshot);

  ros::NodeHandle node_;
  ros::NodeHandle force_node_;  // whose callbacks run where the messages arrive
  ImmediateQueue force_queue_;
  ros::Subscriber both_forces_subscriber_;
  std::mutex commanders_mutex_;  // guards the next, and the filters of the fingers
  exoskeleton::CommanderWatch commanders_;

  // Used by the loop's thread only.
  base::PerFinger<exoskeleton::FingerKinematics> loop_kinematics_;
  ros::Publisher fingertip_publisher_;
  MessagePool<haptex::Fingertips> fingertip_messages_;

  // Used by the publishing thread only.
  base::PerFinger<exoskeleton::FingerKinematics> kinematics_;
  Time poses_due_{0};
  Time joints_due_{0};
  Time markers_due_{0};
  Time operating_state_due_{0};
  exoskeleton::OperatingState published_state_;
  exoskeleton::FixedText published_fault_;
  const bool auto_recover_;
  exoskeleton::AutoRecovery recovery_;
  std::atomic<std::uint64_t> recoveries_{0};  // for diagnostics
  std::atomic<std::uint64_t> commander_deaths_{0};

  exoskeleton::DriverLoop loop_;
  realtime::PeriodicThread loop_thread_;
  HandWatch hand_watch_;
  WorkspaceWatch workspace_;

  base::PerFinger<FingerTopics> fingers_;
  ros::Publisher joint_publisher_;
  ros::Publisher marker_publisher_;
  ros::Publisher operating_state_publisher_;
  std::vector<ros::ServiceServer> services_;

  diagnostic_updater::Updater diagnostics_;  // used by its timer only, and so are the next
  exoskeleton::DriverSnapshot diagnosed_;
  Time diagnosed_time_{0};
  LoopDiagnostics loop_diagnostics_;
  ros::SteadyTimer diagnostics_timer_;

  std::atomic<bool> stopping_{false};
  std::thread publishing_thread_;
};

}  // namespace haptex::nodes
