// The large-scale cloth and the small-scale layer together, in simulated time, without clocks.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "haptex/contact/haptic_layer.h"
#include "haptex/proximity/kdop_hierarchy.h"
#include "haptex/simulation/force_loop.h"
#include "haptex/simulation/newest_loads.h"
#include "haptex/simulation/patch_supply.h"
#include "haptex/simulation/simulated_cloth.h"

namespace haptex::oracles {

// Of the emulated device's fingertips, as the URDF has them.
constexpr double kIndexRadius = 7.5e-3;  ///< m
constexpr double kThumbRadius = 9e-3;    ///< m

struct HapticLoopSettings {
  mesh::ClothMesh mesh;
  material::Fabric fabric;
  std::vector<material::Fabric> region_fabrics;  ///< fabrics 1, 2, ... of the mesh
  cloth::ModelledEffects effects;
  std::vector<int> attached_particles;
  std::vector<mesh::Obstacle> obstacles;  ///< that the cloth collides with if effects has contacts
  double large_scale_step = 0.0125;       ///< s
  cloth::StepSettings step;
  contact::HapticSettings haptics;
  base::PerFinger<double> radii{{kIndexRadius, kThumbRadius}};  ///< m
};

/// Drives what the nodes cloth_simulation, proximity and force_renderer run, SimulatedCloth,
/// PatchSupply and ForceLoop, one millisecond at a time and the same in every run. Messages and the
/// cloth's steps take no time: when a step begins, the force loop takes its state in the same tick,
/// and the patch that the state asks for in the next one.
class HapticLoop {
 public:
  /// The force loop has run for long enough to render all of its forces.
  explicit HapticLoop(HapticLoopSettings settings);

  /// A fingertip that is absent is far away.
  /// @throws std::invalid_argument if the radius of a fingertip is not that of the settings
  void step(const contact::Fingertips& fingertips);
  /// The same for `seconds`.
  void rest(const contact::Fingertips& fingertips, double seconds);

  const contact::HapticLayer& layer() const { return *force_loop_.layer(); }
  /// What is rendered, with its share of the force (ForceLoop::rendered()).
  const simulation::ForceLoop& forceLoop() const { return force_loop_; }
  const simulation::SimulatedCloth& cloth() const { return cloth_; }
  const cloth::ClothState& state() const { return cloth_.state(); }
  double time() const { return ticks_ * settings_.haptics.time_step; }  ///< s
  /// Lets go of all particles that are attached.
  void releaseAll();
  /// What the attachments hold (N): minus the sum of the forces on the attached particles.
  Eigen::Vector3d attachmentForce() const;
  int patchChanges() const;   ///< in the force loop
  int rejectedSteps() const;  ///< of both layers

 private:
  base::Time now() const;
  void offerLayer();
  void tick(const contact::Fingertips& fingertips);
  void sendFingertip(base::Finger finger, const std::optional<contact::Fingertip>& fingertip);
  void stepCloth();
  void sendState();
  void sendLoads();
  void supplyPatch();

  HapticLoopSettings settings_;
  simulation::SimulatedCloth cloth_;
  proximity::KdopHierarchy hierarchy_;
  simulation::ForceLoop force_loop_;
  simulation::PatchSupply supply_;
  simulation::LargeScaleState sent_;
  simulation::NewestLoads loads_;  // that the force loop has sent
  std::vector<proximity::NearElement> near_;
  long ticks_ = 0;
  long cloth_steps_ = 0;        // begun
  std::uint64_t loadings_ = 0;  // that loads_ have come of
  int rejected_steps_ = 0;      // of the cloth
};

}  // namespace haptex::oracles
