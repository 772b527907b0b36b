#include "haptex/nodes/exoskeleton_emulator/emulator_node.h"

#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <std_msgs/String.h>

#include <exception>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/common/config_files.h"
#include "haptex/nodes/common/diagnostics_timer.h"
#include "haptex/nodes/common/driver_messages.h"
#include "haptex/nodes/common/node_parameters.h"
#include "haptex/nodes/common/ros_time.h"
#include "haptex/nodes/common/transforms.h"
#include "haptex/nodes/common/vector_messages.h"
#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes {
namespace {

using base::Finger;
using base::kFingers;
using base::Time;
using diagnostic_msgs::DiagnosticStatus;

constexpr char kPathDirectory[] = "paths";
constexpr char kRestPath[] = "rest";
constexpr double kHandPeriod = 0.01;        // s, of the pose of the hand
constexpr std::uint64_t kHandsPerShow = 4;  // of its markers
constexpr std::uint32_t kTruthQueue = 100;  // messages
constexpr Time kPatience = std::chrono::milliseconds(100);

std::string readPath(const ros::NodeHandle& private_node) {
  std::string path;
  if (!private_node.hasParam("path") || (private_node.getParam("path", path) && path.empty())) {
    return findConfigFile(kPathDirectory, kRestPath);
  }
  return readConfigPath(private_node, "path", kPathDirectory);
}

geometry_msgs::WrenchStamped forceMessage(const Eigen::Vector3d& force, const ros::Time& stamp) {
  geometry_msgs::WrenchStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = handFrame();
  message.wrench.force = vectorMessage(force);
  return message;
}

/// Before the threads start.
base::PerFinger<TruthTopics> advertiseTruth(ros::NodeHandle& node) {
  base::PerFinger<TruthTopics> topics;
  for (const Finger finger : kFingers) {
    const std::string prefix = std::string("emulator/") + base::name(finger);
    topics[finger].contact_force =
        node.advertise<geometry_msgs::WrenchStamped>(prefix + "/contact_force", kTruthQueue);
    topics[finger].motor_force =
        node.advertise<geometry_msgs::WrenchStamped>(prefix + "/motor_force", kTruthQueue);
  }
  return topics;
}

}  // namespace

EmulatorNodeParameters EmulatorNodeParameters::read(const ros::NodeHandle& private_node) {
  const std::string link =
      readPort(private_node, "link", "the path of the symbolic link to the emulator's port");
  const RobotDescription description = readRobotDescription(private_node);
  kinematicsOf(description);  // throws what the emulator would, with the parameter's name
  return {link, description.urdf, exoskeleton::loadHandPath(readPath(private_node)),
          readSwitch(private_node, "markers")};
}

EmulatorNode::EmulatorNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : EmulatorNode(node, private_node, EmulatorNodeParameters::read(private_node)) {}

EmulatorNode::EmulatorNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                           EmulatorNodeParameters parameters)
    : node_(node),
      link_(parameters.link),
      motion_(std::move(parameters.path)),
      targets_(node, motion_, parameters.markers),
      truth_topics_(advertiseTruth(node_)),
      emulator_(parameters.urdf, parameters.link,
                [this](const exoskeleton::EmulatorSample& sample) {
                  if (truth_wanted_) truth_.write(sample);
                }),
      diagnostics_(node, private_node),
      publishing_thread_([this] {
        while (!stopping_) publishTruth();
      }),
      emulator_thread_(exoskeleton::Emulator::kPeriod, [this](Time now) { work(now); },
                       {{}, realtime::kLoopPriority, true}) {
  advertise();
  hand_thread_.start();
  ROS_INFO("The emulated exoskeleton is at %s", link_.c_str());
}

EmulatorNode::~EmulatorNode() { stop(); }

void EmulatorNode::stop() {
  if (stopping_.exchange(true)) return;
  hand_timer_.stop();
  hand_thread_.stop();
  diagnostics_timer_.stop();
  emulator_thread_.stop();
  publishing_thread_.join();
}

void EmulatorNode::advertise() {
  phase_topic_ = node_.advertise<std_msgs::String>("emulator/phase", 1, true);
  fault_service_ =
      node_.advertiseService("emulator/inject_fault", &EmulatorNode::injectFault, this);
  power_service_ = node_.advertiseService("emulator/power_cycle", &EmulatorNode::cyclePower, this);
  hand_timer_ = hand_thread_.handle(node_).createSteadyTimer(
      ros::WallDuration(kHandPeriod), [this](const ros::SteadyTimerEvent&) { publishHand(); });
  diagnostics_.setHardwareID("none");
  diagnostics_.add("exoskeleton emulator", [this](Status& status) { diagnose(status); });
  diagnostics_timer_ = publishOnceASecond(node_, diagnostics_);
}

/// On the emulator's thread.
void EmulatorNode::work(Time now) {
  const exoskeleton::HandPlace place = motion_.at(now);
  for (const Finger finger : kFingers) emulator_.setTarget(finger, place.fingertips[finger]);
  emulator_.turnHand(place.hand_base.linear());
  emulator_.advanceTo(now);
  places_.write(place);
}

