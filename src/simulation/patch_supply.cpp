#include "haptex/simulation/patch_supply.h"

namespace haptex::simulation {

bool PatchSupply::ask(const contact::Fingertips& fingertips, double seconds, const Search& search) {
  selection_.begin();
  for (const std::optional<contact::Fingertip>& fingertip : fingertips.values) {
    if (!fingertip) continue;
    if (!search(contact::searchVolume(*fingertip, seconds, settings_), selection_)) return false;
  }
  if (selection_.finish()) outdated_ = true;
  return true;
}

void PatchSupply::setAttached(const std::vector<char>& attached) {
  if (attached == attached_) return;
  attached_ = attached;
  if (!triangles().empty()) outdated_ = true;
}

std::unique_ptr<contact::Patch> PatchSupply::prepare(const contact::HapticLayer& layer) {
  outdated_ = false;
  return layer.preparePatch(triangles(), attached_);
}

}  // namespace haptex::simulation
