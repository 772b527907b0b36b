// What a person who holds something feels when a part of the loop stands still for a moment, or
// dies.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "haptex/base/clock.h"
#include "haptex/base/finger.h"
#include "haptex/exoskeleton/emulator/emulated_finger.h"

namespace haptex::oracles {

/// What stands still; its connections stay open.
enum class StalledPart {
  kCommands,      ///< the commander, or its messages to the driver
  kMeasurements,  ///< the driver's messages to the commander, which goes on with the last ones
  kDriver,        ///< the driver: neither states are read nor commands sent to the firmware
};
constexpr StalledPart kStalledParts[] = {StalledPart::kCommands, StalledPart::kMeasurements,
                                         StalledPart::kDriver};
/// "commands", "measurements" or "driver".
const char* name(StalledPart part);

/// The worse finger, from the beginning of the stall to 0.4 s after it.
struct StalledHold {
  double hold = 0.0;       ///< N, felt before
  double least = 0.0;      ///< of the hold, no unit: the smallest force felt
  double below = 0.0;      ///< ms, for which less than 80 % of the hold were felt
  double jump = 0.0;       ///< N, by which the felt force grew within 5 ms at most
  double overshoot = 0.0;  ///< N, by which it exceeded the hold at most
};

/// A person pinches walls with this force between the fingertips of the simulated loop; a part of
/// the loop stands still for each of the durations, one after the other.
/// @param urdf      text of the exoskeleton's URDF
/// @param open      m, in hand_base, fingertips before the pinch
/// @param force     N, > 0
/// @param stiffness N/m, > 0, of the walls, which the commands carry
/// @throws std::runtime_error if the loop does not get ready or ends in a fault
std::vector<StalledHold> holdThroughStalls(const std::string& urdf,
                                           const base::PerFinger<Eigen::Vector3d>& open,
                                           double force, double stiffness, StalledPart part,
                                           const std::vector<base::Time>& durations);

/// What dies in a hold that pushes the fingers apart.
enum class DyingPart {
  kCommander,        ///< with its connection
  kSilentCommander,  ///< without: it stops to send
  kDriver,           ///< with the line
  kSilentDriver,
  kMotors,  ///< for comparison: no torque from that moment on, which no device can beat
};

struct Death {
  double motors_on = 0.0;   ///< ms from the death to the last torque
  double force_left = 0.0;  ///< N, felt by the worse finger 20 ms after the death
};

/// The worst of deaths at several moments of a period.
/// @param force N, > 0, commanded to push the fingertips apart
Death dieInAHold(const std::string& urdf, const base::PerFinger<Eigen::Vector3d>& open,
                 double force, DyingPart part);

}  // namespace haptex::oracles
