// The large-scale cloth and the small-scale layer together, in simulated time, without clocks.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/contact/haptic_layer.h"
#include "haptex/proximity/kdop_hierarchy.h"
#include "haptex/simulation/patch_supply.h"

namespace haptex::oracles {

struct HapticLoopSettings {
  mesh::ClothMesh mesh;
  material::Fabric fabric;
  cloth::ModelledEffects effects;
  std::vector<int> attached_particles;
  double large_scale_step = 0.0125;  ///< s, a whole multiple of haptics.time_step
  cloth::StepSettings step;
  contact::HapticSettings haptics;
};

/// What the nodes cloth_simulation, proximity and force_renderer do together, one millisecond at a
/// time and the same in every run. The large-scale cloth steps with the loads of the last
/// millisecond; its new state is queried and received at once.
class HapticLoop {
 public:
  explicit HapticLoop(HapticLoopSettings settings);

  void step(const contact::Fingertips& fingertips);
  /// The same for `seconds`.
  void rest(const contact::Fingertips& fingertips, double seconds);

  contact::HapticLayer& layer() { return layer_; }
  const contact::HapticLayer& layer() const { return layer_; }
  cloth::Cloth& cloth() { return cloth_; }
  const cloth::ClothState& state() const { return state_; }
  double time() const { return ticks_ * settings_.haptics.time_step; }  ///< s
  /// What the attachments hold (N): minus the sum of the forces on the attached particles.
  Eigen::Vector3d attachmentForce() const;
  int patchChanges() const { return patch_changes_; }
  int rejectedSteps() const { return rejected_steps_; }  ///< of both layers

 private:
  void stepCloth();
  void choosePatch(const contact::Fingertips& fingertips);

  HapticLoopSettings settings_;
  cloth::Cloth cloth_;
  cloth::ClothState state_;
  cloth::Integrator integrator_;
  proximity::KdopHierarchy hierarchy_;
  contact::HapticLayer layer_;
  simulation::PatchSupply supply_;
  std::vector<proximity::NearElement> near_;
  long ticks_ = 0;
  int ticks_per_step_;
  int patch_changes_ = 0;
  int rejected_steps_ = 0;
};

}  // namespace haptex::oracles
