#include "haptex/nodes/tactile_renderer/tactile_input.h"

#include <stdexcept>

#include "haptex/nodes/tactile_renderer/tactile_messages.h"

namespace haptex::nodes {

void TactileInput::receive(const haptex::Contact& message, base::Time arrival) {
  try {
    const auto touched = touchedFabric(message);
    if (touched) {
      add(*touched);
      fabric_ = message.fabric;
    }
    ++messages_;
    ++status_.taken;
    status_.last_arrival = arrival;
  } catch (const std::invalid_argument& error) {
    ++status_.dropped;
    status_.dropped_why = error.what();
  }
}

void TactileInput::add(const tactile::TouchedFabric& touched) {
  ++touching_;
  sum_.stroke.velocity += touched.stroke.velocity;
  sum_.stroke.normal_force += touched.stroke.normal_force;
  sum_.placement = touched.placement;
  for (int i = 0; i < tactile::kContactors; ++i) sum_.forces[i] += touched.forces[i];
}

std::optional<tactile::TouchedFabric> TactileInput::endStep() {
  std::optional<tactile::TouchedFabric> mean;
  if (touching_ > 0) {
    mean = sum_;
    mean->stroke.velocity /= touching_;
    mean->stroke.normal_force /= messages_;
    for (double& force : mean->forces) force /= messages_;
  }
  messages_ = 0;
  touching_ = 0;
  sum_ = {};
  return mean;
}

}  // namespace haptex::nodes
