// The services of DriverNode. Each answers what was done or why not.
#include <ros/console.h>

#include <stdexcept>
#include <string>

#include "haptex/nodes/common/node_process.h"
#include "haptex/nodes/exoskeleton_driver/driver_node.h"
#include "haptex/realtime/steady_clock.h"

namespace haptex::nodes {
namespace {

using base::Time;
using exoskeleton::Mode;
using exoskeleton::Refusal;

constexpr Time kHomingPatience = std::chrono::seconds(12);
const ros::WallDuration kHomingLook(0.02);  // between two looks whether it is done

bool answer(const char* service, const Refusal& refusal, const std::string& done,
            std_srvs::Trigger::Response& response) {
  response.success = refusal.empty();
  response.message = response.success ? done : refusal;
  if (!response.success) ROS_WARN("%s refused: %s", service, refusal.c_str());
  return true;
}

/// Waits for the end of homing. @returns why it failed; empty if the device is homed
Refusal awaitHomed(const exoskeleton::DriverLoop& loop) {
  const Time end = realtime::steadyNow() + kHomingPatience;
  exoskeleton::DriverSnapshot now = loop.status();
  while (now.operating_state.is_busy) {
    if (isEnding()) return "the driver ends";
    if (realtime::steadyNow() > end) {
      return "homing still goes on after 12 s; exoskeleton/operating_state tells when it is done";
    }
    kHomingLook.sleep();
    now = loop.status();
  }
  if (now.operating_state.is_homed) return "";
  if (now.operating_state.mode == Mode::kFault) return "homing failed: " + now.fault.str();
  return "homing was ended by another request";
}

}  // namespace

void DriverNode::advertiseServices() {
  services_ = {node_.advertiseService("exoskeleton/enable", &DriverNode::enable, this),
               node_.advertiseService("exoskeleton/disable", &DriverNode::disable, this),
               node_.advertiseService("exoskeleton/pause", &DriverNode::pause, this),
               node_.advertiseService("exoskeleton/home", &DriverNode::home, this),
               node_.advertiseService("exoskeleton/clear_fault", &DriverNode::clearFault, this)};
}

bool DriverNode::enable(Trigger::Request& /*request*/, Trigger::Response& response) {
  return answer("enable", loop_.ask(exoskeleton::DriverRequest::kEnable),
                "enabled: commanded forces are rendered", response);
}

bool DriverNode::disable(Trigger::Request& /*request*/, Trigger::Response& response) {
  return answer("disable", loop_.ask(exoskeleton::DriverRequest::kDisable),
                "disabled: the motors are off", response);
}

bool DriverNode::pause(Trigger::Request& /*request*/, Trigger::Response& response) {
  return answer("pause", loop_.ask(exoskeleton::DriverRequest::kPause),
                "paused: no force is rendered until enable", response);
}

bool DriverNode::home(Trigger::Request& /*request*/, Trigger::Response& response) {
  Refusal refusal = loop_.ask(exoskeleton::DriverRequest::kHome);
  if (refusal.empty()) refusal = awaitHomed(loop_);
  return answer("home", refusal, "homed: the encoders are calibrated", response);
}

bool DriverNode::clearFault(Trigger::Request& /*request*/, Trigger::Response& response) {
  return answer("clear_fault", loop_.ask(exoskeleton::DriverRequest::kClearFault),
                "the fault is cleared: the exoskeleton is disabled", response);
}

}  // namespace haptex::nodes