/// On the publishing thread.
void EmulatorNode::publishTruth() {
  exoskeleton::EmulatorSample sample;
  if (!truth_.read(sample, kPatience)) return;
  const ros::Time stamp = rosTimeOf(sample.time);
  for (const Finger finger : kFingers) {
    const TruthTopics& topics = truth_topics_[finger];
    const exoskeleton::EmulatedTruth& truth = sample.fingers[finger];
    if (topics.contact_force.getNumSubscribers() > 0) {
      topics.contact_force.publish(forceMessage(truth.contact_force, stamp));
    }
    if (topics.motor_force.getNumSubscribers() > 0) {
      topics.motor_force.publish(forceMessage(truth.motor_force, stamp));
    }
  }
}

void EmulatorNode::publishHand() {
  if (!places_.update() && hands_ == 0) return;  // the emulator has not begun
  const exoskeleton::HandPlace& place = places_.value();
  geometry_msgs::TransformStamped message;
  message.header.stamp = ros::Time::now();
  message.header.frame_id = fixedFrame();
  message.child_frame_id = handFrame();
  message.transform = transformMessage(place.hand_base);
  broadcaster_.sendTransform(message);
  if (hands_++ % kHandsPerShow == 0) targets_.show(place);
  if (place.phase != phase_) {
    phase_ = place.phase;
    std_msgs::String phase;
    phase.data = motion_.path().phases()[phase_];
    phase_topic_.publish(phase);
  }

  bool wanted = false;
  for (const TruthTopics& topics : truth_topics_.values) {
    wanted = wanted || topics.contact_force.getNumSubscribers() > 0 ||
             topics.motor_force.getNumSubscribers() > 0;
  }
  truth_wanted_ = wanted;
}

bool EmulatorNode::injectFault(haptex::InjectFault::Request& request,
                               haptex::InjectFault::Response& response) {
  try {
    const serial::EmulatorFault fault = exoskeleton::parseFault(
        request.fault, request.direction, request.probability, request.duration);
    emulator_.inject(fault);
    response.success = true;
    response.message = answerTo(fault);
  } catch (const std::invalid_argument& error) {
    response.success = false;
    response.message = error.what();
    ROS_WARN_THROTTLE(1.0, "emulator/inject_fault refused: %s", error.what());
  }
  return true;
}

bool EmulatorNode::cyclePower(std_srvs::Trigger::Request& /*request*/,
                              std_srvs::Trigger::Response& response) {
  emulator_.cyclePower();
  response.success = true;
  std::ostringstream message;
  message << "the device is off and, " << base::seconds(exoskeleton::Emulator::kOffTime)
          << " s later, on again";
  response.message = message.str();
  return true;
}

void EmulatorNode::diagnose(Status& status) {
  const exoskeleton::EmulatorStatus now = emulator_.status();
  const InputStatus targets = targets_.status();
  const std::string refusal =
      targets.refused > 0 ? targets.refused_from + ": " + targets.refused_why : "";
  std::string faults;
  for (const std::string& fault : now.faults) faults += (faults.empty() ? "" : ", ") + fault;
  if (!now.port_trouble.empty()) {
    status.summary(DiagnosticStatus::ERROR, "has no port: " + now.port_trouble);
  } else if (now.skips > diagnosed_.skips) {
    status.summaryf(DiagnosticStatus::WARN, "gave up %.1f ms to keep up with real time",
                    base::milliseconds(now.skipped - diagnosed_.skipped));
  } else if (targets.refused > diagnosed_refusals_) {
    status.summary(DiagnosticStatus::WARN, "refused " + refusal);
  } else if (!faults.empty()) {
    status.summary(DiagnosticStatus::OK, "in real time, with faults asked for: " + faults);
  } else {
    status.summary(DiagnosticStatus::OK, now.powered ? "in real time" : "switched off");
  }
  status.add("port", link_);
  status.add("port is open", now.port_open);
  status.add("faults now", faults);
  status.add("largest real-time lag (ms)", base::milliseconds(now.largest_lag));
  status.add("time given up (ms)", base::milliseconds(now.skipped));
  status.add("times that time was given up", now.skips);
  const std::string& refused = emulator_thread_.refusedScheduler();
  status.add("SCHED_FIFO", refused.empty() ? "granted" : "not granted: " + refused);
  status.add("watchdog trips of the firmware", now.watchdog_trips);
  status.add("bytes in", now.line.bytes_in);
  status.add("bytes out", now.line.bytes_out);
  status.add("bytes that nobody took", now.line.bytes_lost);
  status.add("ports opened", now.line.ports);
  status.add("targets taken", targets.taken);
  status.add("targets refused", targets.refused);
  status.add("why the last target was refused", refusal);
  status.add("forces not published in time", truth_.lost());
  diagnosed_ = now;
  diagnosed_refusals_ = targets.refused;
}

}  // namespace haptex::nodes
