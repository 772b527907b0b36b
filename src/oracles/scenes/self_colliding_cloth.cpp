#include "haptex/oracles/scenes/self_colliding_cloth.h"

#include <algorithm>
#include <stdexcept>
#include <variant>

#include "haptex/contact/obstacles/obstacles.h"
#include "haptex/proximity/intersections.h"

namespace haptex::oracles {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using mesh::Obstacle;
using Set = SelfCollidingCloth::Set;

cloth::ModelledEffects effectsOf(const Set& set, const std::vector<material::Fabric>& fabrics) {
  cloth::ModelledEffects effects;
  effects.self_collision = true;
  effects.gravity = {0.0, 0.0, -set.gravity};
  effects.viscosity = true;
  effects.bending = std::all_of(fabrics.begin(), fabrics.end(),
                                [](const auto& fabric) { return fabric.bending.has_value(); });
  effects.contacts = !set.obstacles.empty();
  return effects;
}

}  // namespace

std::size_t countIntersections(const std::vector<Vector3d>& positions,
                               const std::vector<std::array<int, 3>>& triangles,
                               const Obstacle& obstacle, double time) {
  std::size_t count = 0;
  const Isometry3d pose = obstacle.poseAt(time);
  if (const auto* surface = std::get_if<mesh::ObstacleMesh>(&obstacle.shape)) {
    std::vector<Vector3d> all = positions;
    std::vector<std::array<int, 3>> both = triangles;
    const int first = static_cast<int>(positions.size());
    for (const Vector3d& vertex : surface->vertices) all.push_back(pose * vertex);
    for (const auto& [a, b, c] : surface->triangles) {
      both.push_back({a + first, b + first, c + first});
    }
    const int of_cloth = static_cast<int>(triangles.size());
    for (const proximity::TrianglePair& pair : proximity::intersectingTriangles(all, both)) {
      count += pair[0] < of_cloth && pair[1] >= of_cloth;
    }
    return count;
  }
  proximity::RigidObstacle solid = contact::makeObstacle(obstacle);
  solid.setPose(pose);
  for (const auto& [a, b, c] : triangles) {
    count += solid.closestPoint({positions[a], positions[b], positions[c]}).distance <= 0.0;
  }
  return count;
}

SelfCollidingCloth::SelfCollidingCloth(const Set& set, const std::vector<material::Fabric>& fabrics,
                                       const cloth::StepSettings& settings)
    : cloth(set.mesh, fabrics, effectsOf(set, fabrics)),
      state(cloth.initialState()),
      move_(set.move),
      obstacles_(set.obstacles),
      integrator_(cloth, settings) {
  if (!set.obstacles.empty()) collision_.emplace(cloth, set.obstacles);
  std::fill(state.velocities.begin(), state.velocities.end(), set.velocity);
}

double SelfCollidingCloth::energy() const {
  return cloth.potentialEnergy(state) + cloth.kineticEnergy(state);
}

std::size_t SelfCollidingCloth::intersections() const {
  const auto& triangles = cloth.mesh().triangles;
  std::size_t count = proximity::countIntersections(state.positions, triangles);
  for (const mesh::Obstacle& obstacle : obstacles_) {
    count += countIntersections(state.positions, triangles, obstacle, state.time);
  }
  return count;
}

cloth::StepReport SelfCollidingCloth::step(double h) {
  if (move_) move_(cloth, state, state.time + h);
  const cloth::StepReport report = collision_ ? collision_->step(cloth, integrator_, state, h)
                                              : integrator_.step(cloth, state, h);
  if (!report.accepted) throw std::runtime_error("a step was not accepted");
  return report;
}

}  // namespace haptex::oracles
