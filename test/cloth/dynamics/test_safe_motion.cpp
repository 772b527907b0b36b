// No state of a cloth that collides with itself intersects.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <tuple>

#include "haptex/base/workload.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/cloth/dynamics/safe_motion.h"
#include "haptex/proximity/intersections.h"
#include "self_contact_fixtures.h"

namespace haptex::cloth::test_safe_motion {
namespace {

using Eigen::Vector3d;

std::size_t intersectionsOf(const Cloth& cloth, const Positions& positions) {
  return proximity::countIntersections(positions, cloth.mesh().triangles);
}

/// Places that a cloth cannot reach without passing through itself.
Positions anywhere(const Positions& from, double way, std::mt19937& random) {
  std::normal_distribution<double> any(0.0, way);
  Positions to = from;
  for (Vector3d& place : to) place += Vector3d(any(random), any(random), any(random));
  return to;
}

TEST(SafeMotion, GoesAllTheWayWhereNothingIsInIt) {
  const Cloth cloth(layers(2, 0.04, 4), fabricNamed("wool"), selfCollision());
  const Positions from = cloth.initialState().positions;
  Positions to = from, reached;
  for (Vector3d& place : to) place += Vector3d(0.3, -0.2 + 0.1 * place.x(), 10.0);
  SafeMotion motion(from.size(), 3e-4);
  const MotionCut cut = motion.go(cloth.selfContact()->nearPairs(), nullptr, from, to, reached);
  EXPECT_EQ(cut.particles, 0);
  EXPECT_EQ(reached, to);
}

TEST(SafeMotion, NothingPassesThroughHoweverFarItIsToGo) {
  const Cloth cloth(layers(2, 0.04, 5), fabricNamed("wool"), selfCollision());
  std::mt19937 random(5);
  for (const double way : {0.002, 0.01, 0.1, 10.0}) {
    Positions at = cloth.initialState().positions;
    for (std::size_t i = at.size() / 2; i < at.size(); ++i) at[i].z() -= 0.99;
    SafeMotion motion(at.size(), 3e-4);
    int cuts = 0;
    for (int i = 0; i < 6; ++i) {
      const Positions to = anywhere(at, way, random);
      const MotionCut cut = motion.go(cloth.selfContact()->nearPairs(), nullptr, at, to, at);
      ASSERT_EQ(intersectionsOf(cloth, at), 0u) << way << ' ' << i;
      if (cut.particles == 0) continue;
      ++cuts;
      EXPECT_GT(cut.longest, 0.0);
      for (int vertex : cut.between) EXPECT_LT(vertex, static_cast<int>(at.size()));
    }
    EXPECT_GT(cuts, 0) << way;
  }
}

TEST(SafeMotion, SaysWhatStopsALayerThatIsToGoThroughAnother) {
  const Cloth cloth(layers(2, 0.04, 4), fabricNamed("wool"), selfCollision());
  Positions from = cloth.initialState().positions;
  const std::size_t half = from.size() / 2;
  for (std::size_t i = half; i < from.size(); ++i) from[i].z() = 2e-3;
  Positions to = from, reached;
  for (std::size_t i = half; i < from.size(); ++i) to[i].z() = -2e-3;
  constexpr double kMargin = 3e-4;
  SafeMotion motion(from.size(), kMargin);
  const MotionCut cut = motion.go(cloth.selfContact()->nearPairs(), nullptr, from, to, reached);
  EXPECT_EQ(cut.particles, static_cast<int>(half));
  ASSERT_GE(cut.between[0], 0);
  for (std::size_t i = half; i < from.size(); ++i) EXPECT_GE(reached[i].z(), 0.99 * kMargin);
}

TEST(SafeMotion, EdgesThatArePressedPartAsTheyTurnPastEachOther) {
  constexpr double kSide = 0.04, kTurn = 1e-3, kAlong = 1e-3;  // m
  const Cloth cloth(layers(2, kSide, 1), fabricNamed("wool"), selfCollision());
  const Positions flat = cloth.initialState().positions;
  for (const double distance : {2e-6, 4e-6, 8e-6}) {
    // The upper edge of one sheet below the lower one of another, which crosses it.
    Positions from = flat, reached;
    const std::size_t half = from.size() / 2;
    for (std::size_t i = 0; i < half; ++i) {
      from[i] = {flat[i].x() - 0.5 * kSide, 0.0, flat[i].y() - kSide};
      from[half + i] = {0.0, from[i].x(), flat[i].y() + distance};
    }
    // To the first order twice as far apart; but it would be 0.05 mm below.
    Positions to = from;
    for (std::size_t i = half; i < to.size(); ++i) {
      to[i] += Vector3d(0.0, kAlong, distance + kTurn * from[i].y() / (0.5 * kSide));
    }
    SafeMotion motion(from.size(), 3e-4);
    const MotionCut cut = motion.go(cloth.selfContact()->nearPairs(), nullptr, from, to, reached);
    EXPECT_GT(cut.particles, 0);
    EXPECT_LT(cut.longest, 2.0 * kTurn * kAlong / (0.5 * kSide));
    double least = 1.0;
    for (const PairEnergy& pair : cloth.selfContact()->touching(reached)) {
      least = std::min(least, pair.distance);
    }
    EXPECT_GT(least, 1.9 * distance);
  }
}

TEST(SafeMotion, LeavesWhatIsNotFiniteToTheStepThatRefusesIt) {
  const Cloth cloth(layers(1, 0.04, 2), fabricNamed("wool"), selfCollision());
  const Positions from = cloth.initialState().positions;
  Positions to = from, reached;
  to[3].y() = std::numeric_limits<double>::quiet_NaN();
  SafeMotion motion(from.size(), 3e-4);
  EXPECT_EQ(motion.go(cloth.selfContact()->nearPairs(), nullptr, from, to, reached).particles, 0);
  EXPECT_TRUE(std::isnan(reached[3].y()));
}

/// Two sheets, of which the upper one is thrown onto the lower one; both are shaken.
ClothState flyingTogether(const Cloth& cloth, double speed, unsigned seed) {
  ClothState state = cloth.initialState();
  std::mt19937 random(seed);
  std::normal_distribution<double> any(0.0, 0.3 * speed);
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    state.velocities[i] = Vector3d(any(random), any(random), any(random));
    if (i < state.positions.size() / 2) continue;
    state.positions[i].z() = 0.003 + 0.05 * state.positions[i].x();
    state.velocities[i].z() -= speed;
  }
  return state;
}

class Crumpling : public testing::TestWithParam<std::tuple<IntegrationMethod, int>> {};
INSTANTIATE_TEST_SUITE_P(MethodsAndNewtonIterations, Crumpling,
                         testing::Combine(testing::Values(IntegrationMethod::kBackwardEuler,
                                                          IntegrationMethod::kBdf2,
                                                          IntegrationMethod::kTrBdf2),
                                          testing::Values(1, 8)));

TEST_P(Crumpling, NeverIntersectsNorGainsEnergy) {
  ModelledEffects effects = selfCollision();
  effects.bending = true;
  Cloth cloth(layers(2, 0.08, 8), fabricNamed("wool"), effects);
  constexpr unsigned kSeeds = base::unlessSanitized(6u, 2u);
  unsigned touched = 0;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    StepSettings settings;
    std::tie(settings.method, settings.newton_iterations) = GetParam();
    Integrator integrator(cloth, settings);
    ClothState state = flyingTogether(cloth, 0.5 + 0.5 * seed, seed);
    double energy = cloth.potentialEnergy(state) + cloth.kineticEnergy(state);
    const double first = energy;
    std::size_t touching = 0;
    for (int i = 0; i < 25; ++i) {
      ASSERT_TRUE(integrator.step(cloth, state, 0.0125).accepted);
      ASSERT_EQ(intersectionsOf(cloth, state.positions), 0u) << seed << ' ' << i;
      touching = std::max(touching, cloth.selfContact()->touching(state.positions).size());
      energy = cloth.potentialEnergy(state) + cloth.kineticEnergy(state);
      EXPECT_LE(energy, first * (1.0 + 1e-9)) << seed << ' ' << i;
    }
    touched += touching > 0;
  }
  // By methods of the second order sheets bounce off each other within a step in one of them.
  const bool first_order = std::get<0>(GetParam()) == IntegrationMethod::kBackwardEuler;
  EXPECT_GE(touched, first_order ? kSeeds : kSeeds - 1);
}

