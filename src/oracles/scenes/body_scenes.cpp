#include "haptex/oracles/scenes/body_scenes.h"

#include <utility>

#include "haptex/base/constants.h"
#include "haptex/material/linear_fabric.h"

namespace haptex::oracles {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using mesh::Obstacle;

}  // namespace

Obstacle ballOf(double mass, double radius, const Vector3d& place, const Vector3d& velocity,
                double friction) {
  Obstacle ball{"ball", mesh::ObstacleSphere{radius}, placedAt(place)};
  ball.body = mesh::ObstacleBody{mass, velocity, Vector3d::Zero(), friction};
  ball.friction = 0.3;
  return ball;
}

CollidingCloth bodiesAlone(std::vector<Obstacle> obstacles, double gravity) {
  for (Obstacle& obstacle : obstacles) obstacle.friction = obstacle.friction.value_or(0.0);
  return {flatSheet({0.01, 0.01}, 1, 1, placedAt({0.0, 0.0, 50.0})),
          material::linearFabric(100.0),
          gravity,
          {},
          std::move(obstacles)};
}

double accelerationDown(Obstacle body, double half_height, double angle) {
  constexpr double kStep = 0.0125;  // s
  const Isometry3d pose(Eigen::AngleAxisd(angle, Vector3d::UnitY()));
  const Obstacle incline{"incline", mesh::ObstacleBox{{10.0, 1.0, 0.1}}, pose};
  body.pose = pose;
  body.pose.translation() = (0.05 + half_height) * pose.linear().col(2);
  CollidingCloth scene = bodiesAlone({incline, body}, base::kStandardGravity);
  const Vector3d down = pose.linear().col(0);
  for (int i = 0; i < 20; ++i) scene.step(kStep);
  const double before = down.dot(scene.collision.bodies()[0].velocity().head<3>());
  for (int i = 0; i < 20; ++i) scene.step(kStep);
  return (down.dot(scene.collision.bodies()[0].velocity().head<3>()) - before) / (20 * kStep);
}

}  // namespace haptex::oracles
