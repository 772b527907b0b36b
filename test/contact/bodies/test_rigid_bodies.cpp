// Obstacles with mass, in one step with the cloth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "../../cloth/fixtures.h"
#include "haptex/contact/obstacles/obstacle_collision.h"

namespace haptex::contact::test_rigid_bodies {
namespace {

using cloth::placedAt;
using Eigen::Vector3d;
using mesh::Obstacle;

Obstacle ball(double mass, const Vector3d& place, const Vector3d& velocity, double friction = 0.3) {
  Obstacle ball{"ball", mesh::ObstacleSphere{0.03}, placedAt(place)};
  ball.body = mesh::ObstacleBody{mass, velocity, Vector3d::Zero(), friction};
  return ball;
}

/// A level sheet of 0.2 m with its middle in the origin, 0.1 kg/m2, 4 g.
struct Sheet {
  cloth::Cloth cloth;
  cloth::ClothState state;
  ObstacleCollision collision;
  cloth::Integrator integrator;

  Sheet(const std::vector<Obstacle>& obstacles, double gravity, cloth::StepSettings settings = {})
      : cloth(level(), fabric(), effects(gravity)),
        state(cloth.initialState()),
        collision(cloth, obstacles),
        integrator(cloth, settings) {}

  static mesh::ClothMesh level() {
    mesh::ClothMesh mesh = cloth::square(12, 0.2);
    for (std::size_t i = 0; i < mesh.initial_positions.size(); ++i) {
      const Eigen::Vector2d place = mesh.rest_coordinates[i] - Eigen::Vector2d(0.1, 0.1);
      mesh.initial_positions[i] = {place.x(), place.y(), 0.0};
    }
    return mesh;
  }
  static material::Fabric fabric() {
    material::Fabric fabric = cloth::linearFabric(0.1);
    fabric.friction = 0.3;
    return fabric;
  }
  static cloth::ModelledEffects effects(double gravity) {
    cloth::ModelledEffects effects;
    effects.gravity = {0.0, 0.0, -gravity};
    effects.contacts = true;
    return effects;
  }

  bool step(double h) { return collision.step(cloth, integrator, state, h).accepted; }

