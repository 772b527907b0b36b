#include "haptex/contact/obstacles.h"

#include <variant>

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

RigidObstacle makeObstacle(const mesh::Obstacle& obstacle) {
  RigidObstacle made = std::visit(MakeShape{}, obstacle.shape);
  made.setPose(obstacle.pose);
  return made;
}

}  // namespace haptex::contact
