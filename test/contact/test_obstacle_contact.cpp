#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fixtures.h"
#include "haptex/contact/obstacles/obstacle_collision.h"
#include "haptex/contact/obstacles/obstacles.h"

namespace haptex::contact::test_obstacle_contact {
namespace {

using base::Finger;
using Eigen::Vector3d;

constexpr double kOffset = ObstacleCollision::kOffset;

/// The small sample in the plane x = 0 lies on a plate whose face is at x = -kOffset.
mesh::Obstacle plate(double thickness = 0.02) {
  const Eigen::Isometry3d pose(Eigen::Translation3d(-kOffset - 0.5 * thickness, 0.0, -0.02));
  return {"plate", mesh::ObstacleBox{{thickness, 0.2, 0.2}}, pose};
}

cloth::ModelledEffects amongObstacles() {
  cloth::ModelledEffects effects;
  effects.viscosity = true;
  effects.contacts = true;
  return effects;
}

/// A layer with a patch in the middle of the small sample at rest.
class OnObstacles {
 public:
  explicit OnObstacles(std::vector<mesh::Obstacle> obstacles,
                       const material::Fabric& fabric = wool(),
                       const cloth::ModelledEffects& effects = amongObstacles())
      : fabric_(fabric), layer_(mesh_, fabric_, effects, {}, std::move(obstacles)) {
    layer_.exchange(
        layer_.preparePatch(trianglesAround(mesh_, {0.02, 0.02}, 0.015), nothingAttached(mesh_)));
    layer_.receive(mesh_.initial_positions, atRest(mesh_), 0.02);
  }

  const ContactLaw& law() const { return layer_.law(); }
  HapticLayer& layer() { return layer_; }
  const FingertipContact& press(const Fingertip& fingertip, int steps,
                                Finger finger = Finger::kIndex) {
    Fingertips fingertips;
    fingertips[finger] = fingertip;
    for (int i = 0; i < steps; ++i) layer_.step(fingertips);
    return layer_.contacts()[finger];
  }
  double lowest() const {
    double least = 1.0;
    for (const Vector3d& place : layer_.patch()->positions()) least = std::min(least, place.x());
    return least;
  }