  Vector3d momentum() const {
    Vector3d sum = cloth.momentum(state);
    for (const FreeBody& body : collision.bodies()) sum += body.momentum();
    return sum;
  }
  Vector3d angularMomentum() const {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
      sum += cloth.masses()[i] * state.positions[i].cross(state.velocities[i]);
    }
    for (const FreeBody& body : collision.bodies()) {
      sum += body.pose().translation().cross(body.momentum()) + body.angularMomentum();
    }
    return sum;
  }
  double energy() const {
    double sum = cloth.kineticEnergy(state) + cloth.potentialEnergy(state);
    for (const FreeBody& body : collision.bodies()) {
      sum += body.kineticEnergy() -
             cloth.effects().gravity.dot(body.pose().translation()) * body.mass();
    }
    return sum;
  }
};

class Masses : public testing::TestWithParam<double> {};

TEST_P(Masses, KeepMomentumAndMakeNoEnergyWhereTheyHitAFreeSheet) {
  cloth::StepSettings settings;
  settings.solver = linear::LinearSolverMethod::kCholesky;
  for (const int solves : {1, 3}) {
    settings.newton_iterations = solves;
    Sheet sheet({ball(GetParam(), {0.02, 0.01, 0.04}, {0.1, 0.0, -0.5})}, 0.0, settings);
    const Vector3d before = sheet.momentum();
    const double energy = sheet.energy();
    double least = energy;
    for (int i = 0; i < 40; ++i) {
      ASSERT_TRUE(sheet.step(0.0125));
      EXPECT_LT((sheet.momentum() - before).norm(), 1e-12 * before.norm()) << i << " " << solves;
      // One solve leaves to the next steps what 25 mm of a stiff cloth bring.
      if (solves > 1) {
        EXPECT_LE(sheet.energy(), least + 1e-9 * energy) << i;
      }
      least = std::min(least, sheet.energy());
    }
    EXPECT_GT(sheet.collision.bodies()[0].velocity()[2], -0.4999) << "it did not hit the sheet";
  }
}

TEST(RigidBodies, ExplicitStepsKeepMomentumAndAngularMomentum) {
  cloth::StepSettings settings;
  settings.method = cloth::IntegrationMethod::kTwoStepEuler;
  for (const bool penalty : {false, true}) {
    Sheet sheet({ball(0.004, {0.02, 0.01, 0.04}, {0.3, 0.0, -2.0})}, 0.0, settings);
    if (penalty) sheet.collision.setPenalty(50.0);
    const Vector3d before = sheet.momentum(), turning = sheet.angularMomentum();
    const double speed = sheet.collision.bodies()[0].velocity()[2];
    for (int i = 0; i < 500; ++i) ASSERT_TRUE(sheet.step(2e-4));
    EXPECT_LT((sheet.momentum() - before).norm(), 1e-11 * before.norm());
    EXPECT_LT((sheet.angularMomentum() - turning).norm(), 1e-11 * turning.norm());
    EXPECT_GT(sheet.collision.bodies()[0].velocity()[2], 0.5 * speed);
  }
}

TEST(RigidBodies, FallOnTheFloorAndRest) {
  const Obstacle floor{"floor", mesh::ObstacleBox{{2.0, 2.0, 0.1}}, placedAt({0.0, 0.0, -0.35})};
  Obstacle box{"box", mesh::ObstacleBox{{0.06, 0.04, 0.02}}, placedAt({0.5, 0.0, -0.2})};
  box.pose.linear() = Eigen::AngleAxisd(0.3, Vector3d(1.0, 2.0, 0.5).normalized()).matrix();
  box.body = mesh::ObstacleBody{0.1, Vector3d::Zero(), Vector3d::Zero(), 0.5};
  Sheet sheet({ball(0.1, {0.5, 0.5, -0.2}, Vector3d::Zero()), floor, box}, 9.81);
  const double start = sheet.energy();
  double least = start;
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(sheet.step(0.0125));
    // A box that tumbles over a corner goes along the chord of its arc, and is lifted out after.
    EXPECT_LE(sheet.energy(), least + 1e-3 * std::abs(start)) << i;
    least = std::min(least, sheet.energy());
  }
  for (const FreeBody& body : sheet.collision.bodies()) {
    EXPECT_LT(body.velocity().norm(), 1e-6) << body.pose().translation().transpose();
  }
  EXPECT_NEAR(sheet.collision.bodies()[0].pose().translation().z(), -0.3 + 0.03, 1e-9);
  EXPECT_NEAR(sheet.collision.bodies()[1].pose().translation().z(),
              -0.3 + 0.01 + ObstacleCollision::kOffset, 1e-5);
}

TEST(RigidBodies, RefuseWhatCannotHaveMass) {
  const auto refused = [](Obstacle obstacle, const std::string& what) {
    try {
      Sheet sheet({obstacle}, 9.81);
      FAIL() << what;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  Obstacle good = ball(0.1, {0.0, 0.0, 0.1}, Vector3d::Zero()), bad = good;
  for (const double mass : {0.0, -1.0, std::nan("")}) {
    bad.body->mass = mass;
    refused(bad, "must be finite and > 0");
  }
  bad = good;
  bad.shape = mesh::ObstacleCapsule{0.01, 0.1};
  refused(bad, "a sphere or a box");
  bad = good;
  bad.motion = mesh::ObstacleDrift{{1.0, 0.0, 0.0}};
  refused(bad, "no motion");
  bad = good;
  bad.body->friction = -1.0;
  refused(bad, "must be finite and >= 0");
  bad = good;
  bad.body->velocity.x() = std::nan("");
  refused(bad, "not finite");
  cloth::StepSettings settings;
  settings.method = cloth::IntegrationMethod::kTrBdf2;
  EXPECT_THROW(Sheet({good}, 9.81, settings), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(FromLightToHeavy, Masses, testing::Values(1e-5, 1e-3, 0.1, 10.0));

}  // namespace
}  // namespace haptex::contact::test_rigid_bodies
