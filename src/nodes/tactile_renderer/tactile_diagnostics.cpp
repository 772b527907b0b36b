// The diagnostics of TactileNode: the surface, the steps, and for each finger why its contactors
// are silent.
#include <algorithm>
#include <string>

#include "haptex/nodes/common/diagnostics_timer.h"
#include "haptex/nodes/common/loop_diagnostics.h"
#include "haptex/nodes/tactile_renderer/tactile_node.h"
#include "haptex/realtime/steady_clock.h"
#include "haptex/tactile/drive_waveform.h"

namespace haptex::nodes {
namespace {

using base::kFingers;
using base::Time;
using diagnostic_msgs::DiagnosticStatus;

/// Without a contact for so long they are said to be absent.
constexpr Time kStale = std::chrono::milliseconds(250);

/// Channels that the array does not deliver; empty if it delivers all.
std::string silentChannels(const tactile::ArrayLimits& limits) {
  std::string silent;
  for (const tactile::Channel channel : {tactile::k40, tactile::k320}) {
    if (limits.delivers(channel)) continue;
    if (!silent.empty()) silent += ", ";
    silent += std::to_string(static_cast<int>(tactile::kChannelFrequencies[channel])) + " Hz";
  }
  return silent;
}

template <typename Array>
double largest(const Array& amplitudes) {
  return *std::max_element(amplitudes.begin(), amplitudes.end());
}

}  // namespace

void TactileNode::addDiagnostics() {
  diagnostics_.setHardwareID("none");
  diagnostics_.add("tactile surface", [this](Status& status) { diagnoseSurface(status); });
  diagnostics_.add("tactile steps", [this](Status& status) { diagnoseSteps(status); });
  for (const Finger finger : kFingers) {
    diagnostics_.add(std::string("tactile array of the ") + base::name(finger),
                     [this, finger](Status& status) { diagnoseArray(finger, status); });
  }
  diagnostics_timer_ = publishOnceASecond(node_, diagnostics_);
}

void TactileNode::diagnoseSurface(Status& status) {
  if (choice_.trouble().empty()) {
    status.summary(DiagnosticStatus::OK, "strokes " + choice_.fabric());
  } else {
    status.summary(DiagnosticStatus::WARN, "silent: " + choice_.trouble());
  }
  status.add("fabric", choice_.fabric());
  status.add("file", choice_.path());
  status.add("chosen by", choice_.origin());
  status.add("why there is no surface", choice_.trouble());
  if (choice_.values()) {
    status.add("roughness SMD (um)", 1e6 * choice_.values()->roughness);
    status.add("deviation of friction MMD", choice_.values()->friction_deviation);
  }
  if (choice_.surface()) status.add("waves", choice_.surface()->small_scale.waves.size());
}

void TactileNode::diagnoseSteps(Status& status) {
  const realtime::DurationHistogram::Counts times = computing_times_.counts();
  const std::uint64_t steps = loop_.steps() - diagnosed_steps_;
  const std::string silent = silentChannels(loop_.limits());
  if (steps == 0) {
    status.summary(DiagnosticStatus::WARN, "no step lately");
  } else if (!silent.empty()) {
    status.summary(DiagnosticStatus::WARN, "the limits of the array silence " + silent);
  } else {
    status.summary(DiagnosticStatus::OK, "steps");
  }
  status.add("steps", loop_.steps());
  status.add("steps lately", steps);
  status.add("steps of a finger that were computed", loop_.computed());
  addQuantiles(status, "computing time", "of the last second", times.since(diagnosed_times_));
  addQuantiles(status, "computing time", "since the start", times);
  status.add("lowest frequency (Hz)", loop_.limits().lowest_frequency);
  status.add("highest frequency (Hz)", loop_.limits().highest_frequency);
  status.add("largest displacement (um)", 1e6 * loop_.limits().largest_displacement);
  status.add("silent channels", silent);
  status.add("driver of the contactors", array_message_);
  diagnosed_steps_ = loop_.steps();
  diagnosed_times_ = times;
}

void TactileNode::diagnoseArray(Finger finger, Status& status) {
  const TactileInputStatus& input = loop_.input(finger);
  const haptex::Tactile& message = loop_.messages()[finger];
  const Time now = realtime::steadyNow();
  if (!input.last_arrival || now - *input.last_arrival > kStale) {
    status.summary(DiagnosticStatus::WARN,
                   "silent: no contacts arrive, is force_renderer running?");
  } else if (input.dropped > diagnosed_drops_[finger]) {
    status.summary(DiagnosticStatus::WARN, "dropped a contact: " + input.dropped_why);
  } else {
    status.summary(DiagnosticStatus::OK, loop_.touching(finger) ? "touches" : "does not touch");
  }
  status.add("largest amplitude of 40 Hz (um)", largest(message.amplitudes_40));
  status.add("largest amplitude of 320 Hz (um)", largest(message.amplitudes_320));
  status.add("age of the last contact (ms)",
             input.last_arrival ? std::to_string(1e3 * base::seconds(now - *input.last_arrival))
                                : std::string("never"));
  status.add("contacts taken", input.taken);
  status.add("contacts dropped", input.dropped);
  status.add("why the last contact was dropped", input.dropped_why);
  diagnosed_drops_[finger] = input.dropped;
}

}  // namespace haptex::nodes
