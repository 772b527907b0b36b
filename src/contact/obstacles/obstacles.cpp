#include "haptex/contact/obstacles/obstacles.h"

#include <cstddef>
#include <stdexcept>
#include <variant>

#include "haptex/base/quoted.h"

namespace haptex::contact {
namespace {

using proximity::RigidObstacle;

struct MakeShape {
  RigidObstacle operator()(const mesh::ObstacleSphere& sphere) const {
    return RigidObstacle::sphere(sphere.radius);
  }
  RigidObstacle operator()(const mesh::ObstacleBox& box) const {
    return RigidObstacle::box(box.sides);
  }
  RigidObstacle operator()(const mesh::ObstacleCapsule& capsule) const {
    return RigidObstacle::capsule(capsule.radius, capsule.length);
  }
  RigidObstacle operator()(const mesh::ObstacleMesh& mesh) const {
    return RigidObstacle::mesh(mesh.vertices, mesh.triangles);
  }
};

}  // namespace

RigidObstacle makeObstacle(const mesh::Obstacle& obstacle, double time) {
  RigidObstacle made = std::visit(MakeShape{}, obstacle.shape);
  made.setPose(time == 0.0 ? obstacle.pose : obstacle.poseAt(time));
  return made;
}

double frictionOn(const mesh::Obstacle& obstacle, const material::Fabric& fabric) {
  if (obstacle.friction) return *obstacle.friction;
  if (fabric.friction) return *fabric.friction;
  throw std::invalid_argument("obstacle " + base::quoted(obstacle.name) +
                              " has no friction and fabric " + base::quoted(fabric.name) +
                              " has none: add the key friction to one of them");
}

int firstTouching(const std::vector<std::array<int, 3>>& triangles,
                  const std::vector<Eigen::Vector3d>& places, const RigidObstacle& obstacle) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    const bool is_apart = obstacle.closestPoint({places[a], places[b], places[c]}).distance > 0.0;
    if (!is_apart) return static_cast<int>(t);
  }
  return -1;
}

}  // namespace haptex::contact
