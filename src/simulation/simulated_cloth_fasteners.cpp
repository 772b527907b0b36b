// What opens and closes the fasteners of a SimulatedCloth.
#include <algorithm>
#include <numeric>

#include "haptex/base/quoted.h"
#include "haptex/base/require.h"
#include "haptex/simulation/simulated_cloth.h"

namespace haptex::simulation {

using base::refuse;

/// At the start.
void SimulatedCloth::requireFastened() {
  readFastened();
  opened_.reserve(fastened_.size());
  for (std::size_t f = 0; f < fastened_.size(); ++f) {
    if (isFastened(f)) cloth_.fasteners()->requireWithinReach(f, state_.positions);
  }
}

/// From the state, which begins anew.
void SimulatedCloth::readFastened() {
  const cloth::Fasteners* fasteners = cloth_.fasteners();
  if (fasteners == nullptr) return;
  fastened_.resize(fasteners->all().size());
  for (std::size_t f = 0; f < fastened_.size(); ++f) {
    fastened_[f] = cloth::Fasteners::isFastened(f, state_.memory.data());
  }
}

/// After an accepted step.
void SimulatedCloth::noteOpenedFasteners() {
  for (std::size_t f = 0; f < fastened_.size(); ++f) {
    if (!isFastened(f) || cloth::Fasteners::isFastened(f, state_.memory.data())) continue;
    fastened_[f] = 0;
    opened_.push_back({f, cloth::Fasteners::openedAt(f, state_.memory.data())});
  }
}

std::vector<std::size_t> SimulatedCloth::requireFasteners(
    const std::vector<std::string>& names) const {
  const cloth::Fasteners* fasteners = cloth_.fasteners();
  if (fasteners == nullptr) refuse("the scene has no fasteners: allowed is a scene with some");
  const std::vector<cloth::Fastener>& all = fasteners->all();
  std::vector<std::size_t> chosen(names.empty() ? all.size() : 0);
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  std::string known;
  for (const cloth::Fastener& one : all) known += (known.empty() ? "" : ", ") + one.name;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto found = std::find_if(
        all.begin(), all.end(), [&](const cloth::Fastener& one) { return one.name == names[i]; });
    if (found == all.end()) {
      refuse("names[", i, "] = ", base::quoted(names[i]), " is no fastener: allowed are ",
             base::shortened(known));
    }
    chosen.push_back(static_cast<std::size_t>(found - all.begin()));
  }
  return chosen;
}

void SimulatedCloth::fasten(const std::vector<std::string>& names) {
  const std::vector<std::size_t> chosen = requireFasteners(names);
  for (const std::size_t fastener : chosen) {
    if (!isFastened(fastener)) cloth_.fasteners()->requireWithinReach(fastener, state_.positions);
  }
  for (const std::size_t fastener : chosen) setFastened(fastener, true);
}

void SimulatedCloth::unfasten(const std::vector<std::string>& names) {
  for (const std::size_t fastener : requireFasteners(names)) setFastened(fastener, false);
}

void SimulatedCloth::setFastened(std::size_t fastener, bool fastened) {
  if (isFastened(fastener) == fastened) return;
  fastened_[fastener] = fastened ? 1 : 0;
  cloth::Fasteners::set(fastener, fastened, state_.memory.data());
  wake();
}

double SimulatedCloth::fastenerForce(std::size_t fastener) const {
  return isFastened(fastener) ? cloth_.fasteners()->tension(fastener, state_.positions) : 0.0;
}

}  // namespace haptex::simulation
