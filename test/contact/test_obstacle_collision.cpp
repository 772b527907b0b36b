#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "../cloth/fixtures.h"
#include "haptex/contact/obstacles/obstacle_collision.h"
#include "haptex/contact/obstacles/obstacles.h"

namespace haptex::contact::test_obstacle_collision {
namespace {

using cloth::ClothState;
using cloth::placedAt;
using Eigen::Vector3d;
using mesh::Obstacle;

/// A sheet of 0.2 m that hangs from its top edge in the plane x = 0, with its top at z = 0.
struct HangingSheet {
  cloth::Cloth cloth;
  ClothState state;
  cloth::Integrator integrator;
  ObstacleCollision collision;

  HangingSheet(const std::vector<Obstacle>& obstacles, const cloth::StepSettings& settings)
      : cloth(cloth::square(10, 0.2), fabric(), effects()),
        state(cloth.initialState()),
        integrator(cloth, settings),
        collision(cloth, obstacles) {
    for (const int particle : sideParticles(cloth.mesh(), mesh::Side::kTop)) {
      cloth.attach(particle, {state.positions[particle], Vector3d::Zero(), 0.0, 0.0});
    }
  }

  static material::Fabric fabric() {
    material::Fabric fabric = cloth::linearFabric(0.1);
    fabric.friction = 0.3;
    return fabric;
  }
  static cloth::ModelledEffects effects() {
    cloth::ModelledEffects effects;
    effects.gravity = {0.0, 0.0, -9.81};
    effects.viscosity = effects.contacts = true;
    return effects;
  }

  /// Signed distance of the nearest free particle to any obstacle.
  double least() const {
    double least = 1.0;
    for (const Obstacle& obstacle : collision.obstacles()) {
      proximity::RigidObstacle shape = makeObstacle(obstacle);
      shape.setPose(obstacle.poseAt(state.time));
      for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
        if (cloth.attachments()[i]) continue;
        least = std::min(least, shape.distance(state.positions[i]).distance);
      }
    }
    return least;
  }
};

constexpr double kLeast = ObstacleCollision::kOffset - ObstacleCollision::kTolerance;

class Methods : public testing::TestWithParam<cloth::NamedIntegrationMethod> {};

TEST_P(Methods, LetNoParticleIntoAnyShape) {
  Obstacle sphere{"sphere", mesh::ObstacleSphere{0.04}, placedAt({0.1, 0.0, -0.12})};
  Obstacle box{"box", mesh::ObstacleBox{{0.002, 0.15, 0.15}}, placedAt({0.1, 0.0, -0.15})};
  Obstacle capsule{"capsule", mesh::ObstacleCapsule{0.02, 0.3},
                   placedAt({0.1, 0.0, -0.12}) * Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX())};
  Obstacle mesh{"mesh",
                mesh::ObstacleMesh{{{0, -0.2, 0.05}, {0, 0.2, 0.05}, {0, 0, -0.25}}, {{0, 1, 2}}},
                placedAt({0.1, 0.0, -0.12})};
  const bool implicit = isImplicit(GetParam().method);
  const double h = implicit ? 0.0125 : 5e-4;
  for (Obstacle obstacle : {sphere, box, capsule, mesh}) {
    for (const double speed : {-0.5, -10.0}) {
      obstacle.motion = mesh::ObstacleDrift{{speed, 0.0, 0.0}};
      cloth::StepSettings settings;
      settings.method = GetParam().method;
      HangingSheet sheet({obstacle}, settings);
      double farthest = 0.0;
      const double duration = std::min(0.3, 0.15 / std::abs(speed) + 2.0 * h);
      while (sheet.state.time < duration) {
        if (!sheet.collision.step(sheet.cloth, sheet.integrator, sheet.state, h).accepted) break;
        // An explicit method blows up under such blows sooner or later.
        double fastest = 0.0;
        for (const Vector3d& velocity : sheet.state.velocities) {
          fastest = std::max(fastest, velocity.norm());
        }
        if (!implicit && fastest > 1e3) break;
        ASSERT_GE(sheet.least(), kLeast)
            << obstacle.name << ' ' << speed << ' ' << sheet.state.time;
        for (const Vector3d& place : sheet.state.positions) {
          farthest = std::min(farthest, place.x());
        }
      }
      // It was pushed ahead, not passed. An explicit method breaks under such blows sooner or
      // later.
      if (implicit) {
        EXPECT_LT(farthest, -0.005) << obstacle.name << ' ' << speed;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Methods, testing::ValuesIn(cloth::kIntegrationMethods),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(ObstacleCollision, BringsOutWhatAJumpOfTheObstacleHasCaught) {
  Obstacle sphere{"sphere", mesh::ObstacleSphere{0.04}, placedAt({0.01, 0.003, -0.12})};
  HangingSheet sheet({sphere}, {});  // starts with the sphere in it
  EXPECT_LT(sheet.least(), -0.01);
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(sheet.collision.step(sheet.cloth, sheet.integrator, sheet.state, 0.01).accepted);
    ASSERT_GE(sheet.least(), kLeast);
  }
}

TEST(ObstacleCollision, DoesNothingToAClothOutOfReach) {
  const Obstacle far{"far", mesh::ObstacleSphere{0.04}, placedAt({1.0, 0.0, 0.0})};
  HangingSheet among({far}, {}), alone({far}, {});
  for (int i = 0; i < 20; ++i) {
    among.collision.step(among.cloth, among.integrator, among.state, 0.01);
    alone.integrator.step(alone.cloth, alone.state, 0.01);
    EXPECT_TRUE(among.cloth.contacts().empty());
  }
  EXPECT_EQ(among.state.positions, alone.state.positions);
  EXPECT_EQ(among.state.velocities, alone.state.velocities);
}

TEST(ObstacleCollision, NeedsACoefficientOfFriction) {
  material::Fabric bare = HangingSheet::fabric();
  bare.friction.reset();
  cloth::Cloth cloth(cloth::square(2), bare, HangingSheet::effects());
  Obstacle sphere{"ball", mesh::ObstacleSphere{0.04}, placedAt({1.0, 0.0, 0.0})};
  try {
    const ObstacleCollision collision(cloth, {sphere});
    ADD_FAILURE();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("obstacle 'ball' has no friction"), std::string::npos);
  }
  sphere.friction = 0.0;
  EXPECT_NO_THROW(ObstacleCollision(cloth, {sphere}));
}

/// A sheet that collides with itself, too, and starts where the obstacle is 10 mm before it.
TEST(ObstacleCollision, GivesTheObstaclesThemselvesToAClothThatCollidesWithItself) {
  material::Fabric fabric = HangingSheet::fabric();
  fabric.compression = material::Compression{
      1e-3, material::StrainStressCurve::fit({{0.2, 500.0}, {0.5, 5000.0}},
                                             material::NegativeBranch::kLinear)};
  cloth::ModelledEffects effects = HangingSheet::effects();
  effects.self_collision = true;
  const mesh::ObstacleCapsule needle{5e-4, 0.05};
  for (const double x : {0.01, 0.0}) {
    cloth::Cloth cloth(cloth::square(10, 0.2), fabric, effects);
    Obstacle obstacle{
        "needle", needle,
        placedAt({x + 0.0255, 0.005, -0.105}) * Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY())};
    if (x == 0.0) obstacle.pose.translation().x() = 0.02;  // its tip is in the sheet
    obstacle.motion = mesh::ObstacleDrift{{-0.5, 0.0, 0.0}};
    if (x == 0.0) {
      try {
        const ObstacleCollision collision(cloth, {obstacle});
        ADD_FAILURE();
      } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find("touches obstacle 'needle' at the start"),
                  std::string::npos)
            << error.what();
      }
      continue;
    }
    for (const int particle : sideParticles(cloth.mesh(), mesh::Side::kTop)) {
      cloth.attach(particle,
                   {cloth.initialState().positions[particle], Vector3d::Zero(), 0.0, 0.0});
    }
    ObstacleCollision collision(cloth, {obstacle});
    cloth::StepSettings settings;
    settings.newton_iterations = 5;
    cloth::Integrator integrator(cloth, settings);
    ClothState state = cloth.initialState();
    proximity::RigidObstacle shape = makeObstacle(obstacle);
    double force = 0.0;
    for (int i = 0; i < 8; ++i) {
      ASSERT_TRUE(collision.step(cloth, integrator, state, 0.0125).accepted);
      EXPECT_TRUE(cloth.contacts().empty());
      shape.setPose(obstacle.poseAt(state.time));
      for (const auto& [a, b, c] : cloth.mesh().triangles) {
        EXPECT_GT(shape.closestPoint({state.positions[a], state.positions[b], state.positions[c]})
                      .distance,
                  0.0);
      }
      force = std::max(force, cloth.selfContact()->forceOn(0, state.ofForces()).x());
    }
    EXPECT_GT(force, 0.0);
  }
}

