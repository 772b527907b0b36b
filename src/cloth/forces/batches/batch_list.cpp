#include "haptex/cloth/forces/batches/batch_list.h"

namespace haptex::cloth::kernels {

/// Each part goes to the first phase that has none of its particles.
Phases phasesOf(const std::vector<Part>& parts) {
  std::vector<std::vector<Part>> phases;
  for (const Part& part : parts) {
    const auto apart = [&](const Part& other) {
      return part.highest < other.lowest || other.highest < part.lowest;
    };
    const auto phase = std::find_if(phases.begin(), phases.end(), [&](const auto& its) {
      return std::all_of(its.begin(), its.end(), apart);
    });
    if (phase == phases.end()) {
      phases.push_back({part});
    } else {
      phase->push_back(part);
    }
  }
  Phases result;
  for (const std::vector<Part>& phase : phases) {
    result.parts.insert(result.parts.end(), phase.begin(), phase.end());
    result.ends.push_back(static_cast<int>(result.parts.size()));
  }
  return result;
}

}  // namespace haptex::cloth::kernels
