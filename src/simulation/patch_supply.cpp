#include "haptex/simulation/patch_supply.h"

#include <algorithm>

namespace haptex::simulation {

bool PatchSupply::ask(const LoopView& view, const Search& search) {
  selection_.begin();
  for (const cloth::PointLoad& load : view.loads) selection_.keep(load.triangle);
  for (const std::optional<contact::Fingertip>& fingertip : view.fingertips.values) {
    if (!fingertip) continue;
    const contact::SearchVolume volume =
        contact::searchVolume(*fingertip, view.state_period, settings_);
    if (!search(volume, selection_)) return false;
  }
  if (selection_.finish()) outdated_ = true;
  const bool was_wide = isWide();
  rounds_of_pinch_ = view.is_pinched ? kRests : std::max(0, rounds_of_pinch_ - 1);
  if (isWide() != was_wide) outdated_ = true;
  return true;
}

void PatchSupply::setAttached(const std::vector<char>& attached) {
  if (attached == attached_) return;
  attached_ = attached;
  if (!triangles().empty()) outdated_ = true;
}

std::unique_ptr<contact::Patch> PatchSupply::prepare(const contact::HapticLayer& layer) {
  outdated_ = false;
  widen(layer);
  return layer.preparePatch(triangles(), attached_, wide_);
}

bool PatchSupply::isWide() const {
  return rounds_of_pinch_ > 0 && settings_.surround > 0.0 &&
         std::any_of(attached_.begin(), attached_.end(), [](char held) { return held != 0; });
}

void PatchSupply::widen(const contact::HapticLayer& layer) {
  if (!isWide()) {
    wide_.clear();
    return;
  }
  const auto all_within = [this, &layer](double reach) {
    std::vector<int> all = layer.elementsAround(triangles(), reach);
    all.insert(all.end(), triangles().begin(), triangles().end());
    std::sort(all.begin(), all.end());
    return all;
  };
  const std::vector<int> least = all_within(0.5 * settings_.surround);
  if (std::includes(wide_.begin(), wide_.end(), least.begin(), least.end())) return;
  wide_ = all_within(settings_.surround);
}

}  // namespace haptex::simulation
