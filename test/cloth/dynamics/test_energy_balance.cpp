#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <limits>

#include "fixtures.h"
#include "haptex/cloth/dynamics/energy_balance.h"
#include "haptex/cloth/dynamics/integrator.h"

namespace haptex::cloth::test_energy_balance {
namespace {

using Eigen::Vector3d;

ModelledEffects gravity() {
  ModelledEffects effects;
  effects.gravity = {0.0, 0.0, -9.81};
  return effects;
}

void attachTop(Cloth& cloth) {
  for (int particle : mesh::sideParticles(cloth.mesh(), mesh::Side::kTop)) {
    AttachmentPath place;
    place.start = cloth.mesh().initial_positions[particle];
    cloth.attach(particle, place);
  }
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
  Cloth cloth(square(4), material::linearFabric(1e6), gravity());
  attachTop(cloth);
  ClothState state = cloth.initialState();
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (!cloth.attachments()[i]) state.velocities[i] = {100.0, 30.0, 0.0};
  }
  StepSettings settings;
  settings.method = GetParam().method;
  Integrator integrator(cloth, settings);
  bool anew = false;
  const double before = energyOf(cloth, state);
  for (double h : {0.1, 1e-4, 0.0125, 0.0125, 0.0125, 1.0, 10.0, 1e-3, 0.04}) {
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
  Cloth cloth(square(4), material::linearFabric(1000.0), {});
  ClothState state = cloth.initialState();
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    state.positions[i] *= 0.8;
    state.velocities[i] = {i % 2 ? 0.5 : -0.5, 0.0, 0.0};
  }
  StepSettings settings;
  settings.method = GetParam().method;
  settings.newton_iterations = 20;
  Integrator integrator(cloth, settings);
  std::deque<double> before;
  for (int i = 0; i < 50; ++i) {
    before.push_back(energyOf(cloth, state));
    if (before.size() > EnergyBalance::kRemembered + 1) before.pop_front();
    EXPECT_TRUE(integrator.step(cloth, state, 2e-3).accepted);
    const double most = *std::max_element(before.begin(), before.end());
    EXPECT_LE(energyOf(cloth, state), most * (1.0 + 1e-10)) << i;
  }
}

TEST_P(EveryImplicitIntegrator, LeavesASmoothMotionAlone) {
  Cloth cloth(square(6), material::linearFabric(100.0), gravity());
  attachTop(cloth);
  ClothState state = cloth.initialState();
  StepSettings settings;
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
  Cloth cloth(square(4), material::linearFabric(100.0), gravity());
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
  Cloth cloth(square(4), material::linearFabric(1e5), gravity());
  attachTop(cloth);
  ClothState state = cloth.initialState();
  ClothState jumped = state;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (!cloth.attachments()[i]) continue;
    jumped.positions[i] += Vector3d::UnitX();
    cloth.attach(static_cast<int>(i), {jumped.positions[i], Vector3d::Zero(), 0.0, 0.0});
  }
  const double before = energyOf(cloth, state), stored = energyOf(cloth, jumped) - before;
  EXPECT_TRUE(Integrator(cloth, {}).step(cloth, state, 1.0).accepted);
  EXPECT_LE(energyOf(cloth, state), before + 2.0 * stored);
}

TEST(EnergyBalance, SeesThatTheClothHasChangedBetweenSteps) {
  Cloth cloth(square(4), material::linearFabric(100.0), {});
  attachTop(cloth);
  ClothState state = cloth.initialState();
  state.positions.back().x() += 0.01;
  Integrator integrator(cloth, {}), other(cloth, {});
  integrator.step(cloth, state, 0.01);
  cloth.setFabric(material::linearFabric(1e4));
  ClothState same = state;
  integrator.step(cloth, state, 0.01);
  other.step(cloth, same, 0.01);  // that has not seen the other fabric
  EXPECT_NEAR((state.velocities.back() - same.velocities.back()).norm(), 0.0,
              1e-5 * same.velocities.back().norm());
}

