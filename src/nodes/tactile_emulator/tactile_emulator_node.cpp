#include "haptex/nodes/tactile_emulator/tactile_emulator_node.h"

#include <sstream>
#include <stdexcept>

#include "haptex/base/quoted.h"
#include "haptex/nodes/common/diagnostics_timer.h"
#include "haptex/nodes/common/node_parameters.h"
#include "haptex/nodes/common/service_answer.h"
#include "haptex/nodes/tactile_driver/tactile_driver_node.h"
#include "haptex/nodes/tactile_renderer/tactile_messages.h"
#include "haptex/realtime/steady_clock.h"

namespace haptex::nodes {
namespace {

using base::Finger;
using base::kFingers;
using base::Time;
using diagnostic_msgs::DiagnosticStatus;

constexpr double kStepPeriod = 2e-3;           // s
constexpr std::uint32_t kDisplayedQueue = 20;  // messages

Finger readFinger(const ros::NodeHandle& private_node, const std::string& parameter) {
  std::string text = base::name(Finger::kIndex);
  if (private_node.hasParam(parameter)) {
    text = readText(private_node, parameter, "index or thumb");
  }
  for (const Finger finger : kFingers) {
    if (text == base::name(finger)) return finger;
  }
  throw std::invalid_argument("parameter " + private_node.resolveName(parameter) + " = " +
                              base::quoted(text) + ": allowed are index and thumb");
}

int readContactor(const ros::NodeHandle& private_node, const std::string& parameter) {
  int contactor = tactile::kMiddleContactor;
  const std::string name = private_node.resolveName(parameter);
  std::ostringstream allowed;
  allowed << "allowed are whole numbers from 0 to " << tactile::kContactors - 1;
  if (private_node.hasParam(parameter) && !private_node.getParam(parameter, contactor)) {
    throw std::invalid_argument("parameter " + name + " is no whole number: " + allowed.str());
  }
  if (contactor < 0 || contactor >= tactile::kContactors) {
    throw std::invalid_argument("parameter " + name + " = " + std::to_string(contactor) + ": " +
                                allowed.str());
  }
  return contactor;
}

std::optional<tactile::PlayedContactor> readPlayed(const ros::NodeHandle& private_node) {
  std::string path;
  if (private_node.hasParam("sound") && !private_node.getParam("sound", path)) {
    throw std::invalid_argument("parameter " + private_node.resolveName("sound") +
                                " is no string: allowed is the path of a WAV file, or none");
  }
  if (path.empty()) return std::nullopt;
  return tactile::PlayedContactor{path, readFinger(private_node, "sound_finger"),
                                  readContactor(private_node, "sound_contactor")};
}

}  // namespace

TactileEmulatorParameters TactileEmulatorParameters::read(const ros::NodeHandle& private_node) {
  return {readPort(private_node, "link", "the path of the symbolic link to the emulator's port"),
          readCalibration(private_node), readPlayed(private_node)};
}

TactileEmulatorNode::TactileEmulatorNode(const ros::NodeHandle& node,
                                         const ros::NodeHandle& private_node)
    : TactileEmulatorNode(node, private_node, TactileEmulatorParameters::read(private_node)) {}

TactileEmulatorNode::TactileEmulatorNode(const ros::NodeHandle& node,
                                         const ros::NodeHandle& private_node,
                                         const TactileEmulatorParameters& parameters)
    : node_(node),
      link_(parameters.link),
      sound_path_(parameters.played ? parameters.played->path : ""),
      electronics_(parameters.link, parameters.calibration, parameters.played),
      messages_{{tactileMessage(Finger::kIndex), tactileMessage(Finger::kThumb)}},
      diagnostics_(node, private_node) {
  for (const Finger finger : kFingers) {
    publishers_[finger] = node_.advertise<haptex::Tactile>(
        std::string("tactile_emulator/") + base::name(finger) + "/displayed", kDisplayedQueue);
  }
  fault_service_ = node_.advertiseService("tactile_emulator/inject_fault",
                                          &TactileEmulatorNode::injectFault, this);
  step_timer_ = node_.createSteadyTimer(ros::WallDuration(kStepPeriod),
                                        [this](const ros::SteadyTimerEvent&) { step(); });
  diagnostics_.setHardwareID("none");
  diagnostics_.add("contactor emulator", [this](Status& status) { diagnose(status); });
  diagnostics_timer_ = publishOnceASecond(node_, diagnostics_);
  ROS_INFO("The emulated drive electronics are at %s", link_.c_str());
}

void TactileEmulatorNode::step() {
  const Time now = realtime::steadyNow();
  electronics_.advanceTo(now);
  publishDisplayed(now);
}

void TactileEmulatorNode::publishDisplayed(Time now) {
  if (now < displayed_due_) return;
  displayed_due_ = now + tactile::kDrivePeriod;
  bool watched = false;
  for (const ros::Publisher& publisher : publishers_.values) {
    watched = watched || publisher.getNumSubscribers() > 0;
  }
  if (!watched) return;
  const auto amplitudes = electronics_.amplitudes(now);
  for (const Finger finger : kFingers) {
    fillTactile(nullptr, amplitudes[finger], base::seconds(tactile::kDrivePeriod), ros::Time::now(),
                messages_[finger]);
    publishers_[finger].publish(messages_[finger]);
  }
}

bool TactileEmulatorNode::injectFault(haptex::InjectFault::Request& request,
                                      haptex::InjectFault::Response& response) {
  return answer("tactile_emulator/inject_fault", response, [&] {
    const serial::EmulatorFault fault = serial::EmulatorFault::parse(
        request.fault, request.direction, request.probability, request.duration);
    electronics_.inject(fault, realtime::steadyNow());
    return answerTo(fault);
  });
}

void TactileEmulatorNode::diagnose(Status& status) {
  const serial::EmulatedLine& line = electronics_.line();
  const tactile::DriveFirmware& firmware = electronics_.firmware();
  if (!electronics_.soundTrouble().empty()) {
    status.summary(DiagnosticStatus::ERROR, "no sound: " + electronics_.soundTrouble());
  } else if (!line.trouble().empty()) {
    status.summary(DiagnosticStatus::ERROR, "has no port: " + line.trouble());
  } else {
    status.summary(DiagnosticStatus::OK,
                   line.isConnected() ? "has a driver" : "waits for a driver");
  }
  status.add("port", link_);
  status.add("port is open", line.open());
  status.add("commands obeyed", firmware.obeyed());
  status.add("corrupt frames", firmware.received().corrupt_frames);
  status.add("bytes of garbage", firmware.received().garbage_bytes);
  status.add("watchdog trips", electronics_.watchdogTrips());
  status.add("bytes in", line.statistics().bytes_in);
  status.add("bytes out", line.statistics().bytes_out);
  status.add("ports opened", line.statistics().ports);
  status.add("sound", sound_path_);
  if (const tactile::WrittenSound* sound = electronics_.sound()) {
    status.add("samples of sound", sound->samples);
    status.add("samples beyond full scale", sound->clipped);
    status.add("largest displacement (um)", 1e6 * sound->largest);
  }
}

}  // namespace haptex::nodes
