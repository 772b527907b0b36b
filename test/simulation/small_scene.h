// A scene small enough for tests of what goes on around the simulation.
#pragma once

#include "haptex/simulation/simulated_cloth.h"

namespace haptex::simulation {

constexpr std::uint32_t kSmallParticles = 25;
constexpr std::uint32_t kSmallTop = 20;  // an attached corner

/// Linear, with all that bends, and hysteresis of everything.
inline material::Fabric smallFabric() {
  material::Fabric fabric;
  fabric.name = "test";
  fabric.areal_density = 0.1;
  for (material::MembraneCurves* curves : {&fabric.weft, &fabric.warp, &fabric.shear}) {
    curves->elastic = material::StrainStressCurve::linear(100.0);
  }
  fabric.bending = {1e-5, 1e-5};
  fabric.bending_hysteresis = {2e-4, 2e-4};
  fabric.resilience = {0.6, 0.7};
  fabric.shear_hysteresis = {0.02, 0.05};
  return fabric;
}

/// 4 x 4 cells, 0.2 m wide, that hang from their top edge.
inline scene::Scene smallScene() {
  scene::Scene scene;
  scene.mesh = mesh::makeRectangle(0.2, 0.2, 4, 4, mesh::Triangulation::kOneWay);
  scene.effects.gravity = {0.0, 0.0, -9.80665};
  scene.effects.point_loads = true;
  scene.attached_particles = mesh::sideParticles(scene.mesh, mesh::Side::kTop);
  scene.time_step = 0.005;
  return scene;
}

inline SimulatedCloth smallSimulation(bool bending_hysteresis = false) {
  scene::Scene scene = smallScene();
  scene.effects.bending = scene.effects.bending_hysteresis = bending_hysteresis;
  return SimulatedCloth(std::move(scene), smallFabric());
}

}  // namespace haptex::simulation
