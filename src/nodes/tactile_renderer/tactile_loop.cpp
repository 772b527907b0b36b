#include "haptex/nodes/tactile_renderer/tactile_loop.h"

#include "haptex/nodes/tactile_renderer/tactile_messages.h"
#include "haptex/tactile/drive_waveform.h"

namespace haptex::nodes {
namespace {

using base::kFingers;

const tactile::ArrayLimits& sound(const tactile::ArrayLimits& limits) {
  tactile::requireSound(limits);
  return limits;
}

}  // namespace

TactileLoop::TactileLoop(const tactile::ArrayLimits& limits)
    : limits_(sound(limits)),
      messages_{{tactileMessage(Finger::kIndex), tactileMessage(Finger::kThumb)}} {}

void TactileLoop::step(const base::PerFinger<const tactile::Surface*>& surfaces, Time now,
                       const ros::Time& stamp) {
  const double step_time = last_step_ ? base::seconds(now - *last_step_) : tactile::kTactileStep;
  for (const Finger finger : kFingers) step(finger, surfaces[finger], step_time, stamp);
  last_step_ = now;
  ++steps_;
}

void TactileLoop::step(Finger finger, const tactile::Surface* surface, double step_time,
                       const ros::Time& stamp) {
  const auto touched = inputs_[finger].endStep();
  tactile::ArrayAmplitudes amplitudes{};
  if (touched && surface) {
    amplitudes = tactile::arrayAmplitudes(*surface, *touched, limits_);
    ++computed_;
  }
  touching_[finger] = touched.has_value();
  fillTactile(touched ? &*touched : nullptr, amplitudes, step_time, stamp, messages_[finger]);
}

}  // namespace haptex::nodes
