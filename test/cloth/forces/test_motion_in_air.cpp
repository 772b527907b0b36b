// What the air does to cloth over many steps, by the integrators.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "air_fixtures.h"
#include "fixtures.h"
#include "haptex/cloth/dynamics/integrator.h"

namespace haptex::cloth::test_motion_in_air {
namespace {

using Eigen::Vector3d;

class EveryIntegratorInAir : public testing::TestWithParam<NamedIntegrationMethod> {};
INSTANTIATE_TEST_SUITE_P(Methods, EveryIntegratorInAir, testing::ValuesIn(kIntegrationMethods),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_P(EveryIntegratorInAir, AFlatSheetFallsAtItsTerminalVelocity) {
  ModelledEffects effects = effectsOf(still(kWithoutLift));
  effects.gravity = {-9.81, 0.0, 0.0};   // the sheet lies across x
  material::Fabric soft = limpFabric();  // so that explicit steps are stable
  soft.weft.elastic = soft.warp.elastic = material::StrainStressCurve::linear(1.0);
  soft.shear.elastic = material::StrainStressCurve::linear(0.5);
  const Cloth cloth(square(2), soft, effects);
  ClothState state = cloth.initialState();
  StepSettings settings;
  settings.method = GetParam().method;
  Integrator integrator(cloth, settings);
  const int steps = isImplicit(GetParam().method) ? 100 : 2000;
  for (int i = 0; i < steps; ++i) {
    ASSERT_TRUE(integrator.step(cloth, state, 2.0 / steps).accepted);
  }
  const double terminal = std::sqrt(2.0 * 0.1 * 9.81 / (1.2 * 1.17));
  for (const Vector3d& velocity : state.velocities) {
    // 1 - tanh(2 s g / terminal) is 1e-14; the sheet does not turn in that time.
    EXPECT_NEAR(velocity.x(), -terminal, 1e-6);
  }
}

TEST(AirAndMidpoint, WindsWorkIsNotTakenForGrowth) {
  for (int solves : {1, 10}) {
    const Cloth cloth(square(4), linearFabric(), effectsOf(gusty(kWithoutLift)));
    ClothState state = cloth.initialState();
    StepSettings settings;
    settings.method = IntegrationMethod::kBackwardMidpoint;
    settings.newton_iterations = solves;
    settings.tolerance = 1e-10;
    Integrator integrator(cloth, settings);
    for (int i = 0; i < 20; ++i) {
      EXPECT_EQ(integrator.step(cloth, state, 0.0125).blend, 0.0) << solves << ' ' << i;
    }
    EXPECT_GT(cloth.kineticEnergy(state), 1e-4);  // of 1e-3 kg blown to about 1 m/s
  }
}

TEST(AirAndMidpoint, EnergyNeverGrowsInStillAir) {
  ModelledEffects effects = effectsOf(still(kWithLift));
  effects.gravity = {0.0, 0.0, -9.81};
  Cloth cloth(square(6), stiffeningFabric(), effects);
  ClothState state = randomState(cloth, 0.002, 0.5);
  for (int particle : mesh::sideParticles(cloth.mesh(), mesh::Side::kTop)) {
    AttachmentPath path;
    path.start = cloth.mesh().initial_positions[particle];
    cloth.attach(particle, path);
    state.positions[particle] = path.start;
    state.velocities[particle].setZero();
  }
  StepSettings settings;
  settings.method = IntegrationMethod::kBackwardMidpoint;
  settings.newton_iterations = 30;
  settings.tolerance = 1e-10;
  Integrator integrator(cloth, settings);
  double energy = cloth.potentialEnergy(state) + cloth.kineticEnergy(state);
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(integrator.step(cloth, state, 0.0125).accepted);
    const double next = cloth.potentialEnergy(state) + cloth.kineticEnergy(state);
    EXPECT_LE(next, energy + 1e-9) << i;  // energies near 1e-2 J
    energy = next;
  }
}

TEST(Aerodynamics, AStormAtLongStepsStaysFinite) {
  for (const NamedIntegrationMethod& named : kIntegrationMethods) {
    if (!isImplicit(named.method)) continue;
    for (int solves : {1, 3}) {
      ModelledEffects effects = effectsOf(gusty(kWithLift));
      effects.air->wind.mean = {15.0, 3.0, 1.0};
      effects.gravity = {0.0, 0.0, -9.81};
      effects.viscosity = true;
      material::Fabric light = stiffeningFabric();
      light.areal_density = 0.03;
      Cloth cloth(square(8, 0.3), light, effects);
      for (int particle : mesh::sideParticles(cloth.mesh(), mesh::Side::kTop)) {
        AttachmentPath path;
        path.start = cloth.mesh().initial_positions[particle];
        cloth.attach(particle, path);
      }
      ClothState state = randomState(cloth, 1e-4, 0.0);
      for (int particle : mesh::sideParticles(cloth.mesh(), mesh::Side::kTop)) {
        state.positions[particle] = cloth.mesh().initial_positions[particle];
      }
      StepSettings settings;
      settings.method = named.method;
      settings.newton_iterations = solves;
      Integrator integrator(cloth, settings);
      double fastest = 0.0;
      for (int i = 0; i < 200; ++i) {
        ASSERT_TRUE(integrator.step(cloth, state, 0.0125).accepted) << named.name << ' ' << i;
        for (const Vector3d& velocity : state.velocities) {
          fastest = std::max(fastest, velocity.norm());
        }
      }
      // A flag snaps several times faster than the wind: the midpoint, in one solve, up to 83 m/s.
      EXPECT_LT(fastest, 150.0) << named.name << ' ' << solves;
    }
  }
}

}  // namespace
}  // namespace haptex::cloth::test_motion_in_air
