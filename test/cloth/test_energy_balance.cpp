#include <gtest/gtest.h>

#include "fixtures.h"
#include "haptex/cloth/energy_balance.h"
#include "haptex/cloth/integrator.h"

namespace haptex::cloth {
namespace {

using Eigen::Vector3d;

material::Fabric elasticFabric(double modulus) {
  material::Fabric fabric = linearFabric();
  fabric.weft.elastic = fabric.warp.elastic = material::StrainStressCurve::linear(modulus);
  fabric.shear.elastic = material::StrainStressCurve::linear(0.5 * modulus);
  return fabric;
}

ModelledEffects gravity() {
  ModelledEffects effects;
  effects.gravity = {0.0, 0.0, -9.81};
  return effects;
}

void attachTop(Cloth& cloth) {
  for (int particle : sideParticles(cloth.mesh(), Side::kTop)) {
    AttachmentPath place;
    place.start = cloth.mesh().initial_positions[particle];
    cloth.attach(particle, place);
  }
}

StepSettings keepingEnergy() {
  StepSettings settings;
  settings.keep_energy = true;
  return settings;
}

double energyOf(const Cloth& cloth, const ClothState& state) {
  return cloth.potentialEnergy(state) + cloth.kineticEnergy(state);
}

const auto kNameOf = [](const auto& info) { return std::string(info.param.name); };

class EveryImplicitIntegrator : public testing::TestWithParam<NamedIntegrationMethod> {};
INSTANTIATE_TEST_SUITE_P(Methods, EveryImplicitIntegrator,
                         testing::ValuesIn(kIntegrationMethods.begin(),
                                           kIntegrationMethods.begin() + 4),
                         kNameOf);

// A linearised step takes every particle along its tangent: unguarded, the turning sheet of this
// test has millions of times its energy after the first step.
TEST_P(EveryImplicitIntegrator, GainsNoEnergyWhereAStiffSheetIsHurled) {
  Cloth cloth(square(4), elasticFabric(1e6), gravity());
  attachTop(cloth);
  ClothState state = cloth.initialState();
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (!cloth.attachments()[i]) state.velocities[i] = {100.0, 30.0, 0.0};
  }
  StepSettings settings = keepingEnergy();
  settings.method = GetParam().method;
  Integrator integrator(cloth, settings);
  bool anew = false;
  for (double h : {0.1, 1e-4, 0.0125, 0.0125, 0.0125, 1.0, 10.0, 1e-3, 0.04}) {
    const double before = energyOf(cloth, state);
    const StepReport report = integrator.step(cloth, state, h);
    EXPECT_TRUE(report.accepted);
    anew = anew || report.taken_anew;
    EXPECT_LE(energyOf(cloth, state), before + 1e-10 * std::abs(before)) << h;
  }
  EXPECT_TRUE(anew);
}

// Even the exact backward Euler step gains: with x'' = l^2 x, h l = 1/2 and v0 = 1 at x0 = 0 the
// energy rises by a third. A sheet that is pressed together is such a system out of its plane.
TEST_P(EveryImplicitIntegrator, GainsNoEnergyWhereASheetBuckles) {
  Cloth cloth(square(4), elasticFabric(1000.0), {});
  ClothState state = cloth.initialState();
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    state.positions[i] *= 0.8;
    state.velocities[i] = {i % 2 ? 0.5 : -0.5, 0.0, 0.0};
  }
  StepSettings settings = keepingEnergy();
  settings.method = GetParam().method;
  settings.newton_iterations = 20;
  Integrator integrator(cloth, settings);
  for (int i = 0; i < 50; ++i) {
    const double before = energyOf(cloth, state);
    EXPECT_TRUE(integrator.step(cloth, state, 2e-3).accepted);
    EXPECT_LE(energyOf(cloth, state), before * (1.0 + 1e-10)) << i;
  }
}

