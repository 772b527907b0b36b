#include "haptex/nodes/exoskeleton_driver/driver_node.h"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <haptex/OperatingState.h>
#include <sensor_msgs/JointState.h>
#include <visualization_msgs/MarkerArray.h>

#include <stdexcept>
#include <utility>

#include "haptex/base/quoted.h"
#include "haptex/exoskeleton/driver/driver_announcement.h"
#include "haptex/nodes/common/driver_messages.h"
#include "haptex/nodes/common/node_parameters.h"
#include "haptex/nodes/common/ros_time.h"
#include "haptex/nodes/markers/hand_markers.h"
#include "haptex/realtime/scheduling.h"
#include "haptex/realtime/steady_clock.h"

namespace haptex::nodes {
namespace {

using base::Finger;
using base::kFingers;
using base::Time;

constexpr Time kPosePeriod = std::chrono::milliseconds(4);
constexpr Time kJointPeriod = std::chrono::milliseconds(10);
constexpr Time kMarkerPeriod = std::chrono::milliseconds(40);
constexpr Time kOperatingStatePeriod = std::chrono::milliseconds(100);
constexpr Time kPublishPeriod = std::chrono::milliseconds(4);
constexpr Time kEndPatience = std::chrono::milliseconds(50);  // for the motors to be off
constexpr Time kEndLook = std::chrono::milliseconds(1);
constexpr Time kNewestStamp = std::chrono::milliseconds(20);  // of what a force answers
constexpr std::uint32_t kMeasuredQueue = 20;  // messages, for a subscriber that is slow for 20 ms

std::string topic(Finger finger, const char* of_finger) {
  return std::string(name(finger)) + "/" + of_finger;
}

bool sameState(const exoskeleton::OperatingState& a, const exoskeleton::OperatingState& b) {
  return a.mode == b.mode && a.is_homed == b.is_homed && a.is_busy == b.is_busy;
}

/// When the state came that has this stamp; negative: not known, or not believed.
Time timeOf(const ros::Time& stamp, const ros::Time& now, Time steady_now) {
  if (stamp.isZero()) return Time{-1};
  const Time age(static_cast<std::int64_t>(now.toNSec()) -
                 static_cast<std::int64_t>(stamp.toNSec()));
  return age >= Time{0} && age <= kNewestStamp ? steady_now - age : Time{-1};
}

void announce(const exoskeleton::DriverSnapshot& snapshot) {
  const std::string text =
      exoskeleton::announcement(snapshot.operating_state, snapshot.fault.str());
  if (snapshot.operating_state.mode == exoskeleton::Mode::kFault) {
    ROS_ERROR("%s", text.c_str());
  } else {
    ROS_INFO("%s", text.c_str());
  }
}

}  // namespace

DriverNodeParameters DriverNodeParameters::read(const ros::NodeHandle& private_node) {
  const std::string port =
      readPort(private_node, "port", "the path of a serial port, for example /dev/ttyUSB0");
  const RobotDescription description = readRobotDescription(private_node);
  return {port, description.urdf, kinematicsOf(description),
          readSwitch(private_node, "auto_recover")};
}

DriverNode::DriverNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : DriverNode(node, private_node, DriverNodeParameters::read(private_node)) {}

DriverNode::DriverNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                       DriverNodeParameters parameters)
    : node_(node),
      force_node_(node),
      loop_kinematics_{{{{parameters.urdf, Finger::kIndex}, {parameters.urdf, Finger::kThumb}}}},
      fingertip_publisher_(node_.advertise<haptex::Fingertips>("exoskeleton/fingertips", 1)),
      kinematics_(std::move(parameters.kinematics)),
      auto_recover_(parameters.auto_recover),
      loop_(parameters.port, parameters.urdf,
            [this](const exoskeleton::DriverSnapshot& snapshot) { publishFingertips(snapshot); }),
      loop_thread_(
          exoskeleton::DriverLoop::kPeriod, [this](Time now) { loop_.tick(now); },
          {[this](Time until) { return loop_.awaitState(until); }, realtime::kLoopPriority, true}),
      hand_watch_(node, loop_),
      workspace_(node, parameters.urdf),
      diagnostics_(node, private_node) {
  if (!loop_thread_.refusedScheduler().empty()) {
    ROS_WARN("The loop runs without SCHED_FIFO, on a busy machine it will be late: %s",
             loop_thread_.refusedScheduler().c_str());
  }
  advertiseTopics();
  advertiseServices();
  addDiagnostics();
  publishing_thread_ = std::thread([this] { publish(); });
}

