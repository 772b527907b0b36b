// The diagnostics of ForceRendererNode: the loop, what forces are computed from, and for each
// finger why it feels no force.
#include <string>

#include "haptex/nodes/common/diagnostics_timer.h"
#include "haptex/nodes/force_renderer/force_renderer_node.h"
#include "haptex/realtime/steady_clock.h"

namespace haptex::nodes {
namespace {

using base::Finger;
using base::kFingers;
using base::Time;
using diagnostic_msgs::DiagnosticStatus;

std::string ageText(const std::optional<Time>& last, Time now) {
  return last ? std::to_string(1e3 * base::seconds(now - *last)) : "never";
}

}  // namespace

/// Empty if nothing stands in its way.
std::string ForceRendererNode::whyNoForce(Finger finger, const simulation::RendererNews& news,
                                          Time now) const {
  return touches_[finger] ? simulation::whySilent(finger, news, now) : "";
}

/// Which sources of any finger are silent; empty if none is.
std::string ForceRendererNode::whyAnyNoForce(const simulation::RendererNews& news, Time now) const {
  const std::string index = whyNoForce(Finger::kIndex, news, now);
  const std::string thumb = whyNoForce(Finger::kThumb, news, now);
  if (index == thumb) return index;
  if (index.empty()) return "thumb: " + thumb;
  if (thumb.empty()) return "index: " + index;
  return "index: " + index + "; thumb: " + thumb;
}

void ForceRendererNode::addDiagnostics() {
  diagnostics_.setHardwareID("none");
  diagnostics_.add("force loop", [this](Status& status) { diagnoseLoop(status); });
  diagnostics_.add("force sources", [this](Status& status) { diagnoseSources(status); });
  for (const Finger finger : kFingers) {
    diagnostics_.add(std::string("contact force of the ") + base::name(finger),
                     [this, finger](Status& status) { diagnoseForce(finger, status); });
  }
  diagnostics_timer_ = publishOnceASecond(node_, diagnostics_);
}

void ForceRendererNode::diagnoseLoop(Status& status) {
  loop_diagnostics_.diagnose(loop_thread_, status);
  const simulation::ForceLoopStatus now = loop_.status();
  const realtime::DurationHistogram::Counts durations = tick_durations_.counts();
  addQuantiles(status, "computing time", "of the last second",
               durations.since(diagnosed_durations_));
  addQuantiles(status, "computing time", "since the start", durations);
  status.add("particles of the patch", now.patch_particles);
  status.add("patches exchanged", now.patches);
  status.add("steps rejected, not finite", now.rejected_steps);
  diagnosed_durations_ = durations;
}

void ForceRendererNode::diagnoseSources(Status& status) {
  const Time time = realtime::steadyNow();
  const simulation::ForceLoopStatus now = loop_.status();
  const PatchSupplierStatus supplier = supplier_.status();
  const std::string why = whyAnyNoForce(now.news, time);
  if (!supplier.trouble.empty()) {
    status.summary(DiagnosticStatus::ERROR, "no force: " + supplier.trouble);
  } else if (!why.empty()) {
    status.summary(DiagnosticStatus::ERROR, "no force: " + why);
  } else {
    status.summary(DiagnosticStatus::OK, "all live");
  }
  status.add("why there is no layer", supplier.trouble);
  status.add("age of cloth/heartbeat (ms)", ageText(now.news.heartbeat, time));
  status.add("age of cloth/state (ms)", ageText(now.news.cloth_state, time));
  status.add("age of the transform of hand_base (ms)", ageText(now.news.hand_base, time));
  for (const simulation::RendererSource source : simulation::kRendererSources) {
    status.add(std::string("times gone silent: ") + name(source),
               now.silences[static_cast<std::size_t>(source)]);
  }
  status.add("states of the cloth taken", now.states);
  status.add("states of another size", now.other_sizes);
  status.add("triangles of the patch", supplier.triangles);
  status.add("queries answered", supplier.queries);
  status.add("queries failed", supplier.failures);
  status.add("why the last query failed", supplier.query_trouble);
  status.add("time of the last query (ms)", 1e3 * supplier.query_seconds);
  const std::lock_guard<std::mutex> lock(mutex_);
  status.add("states dropped", dropped_states_);
  status.add("why the last state was dropped", last_dropped_state_);
}

void ForceRendererNode::diagnoseForce(Finger finger, Status& status) {
  const simulation::ForceLoopStatus now = loop_.status();
  const simulation::ForceLoopStatus::OfFinger& of_finger = now.fingers[finger];
  const std::string why = whyNoForce(finger, now.news, realtime::steadyNow());
  if (!touches_[finger]) {
    status.summary(DiagnosticStatus::OK, "does not touch, by the parameter fingers");
  } else if (!why.empty()) {
    status.summary(DiagnosticStatus::ERROR, "no force: " + why);
  } else if (of_finger.gain < 1.0) {
    status.summary(DiagnosticStatus::OK, "the force rises");
  } else {
    status.summary(DiagnosticStatus::OK, of_finger.touching ? "touches" : "does not touch");
  }
  const FingerTopics& topics = fingers_[finger];
  status.add("why there is no force", why.empty() ? "nothing stands in its way" : why);
  status.add("share of the force that is rendered", of_finger.gain);
  status.add("force (N)", of_finger.force);
  status.add("normal force (N)", of_finger.normal_force);
  status.add("poses taken", topics.poses.load(std::memory_order_relaxed));
  status.add("poses and velocities dropped", topics.filter.dropped());
  status.add("why the last one was dropped", topics.filter.lastDrop());
}

}  // namespace haptex::nodes
