// Which patch the small-scale layer is to have: asked for around the fingertips, prepared when the
// answer has changed.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "haptex/contact/haptic_layer.h"
#include "haptex/contact/patch_selection.h"
#include "haptex/simulation/force_loop.h"

namespace haptex::simulation {

/// One thread.
class PatchSupply {
 public:
  static constexpr int kRests = contact::PatchSelection::kRests;

  /// @param triangles of the large-scale mesh
  PatchSupply(const contact::HapticSettings& settings, std::size_t triangles)
      : settings_(settings), selection_(triangles) {}

  /// Adds what is near a volume to the selection. @returns false if that is not known
  using Search = std::function<bool(const contact::SearchVolume&, contact::PatchSelection&)>;
  /// A round about both fingertips. One whose search fails changes nothing. From a pinch on, until
  /// kRests rounds without one, the patch goes on around the fingertips, as far as it went before
  /// while that is half as far as it may be: what leaves a patch that is carried is felt. Not so
  /// where nothing is attached: the large-scale cloth would take seconds to where the patch hangs.
  /// @param view of the force loop: where the fingertips are, what they touch, whether they pinch
  ///   it, and the period for which they are predicted
  /// @returns whether every search was answered
  bool ask(const LoopView& view, const Search& search);

  /// Which particles of the large-scale mesh are attached, nonzero where they are.
  void setAttached(const std::vector<char>& attached);

  /// Whether prepare() would make another patch than the last time.
  bool isOutdated() const { return outdated_; }
  /// @param layer of the same mesh. @returns null where there is nothing near or free
  /// @throws std::invalid_argument as HapticLayer::preparePatch()
  std::unique_ptr<contact::Patch> prepare(const contact::HapticLayer& layer);

  /// Of the large-scale mesh, ascending.
  const std::vector<int>& triangles() const { return selection_.elements(); }
  std::size_t attachedSize() const { return attached_.size(); }

 private:
  bool isWide() const;
  void widen(const contact::HapticLayer& layer);

  contact::HapticSettings settings_;
  contact::PatchSelection selection_;
  std::vector<char> attached_;
  int rounds_of_pinch_ = 0;  // that are left
  std::vector<int> wide_;    // all of the patch of a pinch, ascending
  bool outdated_ = false;
};

}  // namespace haptex::simulation
