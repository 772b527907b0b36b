// What DriverNode does by itself after a stall, if it was asked to.
#include <ros/console.h>

#include <string>

#include "haptex/nodes/exoskeleton_driver/driver_node.h"
#include "haptex/realtime/steady_clock.h"

namespace haptex::nodes {
namespace {

using exoskeleton::RecoveryStep;

const char* name(RecoveryStep step) {
  switch (step) {
    case RecoveryStep::kClearFault:
      return "clear_fault";
    case RecoveryStep::kHome:
      return "home";
    case RecoveryStep::kEnable:
      return "enable";
    case RecoveryStep::kNone:
    case RecoveryStep::kGiveUp:
      break;
  }
  return "";
}

exoskeleton::DriverRequest request(RecoveryStep step) {
  if (step == RecoveryStep::kHome) return exoskeleton::DriverRequest::kHome;
  if (step == RecoveryStep::kEnable) return exoskeleton::DriverRequest::kEnable;
  return exoskeleton::DriverRequest::kClearFault;
}

}  // namespace

void DriverNode::recover(const exoskeleton::DriverSnapshot& snapshot) {
  if (!auto_recover_) return;
  const RecoveryStep step =
      recovery_.next(snapshot.operating_state, snapshot.fault_is_a_stall, realtime::steadyNow());
  if (step == RecoveryStep::kNone) return;
  if (step == RecoveryStep::kGiveUp) {
    ROS_ERROR("auto_recover gives up after %d stalls in a row; from now on a person enables",
              exoskeleton::AutoRecovery::kMaxInARow);
    return;
  }
  const exoskeleton::Refusal refusal = loop_.ask(request(step));
  if (refusal.empty()) {
    if (step == RecoveryStep::kEnable) ++recoveries_;
    ROS_WARN("auto_recover after a stall: exoskeleton/%s", name(step));
  } else {
    ROS_WARN_THROTTLE(1.0, "auto_recover after a stall: exoskeleton/%s refused: %s", name(step),
                      refusal.c_str());
  }
}

}  // namespace haptex::nodes