// Velocities of a free particle stand for the energies of a motion.
TEST(EnergyBalance, LetsAStepGainWhatThoseBeforeItHaveLost) {
  const Cloth cloth(square(1), material::linearFabric(100.0), {});
  ClothState state = cloth.initialState();
  EnergyBalance balance(cloth);
  const auto excess_of = [&](double speed, bool keeps) {
    ClothState next = state;
    next.velocities[0].x() = speed;
    balance.begin(cloth, state);
    const double excess = balance.excess(cloth, state, next, {});
    if (!keeps) return excess;
    balance.keep(cloth, next, 0.0);
    state = next;
    return excess;
  };
  const auto energy = [&](double speed) { return 0.5 * cloth.masses()[0] * speed * speed; };
  state.velocities[0].x() = 2.0;
  EXPECT_LT(excess_of(1.0, true), 0.0);  // loses
  for (int step = 1; step < EnergyBalance::kRemembered; ++step) {
    EXPECT_LE(excess_of(2.0, false), 0.0) << step;
    EXPECT_NEAR(excess_of(3.0, false), energy(3.0) - energy(2.0), 1e-9 * energy(3.0)) << step;
    EXPECT_LE(excess_of(1.0, true), 0.0) << step;
  }
  EXPECT_LE(excess_of(1.5, true), 0.0);
  EXPECT_NEAR(excess_of(2.0, false), energy(2.0) - energy(1.5), 1e-9 * energy(2.0));  // too late
  excess_of(0.5, true);
  for (Vector3d& position : state.positions) position.x() += 0.5;  // goes on elsewhere
  EXPECT_GT(excess_of(1.0, false), 0.0);
}

TEST(EnergyBalance, TakesWhatIsNotFiniteForExcess) {
  const Cloth cloth(square(1), material::linearFabric(100.0), {});
  const ClothState state = cloth.initialState();
  EnergyBalance balance(cloth);
  balance.begin(cloth, state);
  for (double speed : {std::numeric_limits<double>::quiet_NaN(), 1e200}) {
    ClothState next = state;
    next.velocities[0].x() = speed;
    EXPECT_FALSE(balance.excess(cloth, state, next, {}) <= 0.0) << speed;
  }
}

// The state is still the one before the step, and so is its energy.
TEST(EnergyBalance, KnowsTheEnergyOfTheStateAfterAStepThatWasNotKept) {
  const Cloth cloth(square(1), material::linearFabric(100.0), {});
  ClothState state = cloth.initialState();
  state.positions[0].x() += 0.01;
  EnergyBalance balance(cloth);
  balance.begin(cloth, state);
  EXPECT_LE(balance.excess(cloth, state, state, {}), 0.0);
  balance.keep(cloth, state, 0.0);
  for (double place : {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.1, 0.05, 0.0}) {
    ClothState rejected = state;
    rejected.positions[0].y() += place;
    balance.begin(cloth, state);
    EXPECT_EQ(balance.excess(cloth, state, rejected, {}) <= 0.0, place == 0.0) << place;
  }
}

// A particle is driven downwards by v and thereby gains m v^2 / 2, while a force F up acts on it.
TEST(EnergyBalance, CountsTheWorkOfBodiesThatMove) {
  constexpr double kSpeed = 0.5, kForce = 10.0, kStep = 0.01;
  ModelledEffects effects;
  effects.contacts = true;
  Cloth cloth(square(1), material::linearFabric(100.0), effects);
  const ClothState state = cloth.initialState();
  ClothState next = state;
  next.time = kStep;
  next.velocities[0].z() = -kSpeed;
  const double gained = 0.5 * cloth.masses()[0] * kSpeed * kSpeed;
  const auto excess = [&](double velocity, double gap) {
    const Vector3d of_body(0.0, 0.0, velocity);
    cloth.setContacts(
        {{0, Vector3d::UnitZ(), state.positions[0] + kStep * of_body, gap, of_body, 0.0, kStep}});
    EnergyBalance balance(cloth);
    balance.begin(cloth, state);
    return balance.excess(cloth, state, next,
                          {{ContactReaction::State::kSlips, kForce * Vector3d::UnitZ()}});
  };
  EXPECT_NEAR(excess(0.0, 0.0), gained, 1e-9 * gained);   // a body at rest does no work
  EXPECT_NEAR(excess(-0.1, 0.0), gained, 1e-9 * gained);  // one that gives way takes it
  const double way = 0.5 * gained / kForce;
  EXPECT_NEAR(excess(way / kStep, 0.0), 0.5 * gained, 1e-9 * gained);
  EXPECT_NEAR(excess(0.0, -way), 0.5 * gained, 1e-9 * gained);  // pushed out of it
}

}  // namespace
}  // namespace haptex::cloth::test_energy_balance
