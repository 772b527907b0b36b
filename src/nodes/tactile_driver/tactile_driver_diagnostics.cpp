// The diagnostics of TactileDriverNode: the link, and for each finger why its contactors rest.
#include <algorithm>
#include <string>

#include "haptex/nodes/common/diagnostics_timer.h"
#include "haptex/nodes/common/loop_diagnostics.h"
#include "haptex/nodes/tactile_driver/tactile_driver_node.h"
#include "haptex/realtime/steady_clock.h"

namespace haptex::nodes {
namespace {

using base::kFingers;
using diagnostic_msgs::DiagnosticStatus;

double largest(const tactile::ArrayAmplitudes& amplitudes, tactile::Channel channel) {
  double most = 0.0;
  for (const auto& contactor : amplitudes) most = std::max(most, contactor[channel]);
  return most;
}

}  // namespace

void TactileDriverNode::addDiagnostics() {
  diagnostics_.setHardwareID(driver_.port());
  diagnostics_.add("contactor link", [this](Status& status) { diagnoseLink(status); });
  for (const Finger finger : kFingers) {
    diagnostics_.add(std::string("contactors of the ") + base::name(finger),
                     [this, finger](Status& status) { diagnoseArray(finger, status); });
  }
  diagnostics_timer_ = publishOnceASecond(node_, diagnostics_);
}

void TactileDriverNode::diagnoseLink(Status& status) {
  const tactile::DriverStatus& now = driver_.status();
  const std::string why = whyNoElectronics();
  const std::uint64_t newly_spoilt =
      spoiltFrames(now.link_statistics) - spoiltFrames(diagnosed_.link_statistics);
  if (!why.empty()) {
    status.summary(DiagnosticStatus::ERROR, "no electronics: " + why);
  } else if (newly_spoilt > 0) {
    status.summaryf(DiagnosticStatus::WARN, "connected, but %lu frames were lost or corrupt lately",
                    static_cast<unsigned long>(newly_spoilt));
  } else if (now.watchdog_trips > diagnosed_.watchdog_trips) {
    status.summary(DiagnosticStatus::WARN, "connected, but commands came too late lately");
  } else {
    status.summary(DiagnosticStatus::OK, "connected");
  }
  status.add("port", driver_.port());
  status.add("link", serial::describe(now.link));
  status.add("serial number of the electronics", now.identity.serial_number);
  status.add("firmware of the electronics", now.identity.firmware);
  status.add("commands sent", now.commands);
  addLinkCounts(status, now.link_statistics);
  status.add("times the port was lost", now.ports_lost);
  status.add("frames that the line did not take", now.frames_unsent);
  status.add("watchdog trips of the electronics", now.watchdog_trips);
  status.add("sources that have died", source_deaths_);
  diagnosed_ = now;
}

void TactileDriverNode::diagnoseArray(Finger finger, Status& status) {
  const base::Time now = realtime::steadyNow();
  const InputStatus input = inputs_[finger].status();
  if (input.refused > diagnosed_refusals_[finger]) {
    status.summary(DiagnosticStatus::WARN, "refused amplitudes: " + input.refused_why);
  } else if (!driver_.isDriven(finger, now)) {
    status.summary(DiagnosticStatus::WARN,
                   "rest: no amplitudes arrive, is tactile_renderer running?");
  } else {
    status.summary(DiagnosticStatus::OK, "driven");
  }
  const tactile::ArrayAmplitudes amplitudes = driver_.amplitudes(finger, now);
  status.add("largest amplitude of 40 Hz (um)", 1e6 * largest(amplitudes, tactile::k40));
  status.add("largest amplitude of 320 Hz (um)", 1e6 * largest(amplitudes, tactile::k320));
  status.add("amplitudes taken", input.taken);
  status.add("amplitudes refused", input.refused);
  status.add("why the last amplitudes were refused", input.refused_why);
  diagnosed_refusals_[finger] = input.refused;
}

}  // namespace haptex::nodes
