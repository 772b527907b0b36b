// The samples and fingertips of the oracles of contact.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "haptex/contact/patch.h"
#include "haptex/kes/virtual_test.h"
#include "haptex/oracles/experiments/haptic_loop.h"

namespace haptex::oracles {

using contact::Fingertips;

constexpr double kSampleSide = 0.2;  ///< m

constexpr int kSampleCells = 32;  ///< along each side

/// The 200 mm sample in the plane x = 0, hanging from the bar at the world's origin with the given
/// direction of the fabric along +z. Patches of refinement 2.
HapticLoopSettings hangingSample(const material::Fabric& fabric, kes::Direction up,
                                 double large_scale_rate, int cells = kSampleCells);
/// The same sample held at all four sides, 1 + `strain` times as wide and as high, without gravity;
/// its middle is at (0, 0, -0.1 m).
HapticLoopSettings tautSample(const material::Fabric& fabric, double strain,
                              double large_scale_rate);
/// Layers of tautSample() without strain, which collide with each other and touch, each turned by
/// 0.3 rad against the one before; their stack has its middle at (0, 0, -0.1 m), its first layer at
/// the +x side. Patches have as many elements per layer.
HapticLoopSettings tautLayers(const material::Fabric& fabric, int layers, double large_scale_rate);
/// kg times gravity (N).
double weight(const HapticLoopSettings& sample);

/// Fingertips that meet face to face along x, the index finger on the +x side.
struct Hand {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();    ///< m, between the two
  double gap = 0.0;                                    ///< m, between the spheres; negative: deep
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
  double opening = 0.0;                                ///< m/s, of the gap
  double index_radius = kIndexRadius;                  ///< m
  double thumb_radius = kThumbRadius;                  ///< m

  Fingertips fingertips() const;
};

/// Moves the hand evenly by `displacement` while it opens by `opening` (m), in whole steps of h,
/// and stops it there: after_step(fingertips) at every step.
void move(Hand& hand, const Eigen::Vector3d& displacement, double opening, double seconds, double h,
          const std::function<void(const Fingertips&)>& step);

/// The force on both fingertips together (N).
Eigen::Vector3d forceOnFingertips(const contact::HapticLayer& layer);

/// The whole cloth with the resolution of a patch, in contact with the fingertips: what the two
/// layers are to agree with. Large steps of backward Euler go to static equilibrium.
class RefinedCloth {
 public:
  /// @param sample whose attached particles stay where they are
  explicit RefinedCloth(const HapticLoopSettings& sample);

  /// @param h s
  /// @throws std::runtime_error if the step cannot be solved
  void step(const Fingertips& fingertips, double h);
  /// The cloth's force on a fingertip (N).
  Eigen::Vector3d force(base::Finger finger) const;
  /// Centre of a fingertip's pressure in (weft, warp) (m); zero without contact.
  Eigen::Vector2d fabricPosition(base::Finger finger) const;

 private:
  std::vector<material::Fabric> fabrics_;
  std::vector<contact::ContactLaw> laws_;
  contact::LargeScaleMotion motion_;
  std::unique_ptr<contact::Patch> patch_;
};

/// Fabric on a horizontal plate, under one finger.
struct TableSettings {
  material::Fabric fabric;
  double side = 0.1;            ///< m, of the square sheet
  int cells = 32;               ///< along each side
  int refinement = 2;           ///< of its patches
  double plate_friction = 0.2;  ///< of the fabric on the plate
};

/// The sheet lies where cloth rests on the plate, in the plane z = 0 with its middle in the origin,
/// weft along y and warp along -x. Nothing holds it. The patches have all elements that a fingertip
/// of 10 mm touches.
HapticLoopSettings sheetOnPlate(const TableSettings& settings);

/// The index finger comes straight down on the middle of the sheet, from the touch to a height
/// within `seconds`, and rests for 0.3 s.
/// @param height m, of its centre above the plane z = 0
/// @return the fingertip, for further steps of the loop
contact::Fingertip press(HapticLoop& loop, double height, double seconds);

/// Presses until the finger is `depth` (m) in fabric and pulp, and drags the sheet over the plate
/// by 8 mm.
/// @param velocity m/s, along the plate
/// @return over the second half of the way the mean drag, over the mean of what presses on the
///   plate, the finger and the sheet's weight
double frictionOfDrag(const TableSettings& settings, double depth, const Eigen::Vector3d& velocity);

/// N, that the cloth's layer has the index finger feel.
Eigen::Vector3d feltByIndex(const HapticLoop& loop);

}  // namespace haptex::oracles
