#include "haptex/oracles/scenes/obstacle_scenes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "haptex/base/constants.h"
#include "haptex/contact/obstacles/obstacles.h"
#include "haptex/material/linear_fabric.h"

namespace haptex::oracles {
namespace {

using contact::ObstacleCollision;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using mesh::ClothMesh;
using mesh::Obstacle;

cloth::ModelledEffects effectsOf(const material::Fabric& fabric, double gravity) {
  cloth::ModelledEffects effects;
  effects.gravity = {0.0, 0.0, -gravity};
  effects.viscosity = true;
  effects.contacts = true;
  effects.bending = fabric.bending.has_value();
  return effects;
}

Vector3d mean(const std::vector<Vector3d>& vectors) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& vector : vectors) sum += vector;
  return sum / static_cast<double>(vectors.size());
}

}  // namespace

ClothMesh flatSheet(const Eigen::Vector2d& size, int cells_u, int cells_v, const Isometry3d& pose) {
  ClothMesh mesh =
      mesh::makeRectangle(size.x(), size.y(), cells_u, cells_v, mesh::Triangulation::kAlternating);
  for (std::size_t i = 0; i < mesh.initial_positions.size(); ++i) {
    const Eigen::Vector2d from_middle = mesh.rest_coordinates[i] - 0.5 * size;
    mesh.initial_positions[i] = pose * Vector3d(from_middle.x(), from_middle.y(), 0.0);
  }
  return mesh;
}

Isometry3d placedAt(const Vector3d& place) { return Isometry3d(Eigen::Translation3d(place)); }

mesh::Obstacle floorAt(double height) {
  return {"floor", mesh::ObstacleBox{{2.0, 2.0, 0.1}}, placedAt({0.0, 0.0, height - 0.05})};
}

CollidingCloth::CollidingCloth(ClothMesh mesh, const material::Fabric& fabric, double gravity,
                               const cloth::StepSettings& settings, std::vector<Obstacle> obstacles)
    : cloth(std::move(mesh), fabric, effectsOf(fabric, gravity)),
      state(cloth.initialState()),
      collision(cloth, std::move(obstacles)),
      integrator(cloth, settings) {}

cloth::StepReport CollidingCloth::step(double h) {
  const cloth::StepReport report = collision.step(cloth, integrator, state, h);
  if (!report.accepted) throw std::runtime_error("a step was not accepted");
  return report;
}

Vector3d CollidingCloth::contactForce() const {
  Vector3d sum = Vector3d::Zero();
  for (const cloth::ContactReaction& reaction : integrator.contactReactions()) {
    sum += reaction.force;
  }
  return sum;
}

double CollidingCloth::leastDistance() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Obstacle& obstacle : collision.obstacles()) {
    proximity::RigidObstacle shape = contact::makeObstacle(obstacle);
    shape.setPose(obstacle.poseAt(state.time));
    for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
      if (cloth.attachments()[i]) continue;
      least = std::min(least, shape.distance(state.positions[i]).distance);
    }
  }
  return least;
}

InclineOutcome slideDown(double angle, double friction, cloth::IntegrationMethod method, double h) {
  Isometry3d pose(Eigen::AngleAxisd(angle, Vector3d::UnitY()));
  Obstacle incline{"incline", mesh::ObstacleBox{{10.0, 1.0, 0.1}}, pose};
  incline.friction = friction;
  Isometry3d on_top = pose;
  on_top.translation() = (0.05 + ObstacleCollision::kOffset) * pose.linear().col(2);
  cloth::StepSettings settings;
  settings.method = method;
  CollidingCloth scene(flatSheet({0.1, 0.1}, 8, 8, on_top), material::linearFabric(1000.0, 1.0),
                       base::kStandardGravity, settings, {incline});
  const Vector3d down = pose.linear().col(0);
  const auto way = [&] { return down.dot(mean(scene.state.positions)); };
  const auto speed = [&] { return down.dot(mean(scene.state.velocities)); };
  const double start = way();
  const int quarter = static_cast<int>(std::lround(0.25 / h));
  for (int i = 0; i < quarter; ++i) scene.step(h);
  const double speed_before = speed();
  for (int i = 0; i < quarter; ++i) scene.step(h);
  return {way() - start, (speed() - speed_before) / (quarter * h)};
}

}  // namespace haptex::oracles
