#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "small_scene.h"

namespace haptex::simulation::test_adaptive_steps {
namespace {

using cloth::IntegrationMethod;

constexpr double kFrame = 0.0125;  // s

/// The small scene turned about its held edge by half a radian.
scene::Scene swing(IntegrationMethod method) {
  scene::Scene scene = smallScene();
  for (Eigen::Vector3d& place : scene.mesh.initial_positions) {
    place = {-place.z() * std::sin(0.5), place.y(), place.z() * std::cos(0.5)};
  }
  scene.time_step = kFrame;
  scene.step.method = method;
  scene.step.newton_iterations = 10;
  return scene;
}

scene::Scene adaptiveSwing(IntegrationMethod method, double error) {
  scene::Scene scene = swing(method);
  scene.adaptive_steps = {1e-5, kFrame, error};
  return scene;
}

struct Motion {
  std::vector<Eigen::Vector3d> places;
  int substeps = 0;
};

Motion runFor(const scene::Scene& scene, double duration) {
  SimulatedCloth simulation(scene, smallFabric());
  Motion run;
  const long steps = std::lround(duration / scene.time_step);
  for (long i = 0; i < steps; ++i) {
    EXPECT_TRUE(simulation.step());
    run.substeps += std::max(1, simulation.lastAdaptiveReport().substeps);
  }
  EXPECT_NEAR(simulation.state().time, duration, 1e-12);
  run.places = simulation.state().positions;
  return run;
}

double distance(const Motion& run, const Motion& other) {
  double largest = 0.0;
  for (std::size_t i = 0; i < run.places.size(); ++i) {
    largest = std::max(largest, (run.places[i] - other.places[i]).norm());
  }
  return largest;
}

Motion reference(double duration) {
  scene::Scene scene = swing(IntegrationMethod::kTrBdf2);
  scene.time_step = 1e-4;
  return runFor(scene, duration);
}

class AdaptiveSteps : public testing::TestWithParam<IntegrationMethod> {};

TEST_P(AdaptiveSteps, ComeNearerToTheMotionForMoreSteps) {
  // A tenth of the error that is allowed in every step is paid for by more steps, and brings the
  // swing nearer to the exact one.
  const Motion exact = reference(0.2);
  const Motion rough = runFor(adaptiveSwing(GetParam(), 1e-4), 0.2);
  const Motion middle = runFor(adaptiveSwing(GetParam(), 1e-5), 0.2);
  const Motion fine = runFor(adaptiveSwing(GetParam(), 1e-6), 0.2);
  EXPECT_LT(rough.substeps, middle.substeps);
  EXPECT_LT(middle.substeps, fine.substeps);
  EXPECT_LT(distance(fine, exact), 0.3 * distance(rough, exact));
}

TEST_P(AdaptiveSteps, MissNoMoreThanAllowedOrAreTheShortest) {
  constexpr double kError = 2e-5, kShortest = 1e-5;
  SimulatedCloth simulation(adaptiveSwing(GetParam(), kError), smallFabric());
  bool several = false;
  for (int i = 0; i < 40; ++i) {
    ASSERT_TRUE(simulation.step());
    const AdaptiveReport& report = simulation.lastAdaptiveReport();
    EXPECT_GE(report.substeps, 1);
    EXPECT_GE(report.shortest, kShortest * (1.0 - 1e-9));
    EXPECT_LE(report.shortest, kFrame / report.substeps * (1.0 + 1e-9));
    if (report.error > kError) {
      EXPECT_TRUE(report.missed);
      EXPECT_LT(report.shortest, 2.0 * kShortest);
    }
    several = several || report.substeps > 1;
  }
  EXPECT_TRUE(several);
}

TEST_P(AdaptiveSteps, EndAtTheShortestWhereNoErrorIsSmallEnough) {
  // Not by a whole number of shortest steps: what is left must not be tried for ever.
  for (const double shortest : {kFrame, kFrame / 1.9, kFrame / 2.5, kFrame / 7.3}) {
    scene::Scene scene = adaptiveSwing(GetParam(), 1e-15);
    scene.adaptive_steps->shortest = shortest;
    SimulatedCloth simulation(scene, smallFabric());
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(simulation.step());
    EXPECT_TRUE(simulation.lastAdaptiveReport().missed);
    EXPECT_EQ(simulation.lastAdaptiveReport().substeps,
              static_cast<int>(std::floor(kFrame / shortest * (1.0 + 1e-9))));
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, AdaptiveSteps,
                         testing::Values(IntegrationMethod::kBackwardEuler,
                                         IntegrationMethod::kBackwardMidpoint,
                                         IntegrationMethod::kBdf2, IntegrationMethod::kTrBdf2));

TEST(AdaptiveStep, EstimateIsTheErrorOfASmoothStep) {
  // One step from a state of a smooth motion against the same time in a thousand steps.
  for (const IntegrationMethod method :
       {IntegrationMethod::kBackwardEuler, IntegrationMethod::kTrBdf2}) {
    const scene::Scene scene = swing(method);
    const cloth::Cloth model = [&] {
      cloth::Cloth made(scene.mesh, smallFabric(), scene.effects);
      for (const int particle : scene.attached_particles) {
        made.attach(particle, {scene.mesh.initial_positions[particle], Eigen::Vector3d::Zero()});
      }
      return made;
    }();
    constexpr double kLength = 0.0005;
    cloth::StepLengthControl lengths(model, method, {kLength, kLength, 1.0});
    cloth::Integrator integrator(model, scene.step), fine(model, scene.step);
    cloth::ClothState state = model.initialState();
    for (int i = 0; i < 400; ++i) ASSERT_TRUE(fine.step(model, state, kLength / 10).accepted);
    cloth::ClothState before = state;
    ASSERT_TRUE(integrator.step(model, state, kLength).accepted);
    cloth::ClothState next = state, exact = state;
    ASSERT_TRUE(integrator.step(model, next, kLength).accepted);
    lengths.judge(model, before, state, kLength);
    lengths.judge(model, state, next, kLength);
    for (int i = 0; i < 1000; ++i) ASSERT_TRUE(fine.step(model, exact, kLength / 1000).accepted);
    double error = 0.0;
    for (std::size_t i = 0; i < exact.positions.size(); ++i) {
      error = std::max(error, (next.positions[i] - exact.positions[i]).norm());
    }
    EXPECT_NEAR(lengths.error(), error, 0.25 * error) << cloth::nameOf(method);
  }
}

TEST(AdaptiveStep, AChosenLengthIsTaken) {
  SimulatedCloth simulation = smallSimulation();
  ASSERT_TRUE(simulation.step(0.001));
  EXPECT_DOUBLE_EQ(simulation.state().time, 0.001);
  EXPECT_DOUBLE_EQ(simulation.lastStepDuration(), 0.001);
  ASSERT_TRUE(simulation.step(0.02));
  ASSERT_TRUE(simulation.step());
  EXPECT_DOUBLE_EQ(simulation.state().time, 0.026);
  EXPECT_EQ(simulation.steps(), 3u);
  for (const double wrong : {0.0, -0.001, 1e-7, 11.0, std::nan("")}) {
    EXPECT_THROW(simulation.step(wrong), std::invalid_argument) << wrong;
  }
  EXPECT_EQ(simulation.steps(), 3u);
}

TEST(AdaptiveStep, UnsoundLengthsAreRefused) {
  const scene::Scene scene = swing(IntegrationMethod::kBackwardEuler);
  const auto simulate = [&](const cloth::AdaptiveSteps& steps, int substeps = 1) {
    SimulatedCloth(scene, smallFabric(), {{scene.step, substeps, 1, steps}});
  };
  EXPECT_NO_THROW(simulate({0.001, 0.01, 1e-4}));
  EXPECT_THROW(simulate({0.001, 0.01, 1e-4}, 2), std::invalid_argument);
  EXPECT_THROW(simulate({0.0, 0.01, 1e-4}), std::invalid_argument);
  EXPECT_THROW(simulate({0.02, 0.01, 1e-4}), std::invalid_argument);
  EXPECT_THROW(simulate({0.001, 0.01, 0.0}), std::invalid_argument);
  EXPECT_THROW(simulate({0.001, 0.01, std::nan("")}), std::invalid_argument);
}

TEST(AdaptiveStep, AnExplicitMethodFindsALengthThatIsStable) {
  SimulatedCloth fixed(swing(IntegrationMethod::kRungeKutta4), smallFabric());
  bool accepted = true;
  for (int i = 0; i < 20; ++i) accepted = fixed.step() && accepted;
  EXPECT_FALSE(accepted) << "the longest step is stable itself";
  SimulatedCloth simulation(adaptiveSwing(IntegrationMethod::kRungeKutta4, 1e-4), smallFabric());
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(simulation.step());
  EXPECT_LT(distance({simulation.state().positions}, reference(20 * kFrame)), 0.005);
}

TEST(AdaptiveStep, OneThatHasFailedIsRepeatedInShorterOnesDownToTheShortest) {
  const scene::Scene scene = swing(IntegrationMethod::kBackwardEuler);
  const cloth::Cloth model(scene.mesh, smallFabric(), scene.effects);
  cloth::StepLengthControl lengths(model, IntegrationMethod::kBackwardEuler, {1e-3, 1.0, 1.0});
  const cloth::ClothState rest = model.initialState();
  EXPECT_DOUBLE_EQ(lengths.lengthWithin(0.1), 1e-3);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(lengths.judge(model, rest, rest, 0.1));
  EXPECT_GT(lengths.lengthWithin(0.1), 0.02);  // twice as long each time
  double length = lengths.lengthWithin(0.1);
  while (lengths.shorten(0.1)) {
    EXPECT_LE(lengths.lengthWithin(0.1), 0.5 * length);
    length = lengths.lengthWithin(0.1);
  }
  EXPECT_DOUBLE_EQ(length, 1e-3);
}

TEST(AdaptiveStep, WhatGoesOnFromSomewhereElseHasNoStepBefore) {
  // Free fall, of which a method of order 2 misses nothing, but for a jump of the velocity between
  // two steps.
  scene::Scene scene = swing(IntegrationMethod::kTrBdf2);
  const cloth::Cloth model(scene.mesh, smallFabric(), scene.effects);
  cloth::StepLengthControl lengths(model, IntegrationMethod::kTrBdf2, {1e-3, 1e-3, 1.0});
  cloth::Integrator integrator(model, scene.step);
  cloth::ClothState state = model.initialState();
  const auto error_after = [&](double time, const Eigen::Vector3d& velocity) {
    cloth::ClothState begin = state;
    begin.time = time;
    for (Eigen::Vector3d& of_particle : begin.velocities) of_particle += velocity;
    state = begin;
    EXPECT_TRUE(integrator.step(model, state, 1e-3).accepted);
    EXPECT_TRUE(lengths.judge(model, begin, state, 1e-3));
    return lengths.error();
  };
  error_after(0.0, Eigen::Vector3d::Zero());
  EXPECT_LT(error_after(state.time, Eigen::Vector3d::Zero()), 1e-9);
  EXPECT_GT(error_after(state.time, Eigen::Vector3d::UnitX()), 1e-5);
  EXPECT_EQ(error_after(state.time + 1.0, Eigen::Vector3d::UnitX()), 0.0);
}

}  // namespace
}  // namespace haptex::simulation::test_adaptive_steps
