#include "haptex/contact/bodies/placed_obstacle.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>

#include "haptex/contact/bodies/obstacle_path.h"

namespace haptex::contact {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

constexpr double kAcceleration = 50.0;  // m/s^2, that a body may have beside gravity

/// One by which `mover` may touch `wall`.
void findContact(const PlacedObstacle& mover, const Vector3d& point, const PlacedObstacle& wall,
                 double h, std::vector<cloth::BodyContact>& contacts) {
  const Vector3d begin = wall.begin.inverse(Eigen::Isometry) * (mover.begin * point);
  const Vector3d end = wall.end.inverse(Eigen::Isometry) * (mover.end * point);
  const double clearance = mover.clearance;
  const double reach = clearance + kAcceleration * h * h + (end - begin).norm();
  if (begin.norm() > wall.reach + reach) return;
  if (wall.shape.distance(begin).distance > reach) return;
  const Path path{begin, end};
  const Vector3d predicted = slidingEnd(wall.shape, path, firstTouch(wall.shape, path, clearance));
  const proximity::SurfaceDistance there = wall.shape.distance(predicted);
  if (!there.normal.allFinite()) return;
  const Vector3d on_wall = predicted - clearance * there.normal;
  const Vector3d normal = wall.end.linear() * there.normal;
  const Vector3d arm = mover.end.linear() * point - clearance * normal;
  const Vector3d wall_arm = wall.end.linear() * on_wall;
  cloth::BodyContact contact;
  contact.gap = there.normal.dot(begin - predicted) - (clearance - there.distance);
  contact.velocity.setZero();
  contact.friction = std::max(mover.body_friction, wall.body_friction);
  contact.other_arm.setZero();
  contact.other = -1;
  if (mover.body >= 0) {
    contact.body = mover.body;
    contact.normal = normal;
    contact.arm = arm;
    if (wall.body >= 0) {
      contact.other = wall.body;
      contact.other_arm = wall_arm;
      contact.friction = std::min(mover.body_friction, wall.body_friction);
    } else {
      contact.velocity = (wall.end * begin - wall.begin * begin) / h;
    }
  } else {
    contact.body = wall.body;
    contact.normal = -normal;
    contact.arm = wall_arm;
    contact.velocity = (mover.end * point - mover.begin * point) / h;
  }
  contacts.push_back(contact);
}

bool isPoint(const PlacedObstacle& obstacle) { return obstacle.points.size() == 1; }

/// Calls touch(mover, wall) for each that may touch another one with its points: of two, of which
/// one at least has mass, both, unless one is a sphere, whose centre says it all.
template <typename Touch>
void forEachMover(const std::vector<PlacedObstacle>& obstacles, const Touch& touch) {
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    for (std::size_t j = i + 1; j < obstacles.size(); ++j) {
      const PlacedObstacle& first = obstacles[i];
      const PlacedObstacle& second = obstacles[j];
      if (first.body < 0 && second.body < 0) continue;
      if (isPoint(first) || !isPoint(second)) touch(first, second);
      if (!isPoint(first)) touch(second, first);
    }
  }
}

}  // namespace

void setPoints(const mesh::Obstacle& obstacle, double offset, PlacedObstacle& placed) {
  placed.clearance = offset;
  if (const auto* sphere = std::get_if<mesh::ObstacleSphere>(&obstacle.shape)) {
    placed.points = {Vector3d::Zero()};
    placed.clearance = sphere->radius;
  } else if (const auto* box = std::get_if<mesh::ObstacleBox>(&obstacle.shape)) {
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3d signs(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0,
                           corner & 4 ? 1.0 : -1.0);
      placed.points.emplace_back(0.5 * signs.cwiseProduct(box->sides));
    }
  } else if (const auto* capsule = std::get_if<mesh::ObstacleCapsule>(&obstacle.shape)) {
    for (int i = -2; i <= 2; ++i) placed.points.emplace_back(0.0, 0.0, 0.25 * i * capsule->length);
    placed.clearance = capsule->radius;
  }
}

std::size_t mostBodyContacts(const std::vector<PlacedObstacle>& obstacles) {
  std::size_t most = 0;
  forEachMover(obstacles, [&](const PlacedObstacle& mover, const PlacedObstacle& /*wall*/) {
    most += mover.points.size();
  });
  return most;
}

void findBodyContacts(const std::vector<PlacedObstacle>& obstacles, double h,
                      std::vector<cloth::BodyContact>& contacts) {
  contacts.clear();
  forEachMover(obstacles, [&](const PlacedObstacle& mover, const PlacedObstacle& wall) {
    for (const Vector3d& point : mover.points) findContact(mover, point, wall, h, contacts);
  });
}

}  // namespace haptex::contact
