// Fabric on a horizontal plate, and one finger: both layers in the loop that ships.
#pragma once

#include "haptex/oracles/experiments/haptic_loop.h"

namespace haptex::oracles {

struct TableSettings {
  material::Fabric fabric;
  double side = 0.1;              ///< m, of the square sheet
  int cells = 32;                 ///< along each side
  int refinement = 2;             ///< of its patches
  double plate_friction = 0.2;    ///< of the fabric on the plate
  double plate_thickness = 0.02;  ///< m
};

/// The sheet lies where cloth rests on the plate, in the plane z = 0 with its middle in the origin,
/// weft along y and warp along -x. Nothing holds it. The patches have all elements that a fingertip
/// of 10 mm touches.
HapticLoopSettings sheetOnPlate(const TableSettings& settings);

/// The index finger above the middle of the sheet.
/// @param height m, of its centre above the plane z = 0
contact::Fingertip fingerAbove(double height);

/// Comes straight down from the touch to a height within `seconds`, and rests for 0.3 s.
/// @return the fingertip, for further steps of the loop
contact::Fingertip press(HapticLoop& loop, double height, double seconds);

/// N, that the cloth's layer has the index finger feel.
Eigen::Vector3d feltByIndex(const HapticLoop& loop);

}  // namespace haptex::oracles
