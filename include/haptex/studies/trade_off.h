// Motions of a cloth on which speed is weighed against accuracy, followed with chosen settings.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/step.h"
#include "haptex/material/fabric.h"

namespace haptex::studies {

/// All with a square sample of kSampleSize, gravity, the fabric's viscosity and bending.
enum class Motion {
  kHang,     ///< hangs from its upper edge, flat and unstretched at first, and comes to rest
  kSwing,    ///< hangs at rest from a bar that is then moved to and fro across the sample
  kStretch,  ///< hangs at rest, is pulled taut and aside at its lower edge, and let go
  kDrape,    ///< falls flat on a fixed sphere
  kFold,     ///< one half lies fixed, the other one is laid over it by its edge, and then pulled
};

/// Whether something touches the cloth, which may then cost many times as much.
constexpr bool isTouched(Motion motion) {
  return motion == Motion::kDrape || motion == Motion::kFold;
}

struct NamedMotion {
  const char* name;
  Motion motion;
};
inline constexpr std::array<NamedMotion, 5> kMotions = {{{"hang", Motion::kHang},
                                                         {"swing", Motion::kSwing},
                                                         {"stretch", Motion::kStretch},
                                                         {"drape", Motion::kDrape},
                                                         {"fold", Motion::kFold}}};

constexpr double kSampleSize = 0.2;  ///< m
constexpr double kCycle = 0.0125;    ///< s, between two instants that are compared
/// Along each side, between material points that are compared.
constexpr int kComparedIntervals = 24;

/// How a motion is computed.
struct TradeOffPoint {
  cloth::Elasticity elasticity = cloth::Elasticity::kGreenLagrange;
  cloth::StepSettings step;
  int cells = 16;           ///< along each side, > 0
  int steps_per_cycle = 1;  ///< > 0
  double thickness = 1.0;   ///< at which layers meet, over the fabric's, > 0; of fold alone

  double cellSize() const { return kSampleSize / cells; }       ///< m
  double timeStep() const { return kCycle / steps_per_cycle; }  ///< s
};

/// What is compared at one instant.
struct Snapshot {
  /// m, of (kComparedIntervals + 1)^2 points of the sample, row by row from its lower edge; between
  /// particles interpolated bilinearly in the cell
  std::vector<Eigen::Vector3d> positions;
  /// N, of what holds the cloth: the mean over the cycle before, from the cloth's change of
  /// momentum. Hang, and stretch while the lower edge is held: of the upper edge, at this instant.
  /// Fold: of the edge that is moved.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  double energy = 0.0;  ///< J, kinetic and potential, above that at the beginning
};

struct Trajectory {
  std::vector<Snapshot> snapshots;  ///< hang: one, of the mean state of the last half second
  bool accepted = true;             ///< every step; false: there are fewer snapshots than instants
  double simulated_seconds = 0.0;
  double computing_seconds = 0.0;  ///< of this thread, for the steps alone
  int steps = 0;                   ///< that were accepted
  int solves = 0;                  ///< linear solves of the implicit methods in all steps
  double settling_seconds = 0.0;   ///< after which no particle was faster than 1 mm/s at the end of
                                   ///< a cycle; simulated_seconds if one was at the very end
};

/// Whether a motion can be followed so: cloth collides with itself in steps of some methods only,
/// and in no other motion than fold has a thickness.
bool canFollow(Motion motion, const TradeOffPoint& point);

/// Computes a motion; a run repeats to the last bit.
/// @param fabric its warp curve rises; for drape with friction, for fold with compression, too
/// @throws std::invalid_argument if cells, steps_per_cycle or thickness are not what TradeOffPoint
///   says, or what Integrator and Cloth throw
Trajectory follow(Motion motion, const material::Fabric& fabric, const TradeOffPoint& point);

/// The state of rest of hang as a trajectory of one snapshot.
/// @throws as follow(), and std::runtime_error if there is no equilibrium
Trajectory restOfHang(const material::Fabric& fabric, const TradeOffPoint& point);

}  // namespace haptex::studies