DriverNode::~DriverNode() { stop(); }

void DriverNode::stop() {
  if (stopping_.exchange(true)) return;
  loop_.ask(exoskeleton::DriverRequest::kDisable);
  const Time end = realtime::steadyNow() + kEndPatience;
  while (loop_.status().motors_on && realtime::steadyNow() < end)
    std::this_thread::sleep_for(kEndLook);
  both_forces_subscriber_.shutdown();
  for (FingerTopics& topics : fingers_.values) topics.forces.shutdown();
  hand_watch_.stop();
  loop_thread_.stop();
  publishing_thread_.join();
}

void DriverNode::advertiseTopics() {
  force_node_.setCallbackQueue(&force_queue_);
  for (const Finger finger : kFingers) {
    FingerTopics& topics = fingers_[finger];
    // On the queue of the forces: who has gone is told after what it had commanded.
    topics.pose = force_node_.advertise<geometry_msgs::PoseStamped>(
        topic(finger, "measured_cp"), kMeasuredQueue, ros::SubscriberStatusCallback(),
        [this](const ros::SingleSubscriberPublisher& subscriber) { subscriberGone(subscriber); });
    topics.twist =
        node_.advertise<geometry_msgs::TwistStamped>(topic(finger, "measured_cv"), kMeasuredQueue);
    topics.wrench =
        node_.advertise<geometry_msgs::WrenchStamped>(topic(finger, "measured_cf"), kMeasuredQueue);
    // Only the latest force counts.
    using Event = const ros::MessageEvent<haptex::ServoForce const>&;
    const boost::function<void(Event)> take = [this, finger](Event event) {
      receiveForce(finger, *event.getConstMessage(), event.getPublisherName(), false);
    };
    topics.forces = force_node_.subscribe<haptex::ServoForce, Event>(
        topic(finger, "servo_cf"), 1, take, ros::VoidConstPtr(),
        ros::TransportHints().tcpNoDelay());
  }
  using Event = const ros::MessageEvent<haptex::ServoForces const>&;
  const boost::function<void(Event)> take_both = [this](Event event) {
    for (const Finger finger : kFingers) {
      receiveForce(finger, event.getConstMessage()->forces[static_cast<std::size_t>(finger)],
                   event.getPublisherName(), true);
    }
  };
  both_forces_subscriber_ = force_node_.subscribe<haptex::ServoForces, Event>(
      "exoskeleton/servo_cf", 1, take_both, ros::VoidConstPtr(),
      ros::TransportHints().tcpNoDelay());
  marker_publisher_ =
      node_.advertise<visualization_msgs::MarkerArray>("exoskeleton/force_markers", 2);
  joint_publisher_ = node_.advertise<sensor_msgs::JointState>("joint_states", 10);
  operating_state_publisher_ =
      node_.advertise<haptex::OperatingState>("exoskeleton/operating_state", 1, true);
}

void DriverNode::subscriberGone(const ros::SingleSubscriberPublisher& subscriber) {
  const std::string node = subscriber.getSubscriberName();
  for (const Finger finger : kFingers) {
    {
      // The renderer within this process commands on its own thread.
      const std::lock_guard<std::mutex> lock(commanders_mutex_);
      if (!commanders_.hasDied(finger, node)) continue;
      loop_.commanderDied(finger);
      fingers_[finger].filter.commanderDied(ros::Time::now(), realtime::steadyNow());
    }
    ++commander_deaths_;
    ROS_WARN("%s, which commanded the %s, has gone: its force goes to zero",
             base::shortened(node).c_str(), name(finger));
  }
}

void DriverNode::receiveForce(Finger finger, const haptex::ServoForce& message,
                              const std::string& commander, bool with_both) {
  const Time arrival = realtime::steadyNow();
  const ros::Time now = ros::Time::now();
  FingerTopics& topics = fingers_[finger];
  std::string why;
  {
    const std::lock_guard<std::mutex> lock(commanders_mutex_);
    const bool other_way = with_both != topics.came_with_both;
    if (other_way && message.header.stamp <= topics.filter.lastStamp() &&
        commanders_.commands(finger, commander)) {
      return;  // what came the other way, or was followed there by a later one
    }
    if (const auto command = topics.filter.receive(message, now, arrival)) {
      loop_.command(finger, *command, arrival, timeOf(message.measured, now, arrival));
      commanders_.commanded(finger, commander);
      topics.came_with_both = with_both;
      return;
    }
    why = topics.filter.explain(message, now);
  }
  ROS_WARN_THROTTLE(1.0, "%s/servo_cf dropped: %s", name(finger), why.c_str());
  const std::lock_guard<std::mutex> lock(topics.mutex);
  topics.last_drop = why;
  topics.last_drop_time = arrival;
  topics.has_dropped = true;
}