/// A whole sheet rubs on a plate, then rests there, strained: most of it creeps, slips or sticks
/// with less friction than it could have. Each round is a solve.
TEST(ObstacleCollision, WhatRubsAndRestsStrainedIsFoundInFewRounds) {
  constexpr int kPull = 40, kRest = 40;  // steps
  material::Fabric fabric = HangingSheet::fabric();
  fabric.shear.elastic = material::StrainStressCurve::linear(20.0);
  cloth::ModelledEffects effects = HangingSheet::effects();
  effects.gravity = {-9.81, 0.0, 0.0};
  cloth::Cloth cloth(cloth::square(16, 0.2), fabric, effects);
  cloth::StepSettings settings;
  settings.newton_iterations = 1;
  cloth::Integrator integrator(cloth, settings);
  ObstacleCollision collision(cloth, {{"plate", mesh::ObstacleBox{{0.02, 0.5, 0.5}},
                                       placedAt({-0.01 - ObstacleCollision::kOffset, 0.0, -0.1})}});
  ClothState state = cloth.initialState();
  const int drawn = sideParticles(cloth.mesh(), mesh::Side::kTop).front();  // a corner
  cloth.attach(drawn, {state.positions[drawn], {0.0, -0.01, 0.01}, 0.0, 0.5});
  std::array<int, 2> rounds{};  // while it is drawn, and afterwards
  for (int i = 0; i < kPull + kRest; ++i) {
    const cloth::StepReport report = collision.step(cloth, integrator, state, 0.0125);
    ASSERT_TRUE(report.accepted);
    rounds[i < kPull ? 0 : 1] += report.contact_rounds;
  }
  EXPECT_LE(rounds[0], 7 * kPull);
  EXPECT_LE(rounds[1], 3 * kRest);
  EXPECT_GT((state.positions[drawn] - cloth.initialState().positions[drawn]).norm(), 0.01);
}

}  // namespace
}  // namespace haptex::contact::test_obstacle_collision