 private:
  mesh::ClothMesh mesh_ = smallSample();
  material::Fabric fabric_;
  HapticLayer layer_;
};

/// N: of a rigid plate, the fabric and the pulp in series on every place under the fingertip:
/// depth = pressure / pulp stiffness + thickness strain(pressure), by bisection and the midpoint
/// rule.
double pressForce(const material::Compression& fabric, double radius, double depth) {
  const double pulp = PulpSettings().stiffness;
  const auto pressureAt = [&](double d) {
    double low = 0.0, high = 10.0;
    for (int i = 0; i < 80; ++i) {
      const double strain = 0.5 * (low + high);
      const double p = fabric.pressure.evaluate(strain).stress;
      (p / pulp + fabric.thickness * strain < d ? low : high) = strain;
    }
    return fabric.pressure.evaluate(low).stress;
  };
  double force = 0.0;
  constexpr int kRings = 400;
  const double widest = std::sqrt(2.0 * radius * depth);
  for (int i = 0; i < kRings; ++i) {
    const double r = (i + 0.5) / kRings * widest;
    const double d = depth - (radius - std::sqrt(radius * radius - r * r));
    if (d > 0.0) force += pressureAt(d) * 2.0 * M_PI * r * widest / kRings;
  }
  return force;
}

TEST(ObstacleContact, APressFeelsPulpAndTheWholeFabricBeforeThePlate) {
  for (const Finger finger : base::kFingers) {
    OnObstacles cloth({plate()});
    for (const double depth : {0.5e-3, 1e-3}) {
      const FingertipContact& felt =
          cloth.press(pressing(cloth.law(), kSmallSampleMiddle, depth), 200, finger);
      const double exact = pressForce(*wool().compression, 7.5e-3, depth);
      // 1 mm cells under a contact of some mm: 5 %; the finer oracle is scripts/validate table.
      EXPECT_NEAR(felt.force.x(), exact, 0.05 * exact) << depth;
      const Finger other = finger == Finger::kIndex ? Finger::kThumb : Finger::kIndex;
      EXPECT_FALSE(cloth.layer().contacts()[other].touching);
    }
  }
}

TEST(ObstacleContact, NothingIsFeltOfAnObstacleThatTheSceneDoesNotModelOrThatIsFar) {
  OnObstacles without({});
  mesh::Obstacle far = plate();
  far.pose.translation().x() -= 0.05;
  OnObstacles with({far});
  cloth::ModelledEffects alone = amongObstacles();
  alone.contacts = false;
  OnObstacles not_modelled({plate()}, wool(), alone);
  for (int i = 0; i < 20; ++i) {
    const Fingertip tip = pressing(without.law(), kSmallSampleMiddle, 1e-4 * i);
    const Vector3d force = without.press(tip, 5).force;
    EXPECT_EQ(with.press(tip, 5).force, force);
    EXPECT_EQ(not_modelled.press(tip, 5).force, force);
  }
}

TEST(ObstacleContact, APatchBeginsAmongObstaclesWhereTheyAreThen) {
  // At time 0 the plate is 1.5 mm before the sheet, which it has passed long before the patch.
  mesh::Obstacle passing = plate();
  passing.pose.translation().x() += 0.0215 + kOffset;
  passing.motion = mesh::ObstacleDrift{{-0.1, 0.0, 0.0}};
  const mesh::ClothMesh mesh = smallSample();
  HapticLayer layer(mesh, wool(), amongObstacles(), {}, {passing});
  layer.receive(mesh.initial_positions, atRest(mesh), 0.02, 1.0);
  layer.exchange(
      layer.preparePatch(trianglesAround(mesh, {0.02, 0.02}, 0.015), nothingAttached(mesh)));
  for (int i = 0; i < 5; ++i) layer.step({});
  EXPECT_FALSE(layer.patch()->touchesObstacle());
  for (const Vector3d& place : layer.patch()->positions()) EXPECT_NEAR(place.x(), 0.0, 1e-9);
}

TEST(ObstacleContact, AThinObstacleAndASurfaceLetNothingThrough) {
  const double x = -kOffset;
  const mesh::Obstacle surface = {
      "surface", mesh::ObstacleMesh{{{x, -1, -1}, {x, 1, -1}, {x, 0, 1}}, {{0, 1, 2}}},
      Eigen::Isometry3d::Identity()};
  std::vector<double> forces;
  for (const mesh::Obstacle& obstacle : {plate(), plate(1e-4), surface}) {
    OnObstacles cloth({obstacle});
    Fingertip tip = pressing(cloth.law(), kSmallSampleMiddle, 0.0);
    tip.velocity.x() = -2.0;
    for (int i = 0; i < 2; ++i) {
      tip.position.x() -= 2e-3;
      cloth.press(tip, 1);
    }
    tip.velocity.setZero();
    forces.push_back(cloth.press(tip, 50).force.x());
    EXPECT_GT(cloth.lowest(), -2.0 * kOffset) << obstacle.name;
  }
  EXPECT_GT(forces[0], 1.0);
  for (const double force : forces) EXPECT_NEAR(force, forces[0], 1e-3 * forces[0]);
}

TEST(ObstacleContact, AnObstacleThatMovesPushesThePatch) {
  mesh::Obstacle moving = plate();
  moving.motion = mesh::ObstacleDrift{{0.05, 0.0, 0.0}};  // m/s
  OnObstacles cloth({moving});
  const mesh::ClothMesh mesh = smallSample();
  cloth.layer().receive(mesh.initial_positions, atRest(mesh), 0.02, 0.02);
  for (int i = 0; i < 20; ++i) cloth.layer().step({});
  const Patch& patch = *cloth.layer().patch();
  for (int i = 0; i < patch.freeCount(); ++i) {
    if ((patch.positions()[i] - kSmallSampleMiddle).norm() > 4e-3) continue;
    // The rim, which stays, pulls it into the fabric's own thickness.
    EXPECT_NEAR(patch.positions()[i].x(), 1e-3, 1e-4);
  }
}

TEST(ObstacleContact, FrictionIsTheObstaclesOwnOrTheFabrics) {
  material::Fabric fabric = wool();
  mesh::Obstacle obstacle = plate();
  EXPECT_EQ(frictionOn(obstacle, fabric), *fabric.friction);
  obstacle.friction = 0.7;
  EXPECT_EQ(frictionOn(obstacle, fabric), 0.7);
}

TEST(ObstacleContact, AStateThatIsAtNoTimeIsRefused) {
  OnObstacles cloth({plate()});
  const mesh::ClothMesh mesh = smallSample();
  try {
    cloth.layer().receive(mesh.initial_positions, atRest(mesh), 0.02, NAN);
    ADD_FAILURE() << "not refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "the time of the state is nan s; it must be finite");
  }
}

}  // namespace
}  // namespace haptex::contact::test_obstacle_contact
