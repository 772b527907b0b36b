#include "haptex/oracles/experiments/table.h"

#include <cmath>

#include "haptex/base/constants.h"
#include "haptex/contact/obstacle_collision.h"

namespace haptex::oracles {

using base::Finger;
using contact::Fingertip;
using Eigen::Vector3d;

HapticLoopSettings sheetOnPlate(const TableSettings& settings) {
  constexpr double kTouched = 0.02;  // m, the side of a square that a patch covers at least
  const double cell = settings.side / settings.cells;
  HapticLoopSettings loop;
  loop.mesh = mesh::makeRectangle(settings.side, settings.side, settings.cells, settings.cells,
                                  mesh::Triangulation::kAlternating);
  for (Vector3d& place : loop.mesh.initial_positions) {
    place = {-place.z() - 0.5 * settings.side, place.y(), 0.0};
  }
  loop.fabric = settings.fabric;
  loop.effects.viscosity = true;
  loop.effects.bending = true;
  loop.effects.contacts = true;
  loop.effects.gravity = {0.0, 0.0, -base::kStandardGravity};
  loop.step.newton_iterations = 4;
  loop.step.tolerance = 1e-10;
  loop.haptics.refinement = settings.refinement;
  loop.haptics.margin = 0.5 * kTouched;
  loop.haptics.most_elements = static_cast<int>(2.0 * std::pow(kTouched / cell + 1.0, 2));
  const double down = contact::ObstacleCollision::kOffset + 0.5 * settings.plate_thickness;
  mesh::Obstacle plate{"plate", mesh::ObstacleBox{{0.4, 0.4, settings.plate_thickness}},
                       Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, -down))};
  plate.friction = settings.plate_friction;
  loop.obstacles = {plate};
  return loop;
}

Fingertip fingerAbove(double height) {
  Fingertip finger;
  finger.radius = kIndexRadius;
  finger.position = {0.0, 0.0, height};
  return finger;
}

Fingertip press(HapticLoop& loop, double height, double seconds) {
  const double touch = kIndexRadius + loop.layer().law().halfThickness();
  Fingertip finger = fingerAbove(touch + 1e-3);
  loop.rest({finger, std::nullopt}, 0.1);  // until there is a patch
  const int ticks = static_cast<int>(std::lround(seconds * 1e3));
  finger.velocity.z() = (height - touch) / (1e-3 * ticks);
  for (int i = 1; i <= ticks; ++i) {
    finger.position.z() = touch + (height - touch) * i / ticks;
    loop.step({finger, std::nullopt});
  }
  finger.velocity.setZero();
  loop.rest({finger, std::nullopt}, 0.3);
  return finger;
}

Vector3d feltByIndex(const HapticLoop& loop) {
  return loop.layer().contacts()[Finger::kIndex].force;
}

}  // namespace haptex::oracles
