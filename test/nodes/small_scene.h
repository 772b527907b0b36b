// A scene small enough for tests of what goes on around the simulation.
#pragma once

#include "haptex/nodes/simulated_cloth.h"

namespace haptex::nodes {

constexpr std::uint32_t kSmallParticles = 25;
constexpr std::uint32_t kSmallTop = 20;  // an attached corner

/// 4 x 4 cells of a linear fabric, 0.2 m wide, that hang from their top edge.
inline SimulatedCloth smallSimulation() {
  material::Fabric fabric;
  fabric.name = "test";
  fabric.areal_density = 0.1;
  for (material::MembraneCurves* curves : {&fabric.weft, &fabric.warp, &fabric.shear}) {
    curves->elastic = material::StrainStressCurve::linear(100.0);
  }
  cloth::Scene scene;
  scene.mesh = cloth::makeRectangle(0.2, 0.2, 4, 4, cloth::Triangulation::kOneWay);
  scene.effects.gravity = {0.0, 0.0, -9.80665};
  scene.attached_particles = cloth::sideParticles(scene.mesh, cloth::Side::kTop);
  scene.time_step = 0.005;
  return SimulatedCloth(std::move(scene), std::move(fabric));
}

}  // namespace haptex::nodes
