// The diagnostics of DriverNode: the link, the loop, and for each finger why it feels no force.
#include <string>

#include "haptex/exoskeleton/driver/driver_announcement.h"
#include "haptex/nodes/common/diagnostics_timer.h"
#include "haptex/nodes/common/loop_diagnostics.h"
#include "haptex/nodes/exoskeleton_driver/driver_node.h"
#include "haptex/nodes/markers/hand_markers.h"
#include "haptex/realtime/steady_clock.h"

namespace haptex::nodes {
namespace {

using base::kFingers;
using base::Time;
using diagnostic_msgs::DiagnosticStatus;
using exoskeleton::LinkStatus;
using exoskeleton::Mode;
using exoskeleton::NoForceReason;

constexpr Time kRecent = std::chrono::seconds(1);

}  // namespace

void DriverNode::addDiagnostics() {
  diagnostics_.setHardwareID(loop_.port());
  diagnostics_.add("exoskeleton link", [this](Status& status) { diagnoseLink(status); });
  diagnostics_.add("exoskeleton loop", [this](Status& status) { diagnoseLoop(status); });
  for (const Finger finger : kFingers) {
    diagnostics_.add(std::string("exoskeleton force of the ") + name(finger),
                     [this, finger](Status& status) { diagnoseForce(finger, status); });
  }
  for (const Finger finger : kFingers) {
    diagnostics_.add(std::string("exoskeleton place of the ") + name(finger),
                     [this, finger](Status& status) { diagnosePlace(finger, status); });
  }
  diagnostics_.add("exoskeleton weight", [this](Status& status) { hand_watch_.diagnose(status); });
  diagnosed_time_ = realtime::steadyNow();
  diagnostics_timer_ = publishOnceASecond(node_, diagnostics_);
}

std::string DriverNode::whyNoDevice(const exoskeleton::DriverSnapshot& snapshot) const {
  const std::string trouble = loop_.portTrouble();
  if (!trouble.empty()) return trouble;
  return loop_.port() + ": " + describe(snapshot.link);
}

void DriverNode::diagnoseLink(Status& status) {
  const exoskeleton::DriverSnapshot now = loop_.status();
  const Time time = realtime::steadyNow();
  const double elapsed = base::seconds(time - diagnosed_time_);
  const std::uint64_t newly_spoilt =
      spoiltFrames(now.link_statistics) - spoiltFrames(diagnosed_.link_statistics);
  if (now.link != LinkStatus::kConnected) {
    status.summary(DiagnosticStatus::ERROR, "no device: " + whyNoDevice(now));
  } else if (newly_spoilt > 0) {
    status.summaryf(DiagnosticStatus::WARN, "connected, but %lu frames were lost or corrupt lately",
                    static_cast<unsigned long>(newly_spoilt));
  } else {
    status.summary(DiagnosticStatus::OK, "connected");
  }
  status.add("port", loop_.port());
  status.add("link", describe(now.link));
  status.add("serial number of the device", now.identity.serial_number);
  status.add("firmware of the device", now.identity.firmware);
  status.add("states received (1/s)",
             static_cast<double>(now.states - diagnosed_.states) / elapsed);
  addLinkCounts(status, now.link_statistics);
  status.add("times the port was lost", now.ports_lost);
  status.add("frames that the line did not take", now.frames_unsent);
  diagnosed_ = now;
  diagnosed_time_ = time;
}

void DriverNode::diagnoseLoop(Status& status) {
  loop_diagnostics_.diagnose(loop_thread_, status);
  status.add("measurements that nobody took in time", loop_.lostSnapshots());
  const realtime::DurationHistogram::Counts path = loop_.path().counts();
  const auto milliseconds = [](Time time) { return 1e3 * base::seconds(time); };
  status.add("position to force p50 (ms)", milliseconds(path.quantile(0.5)));
  status.add("position to force p99 (ms)", milliseconds(path.quantile(0.99)));
  status.add("position to force p99.9 (ms)", milliseconds(path.quantile(0.999)));
  status.add("position to force largest (ms)", milliseconds(path.largest));
  status.add("states that were answered by a force", path.total());
  status.add("commanders that have died", commander_deaths_.load());
  status.add("auto_recover", auto_recover_ ? "true" : "false");
  status.add("times it was enabled by auto_recover", recoveries_.load());
}

std::string DriverNode::whyNoForce(Finger finger, const exoskeleton::DriverSnapshot& snapshot) {
  const NoForceReason reason = snapshot.fingers[finger].no_force;
  switch (reason) {
    case NoForceReason::kNone:
      return "";
    case NoForceReason::kNoDevice:
      if (snapshot.link == LinkStatus::kConnected) {
        return "the device does not obey: commands do not reach it, or its watchdog has tripped";
      }
      return "no device: " + whyNoDevice(snapshot);
    case NoForceReason::kFault:
      return exoskeleton::announcement(snapshot.operating_state, snapshot.fault.str());
    case NoForceReason::kNoCommand: {
      FingerTopics& topics = fingers_[finger];
      const std::lock_guard<std::mutex> lock(topics.mutex);
      if (topics.has_dropped && realtime::steadyNow() - topics.last_drop_time < kRecent) {
        return std::string("commands on ") + name(finger) +
               "/servo_cf are dropped: " + topics.last_drop;
      }
      return describe(reason);
    }
    default:
      return describe(reason);
  }
}

/// Also where there are no states, or no calibration.
void DriverNode::publishStateMarker(const exoskeleton::DriverSnapshot& snapshot) {
  if (marker_publisher_.getNumSubscribers() == 0) return;
  std::string text = exoskeleton::announcement(snapshot.operating_state, snapshot.fault.str());
  for (const Finger finger : kFingers) {
    const NoForceReason reason = snapshot.fingers[finger].no_force;
    // The state says it of all of them.
    if (reason == NoForceReason::kFault || snapshot.operating_state.mode != Mode::kEnabled)
      continue;
    const std::string why = whyNoForce(finger, snapshot);
    if (!why.empty()) text += std::string("\nno force on the ") + name(finger) + ": " + why;
  }
  marker_publisher_.publish(stateMarker(text, snapshot.operating_state.mode, ros::Time::now()));
}

void DriverNode::diagnoseForce(Finger finger, Status& status) {
  const exoskeleton::DriverSnapshot now = loop_.status();
  const exoskeleton::FingerMeasurement& measured = now.fingers[finger];
  const std::string why = whyNoForce(finger, now);
  const bool trouble =
      measured.no_force == NoForceReason::kNoDevice || measured.no_force == NoForceReason::kFault;
  if (why.empty()) {
    status.summary(DiagnosticStatus::OK, "the commanded force is rendered");
  } else {
    status.summary(trouble ? DiagnosticStatus::ERROR : DiagnosticStatus::OK, "no force: " + why);
  }
  status.add("state", exoskeleton::name(now.operating_state.mode));
  status.add("homed", now.operating_state.is_homed ? "yes" : "no");
  status.add("why there is no force", why.empty() ? "nothing stands in its way" : why);
  status.add("desired force (N)", measured.desired_force.norm());
  status.add("measured force (N)", measured.force.norm());
  const exoskeleton::SafetyStatistics& safety = measured.safety;
  status.add("watchdog trips", safety.watchdog_trips);
  status.add("periods with saturated force", safety.saturated);
  status.add("periods with limited slew", safety.slew_limited);
  status.add("periods in which the passivity controller dissipated", safety.passivity_limited);
  status.add("observed energy (J)", safety.observed_energy);
  status.add("commands or measurements that were not finite", safety.not_finite);
  FingerTopics& topics = fingers_[finger];
  status.add("commands taken", topics.filter.accepted());
  for (const ServoForceFlaw flaw : kServoForceFlaws) {
    status.add(std::string("commands dropped: ") + name(flaw), topics.filter.dropped(flaw));
  }
  const std::lock_guard<std::mutex> lock(topics.mutex);
  status.add("why the last command was dropped", topics.last_drop);
}

void DriverNode::diagnosePlace(Finger finger, Status& status) {
  const exoskeleton::DriverSnapshot now = loop_.status();
  workspace_.diagnose(finger, now.fingers[finger], now.operating_state.is_homed, hand_watch_.hand(),
                      status);
}

}  // namespace haptex::nodes
