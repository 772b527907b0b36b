// How stiff a virtual wall the exoskeleton can render without giving energy.
#pragma once

#include <Eigen/Core>
#include <string>

#include "haptex/base/finger.h"
#include "haptex/exoskeleton/emulator/emulated_finger.h"

namespace haptex::oracles {

/// A flat wall that pushes a fingertip at depth d with stiffness d - damping (speed out of it), and
/// never pulls. It knows the fingertip as a topic does: as the driver measured it a tick ago.
struct VirtualWall {
  double stiffness = 0.0;  ///< N/m, > 0
  double damping = 0.0;    ///< N s/m
  /// Its commands carry stiffness and damping. If not, the force alone.
  bool linearised = true;
  int delay = 0;  ///< ms, of its commands
};

/// What became of a wall under one finger: presses that are held, then approach and retract cycles.
struct WallTouch {
  /// N, RMS about the mean, of the force that the person feels in the worst of the holds.
  double ripple = 0.0;
  /// By how much the largest force of the cycles exceeds the one that the person presses with; of
  /// that, no unit.
  double overshoot = 0.0;
  /// J, the lowest that the wall had absorbed since the begin of a cycle as the driver observes it:
  /// what left the safety chain times the measured velocity (PassivityController).
  double observed_energy = 0.0;
  /// J, the most that the device gave to the person in a cycle: the true force times the true
  /// motion. What it gives goes into the damping of the person's finger.
  double given_energy = 0.0;
  /// Share of the cycles' ticks in which the passivity controller acted.
  double controller_share = 0.0;

  /// No limit cycle: ripple below 0.01 N RMS, overshoot below a fifth.
  bool steady() const;
  /// Observed energy not below what the noise of the force sensor makes of it, and the controller
  /// acted in less than 1 % of the ticks. What the driver observes knows nothing of the delays
  /// behind it: a linearised wall looks passive there even where it is not steady.
  bool observedPassive() const;
};

/// Both fingers in the simulated loop, each at a wall across the way between its fingertip and the
/// other one. The person presses with 0.3, 1 and 2 N and holds each for 5 s; then come `cycles` of
/// 0.8 s between 5 mm before the wall and a press with 2 N, at up to 0.11 m/s.
/// @param urdf  text of the exoskeleton's URDF
/// @param open  m, in hand_base, fingertips before a pinch: the walls are 5 mm closer together
/// @param walls of each finger
/// @throws std::invalid_argument if the stiffness is not > 0 or another number is negative or not
///   finite
/// @throws std::runtime_error if the loop does not get ready or has a fault
base::PerFinger<WallTouch> touchWalls(const std::string& urdf,
                                      const exoskeleton::FingerMechanics& mechanics,
                                      const base::PerFinger<Eigen::Vector3d>& open,
                                      const base::PerFinger<VirtualWall>& walls, int cycles);

}  // namespace haptex::oracles