TEST_P(EveryImplicitIntegrator, LeavesASmoothMotionAlone) {
  Cloth cloth(square(6), elasticFabric(100.0), gravity());
  attachTop(cloth);
  ClothState state = cloth.initialState();
  StepSettings settings = keepingEnergy();
  settings.method = GetParam().method;
  settings.newton_iterations = 2;
  Integrator integrator(cloth, settings);
  double taken = 0.0;
  for (int i = 0; i < 100; ++i) {
    const StepReport report = integrator.step(cloth, state, 1e-3);
    EXPECT_FALSE(report.taken_anew) << i;
    taken += report.energy_taken;
  }
  EXPECT_LE(taken, 1e-3 * cloth.kineticEnergy(state) + 1e-9);
}

TEST(EnergyBalance, CountsTheWorkOfAttachments) {
  Cloth cloth(square(4), elasticFabric(100.0), gravity());
  attachTop(cloth);
  ClothState state = cloth.initialState();
  Integrator integrator(cloth, {});
  for (int i = 0; i < 400; ++i) integrator.step(cloth, state, 0.05);
  // Lifted slowly by a metre: all of the work becomes potential energy, and nothing is taken out.
  const double at_rest = energyOf(cloth, state);
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (!cloth.attachments()[i]) continue;
    cloth.attach(static_cast<int>(i), {state.positions[i], Vector3d::UnitZ(), state.time, 10.0});
  }
  double taken = 0.0, mass = 0.0;
  for (double particle : cloth.masses()) mass += particle;
  for (int i = 0; i < 800; ++i) taken += integrator.step(cloth, state, 0.05).energy_taken;
  EXPECT_NEAR(energyOf(cloth, state) - at_rest, mass * 9.81, 0.01 * mass * 9.81);
  EXPECT_LE(taken, 1e-3 * mass * 9.81);
}

TEST(EnergyBalance, AllowsAJumpOfTheAttachmentsNoMoreThanItStores) {
  Cloth cloth(square(4), elasticFabric(1e5), gravity());
  attachTop(cloth);
  ClothState state = cloth.initialState();
  ClothState jumped = state;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (!cloth.attachments()[i]) continue;
    jumped.positions[i] += Vector3d::UnitX();
    cloth.attach(static_cast<int>(i), {jumped.positions[i], Vector3d::Zero(), 0.0, 0.0});
  }
  const double before = energyOf(cloth, state), stored = energyOf(cloth, jumped) - before;
  EXPECT_TRUE(Integrator(cloth, keepingEnergy()).step(cloth, state, 1.0).accepted);
  EXPECT_LE(energyOf(cloth, state), before + 2.0 * stored);
}

TEST(EnergyBalance, SeesThatTheClothHasChangedBetweenSteps) {
  Cloth cloth(square(4), elasticFabric(100.0), {});
  attachTop(cloth);
  ClothState state = cloth.initialState();
  state.positions.back().x() += 0.01;
  Integrator integrator(cloth, keepingEnergy()), other(cloth, keepingEnergy());
  integrator.step(cloth, state, 0.01);
  cloth.setFabric(elasticFabric(1e4));
  ClothState same = state;
  integrator.step(cloth, state, 0.01);
  other.step(cloth, same, 0.01);  // that has not seen the other fabric
  EXPECT_NEAR((state.velocities.back() - same.velocities.back()).norm(), 0.0,
              1e-5 * same.velocities.back().norm());
}

TEST(EnergyBalance, IsRefusedForCorotationalElasticity) {
  ModelledEffects effects;
  effects.elasticity = Elasticity::kCorotational;
  const Cloth cloth(square(2), elasticFabric(100.0), effects);
  EXPECT_THROW(Integrator(cloth, keepingEnergy()), std::invalid_argument);
}

TEST(EnergyBalance, IsNotComputedUnlessAskedFor) {
  Cloth cloth(square(4), elasticFabric(1e6), gravity());
  attachTop(cloth);
  ClothState state = cloth.initialState();
  for (Vector3d& velocity : state.velocities) velocity.x() = 100.0;
  const StepReport report = Integrator(cloth, {}).step(cloth, state, 0.1);
  EXPECT_FALSE(report.taken_anew);
  EXPECT_EQ(report.energy_taken, 0.0);
}

}  // namespace
}  // namespace haptex::cloth