TEST(Crumpled, IsTheSameForAnyNumberOfThreads) {
  ClothState states[2];
  for (int threads : {1, 3}) {
    Cloth cloth(layers(2, 0.08, 8), fabricNamed("wool"), selfCollision());
    StepSettings settings;
    settings.newton_iterations = 5;
    settings.threads = threads;
    Integrator integrator(cloth, settings);
    ClothState& state = states[threads == 3];
    state = flyingTogether(cloth, 2.0, 3);
    for (int i = 0; i < 12; ++i) integrator.step(cloth, state, 0.0125);
  }
  EXPECT_EQ(states[0].positions, states[1].positions);
}

TEST(Crumpled, IsRefusedByIntegratorsThatDoNotKnowHow) {
  for (const bool obstacles : {false, true}) {
    ModelledEffects effects = selfCollision();
    effects.contacts = obstacles;
    const Cloth cloth(layers(1, 0.04, 2), fabricNamed("wool"), effects);
    for (const NamedIntegrationMethod& named : kIntegrationMethods) {
      StepSettings settings;
      settings.method = named.method;
      const bool two_instants =
          named.method == IntegrationMethod::kBdf2 || named.method == IntegrationMethod::kTrBdf2;
      if (named.method == IntegrationMethod::kBackwardEuler || (two_instants && !obstacles)) {
        EXPECT_NO_THROW(Integrator(cloth, settings));
        continue;
      }
      try {
        Integrator integrator(cloth, settings);
        FAIL() << named.name;
      } catch (const std::invalid_argument& error) {
        EXPECT_EQ(error.what(), std::string("self_collision is modelled") +
                                    (obstacles ? " with obstacles" : "") +
                                    ", which the integrator " + named.name + " does not know");
      }
    }
  }
}

}  // namespace
}  // namespace haptex::cloth::test_safe_motion
