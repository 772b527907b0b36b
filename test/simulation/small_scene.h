// A scene small enough for tests of what goes on around the simulation.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>
#include <string>

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

/// Runs a request that has to be refused with a message containing `expected`, and checks that the
/// simulation goes on as one that never had the request.
/// @param make what both are before
template <typename Make>
void expectRefused(const Make& make, const std::function<void(SimulatedCloth&)>& request,
                   const std::string& expected) {
  SimulatedCloth simulation = make(), untouched = make();
  try {
    request(simulation);
    FAIL() << "accepted, instead of: " << expected;
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
  }
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(simulation.step());
    ASSERT_TRUE(untouched.step());
  }
  EXPECT_EQ(simulation.state().positions, untouched.state().positions);
}

}  // namespace haptex::simulation