void DriverNode::publishFingertips(const exoskeleton::DriverSnapshot& snapshot) {
  if (!snapshot.operating_state.is_homed || fingertip_publisher_.getNumSubscribers() == 0) return;
  const boost::shared_ptr<haptex::Fingertips>& message = fingertip_messages_.next();
  fillFingertips(loop_kinematics_, snapshot.fingers, rosTimeOf(snapshot.state_time), *message);
  fingertip_publisher_.publish(message);
}

void DriverNode::publish() {
  realtime::askForFifoOnce(realtime::kMessagePriority);  // it shares roscpp's locks with the loop
  exoskeleton::DriverSnapshot snapshot;
  while (!stopping_) {
    // Some at once: to wake threads up takes longer than what they do for a message.
    std::this_thread::sleep_for(kPublishPeriod);
    bool measured = false;
    while (loop_.takeMeasured(snapshot, Time{0})) {
      publishMeasured(snapshot);
      measured = true;
    }
    if (!measured) snapshot = loop_.status();
    publishOperatingState(snapshot);
    recover(snapshot);
  }
}

void DriverNode::publishMeasured(const exoskeleton::DriverSnapshot& snapshot) {
  // Before homing nobody knows where the fingers are, and then the sensors' forces have no
  // direction either.
  if (!snapshot.operating_state.is_homed) return;
  const ros::Time stamp = rosTimeOf(snapshot.state_time);
  for (const Finger finger : kFingers) {
    const ros::Publisher& wrench = fingers_[finger].wrench;
    if (wrench.getNumSubscribers() == 0) continue;
    wrench.publish(wrenchMessage(snapshot.fingers[finger], stamp));
  }
  const auto is_due = [&](Time& due, Time period) {
    if (snapshot.state_time < due) return false;
    due = snapshot.state_time + period - exoskeleton::DriverLoop::kPeriod / 2;
    return true;
  };
  if (is_due(poses_due_, kPosePeriod)) {
    for (const Finger finger : kFingers) publishMotion(finger, snapshot, stamp);
  }
  if (is_due(joints_due_, kJointPeriod) && joint_publisher_.getNumSubscribers() > 0) {
    joint_publisher_.publish(jointStateMessage(kinematics_, snapshot.fingers, stamp));
  }
  if (is_due(markers_due_, kMarkerPeriod) && marker_publisher_.getNumSubscribers() > 0) {
    marker_publisher_.publish(forceMarkers(snapshot.fingers, stamp));
  }
}

void DriverNode::publishMotion(Finger finger, const exoskeleton::DriverSnapshot& snapshot,
                               const ros::Time& stamp) {
  const exoskeleton::FingerMeasurement& measured = snapshot.fingers[finger];
  const FingerTopics& topics = fingers_[finger];
  if (topics.pose.getNumSubscribers() > 0) topics.pose.publish(poseMessage(measured, stamp));
  if (topics.twist.getNumSubscribers() > 0) {
    const Eigen::Vector3d angular =
        angularVelocity(kinematics_[finger], measured.joint_angles, measured.joint_velocities);
    topics.twist.publish(twistMessage(measured, angular, stamp));
  }
}

void DriverNode::publishOperatingState(const exoskeleton::DriverSnapshot& snapshot) {
  const Time now = realtime::steadyNow();
  const bool changed = !sameState(snapshot.operating_state, published_state_) ||
                       !(snapshot.fault == published_fault_);
  if (!changed && now < operating_state_due_) return;
  operating_state_due_ = now + kOperatingStatePeriod;
  published_state_ = snapshot.operating_state;
  published_fault_ = snapshot.fault;
  if (changed) announce(snapshot);
  publishStateMarker(snapshot);
  operating_state_publisher_.publish(
      operatingStateMessage(snapshot.operating_state, snapshot.fault.str(), ros::Time::now()));
}

}  // namespace haptex::nodes
