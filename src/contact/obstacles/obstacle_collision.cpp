#include "haptex/contact/obstacles/obstacle_collision.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "haptex/contact/obstacles/obstacles.h"

namespace haptex::contact {
namespace {

using Eigen::Vector3d;
using proximity::RigidObstacle;
using proximity::SurfaceDistance;

constexpr double kOffset = ObstacleCollision::kOffset;
constexpr double kUntouched = 0.5 * kOffset;  // m, from here on a path has hit the surface

/// Of a cloth that collides with itself.
void requireApart(const mesh::ClothMesh& mesh, const std::string& name,
                  const RigidObstacle& shape) {
  const int triangle = firstTouching(mesh.triangles, mesh.initial_positions, shape);
  if (triangle < 0) return;
  throw std::invalid_argument("self_collision is modelled and triangle " +
                              std::to_string(triangle) + " of the cloth touches obstacle '" + name +
                              "' at the start: it has to be outside");
}

/// A straight path in the frame of an obstacle.
struct Path {
  const Vector3d& begin;
  const Vector3d& end;
};

/// How far along a path, from 0 to 1, something is nearer to the surface than a clearance > 0; 2 if
/// nowhere. Steps as long as the distance allows (sphere tracing), and at least a quarter of the
/// clearance, which does not lead through a surface, or a 1e-5 of a path longer than 10 m or so.
double firstTouch(const RigidObstacle& shape, const Path& path, double clearance) {
  const double length = (path.end - path.begin).norm();
  const double least = std::max(0.25 * clearance, 1e-5 * length);
  double way = 0.0;
  while (true) {
    const double share = length > 0.0 ? std::min(1.0, way / length) : 1.0;
    const double distance = shape.distance(path.begin + share * (path.end - path.begin)).distance;
    if (distance < clearance) return length > 0.0 ? share : 0.0;
    if (share >= 1.0) return 2.0;
    way += std::max(distance - clearance, least);
  }
}

/// Where a path ends that slides along the tangent plane from where it touches.
Vector3d slidingEnd(const RigidObstacle& shape, const Path& path, double touch) {
  if (touch > 1.0) return path.end;
  const Vector3d hit = path.begin + touch * (path.end - path.begin);
  const Vector3d normal = shape.distance(hit).normal;
  return path.end + std::max(0.0, normal.dot(hit - path.end)) * normal;
}

}  // namespace

ObstacleCollision::ObstacleCollision(cloth::Cloth& cloth, std::vector<mesh::Obstacle> obstacles,
                                     double start)
    : obstacles_(std::move(obstacles)), positions_(cloth.particleCount()) {
  for (const mesh::Obstacle& obstacle : obstacles_) {
    RigidObstacle shape = makeObstacle(obstacle, start);
    if (cloth.selfContact() != nullptr) requireApart(cloth.mesh(), obstacle.name, shape);
    shape.setPose(Eigen::Isometry3d::Identity());
    const double reach = shape.boundingRadius() + kOffset;
    bodies_.push_back({std::move(shape), reach, obstacle.pose, obstacle.pose,
                       frictionOn(obstacle, cloth.fabric())});
  }
  if (cloth.selfContact() != nullptr) {
    cloth.setObstacles(obstacles_);
    if (start != 0.0) cloth.moveObstacles(start, start);
  } else {
    contacts_.reserve(cloth.particleCount());
  }
}

void ObstacleCollision::requireFriction(const material::Fabric& fabric) const {
  for (const mesh::Obstacle& obstacle : obstacles_) frictionOn(obstacle, fabric);
}

cloth::StepReport ObstacleCollision::step(cloth::Cloth& cloth, cloth::Integrator& integrator,
                                          cloth::ClothState& state, double time_step) {
  if (cloth.selfContact() != nullptr) {
    cloth.moveObstacles(state.time, state.time + time_step);
    return integrator.step(cloth, state, time_step);
  }
  placeBodies(cloth, state.time, state.time + time_step);
  findContacts(cloth, state, time_step);
  cloth.setContacts(contacts_);
  std::copy(state.positions.begin(), state.positions.end(), positions_.begin());
  const cloth::StepReport report = integrator.step(cloth, state, time_step);
  if (report.accepted) resolve(cloth, state, time_step);
  return report;
}

void ObstacleCollision::placeBodies(const cloth::Cloth& cloth, double begin, double end) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    bodies_[i].begin = obstacles_[i].poseAt(begin);
    bodies_[i].end = obstacles_[i].poseAt(end);
    bodies_[i].friction = frictionOn(obstacles_[i], cloth.fabric());
  }
}

/// Paths are predicted with the velocity at the beginning of the step. Of a particle that could
/// touch several obstacles the one that it touches first counts, or else the nearest.
void ObstacleCollision::findContacts(const cloth::Cloth& cloth, const cloth::ClothState& state,
                                     double h) {
  constexpr double kAcceleration = 50.0;  // m/s^2, that a particle may have beside its velocity
  contacts_.clear();
  const double margin = 2.0 * kOffset + kAcceleration * h * h;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (cloth.attachments()[i]) continue;
    double urgency = std::numeric_limits<double>::infinity();
    for (const Body& body : bodies_) {
      const Vector3d begin = body.begin.inverse(Eigen::Isometry) * state.positions[i];
      const Vector3d end =
          body.end.inverse(Eigen::Isometry) * (state.positions[i] + h * state.velocities[i]);
      const double reach = margin + (end - begin).norm();
      if (begin.norm() > body.reach + reach) continue;
      if (body.shape.distance(begin).distance > kOffset + reach) continue;
      const Path path{begin, end};
      const double touch = firstTouch(body.shape, path, kOffset);
      const Vector3d predicted = slidingEnd(body.shape, path, touch);
      const SurfaceDistance there = body.shape.distance(predicted);
      const double urgency_here = touch <= 1.0 ? touch - 1.0 : there.distance;
      // Numbers may overflow where an explicit step has blown up.
      if (!(urgency_here < urgency) || !there.normal.allFinite()) continue;
      const bool first = urgency == std::numeric_limits<double>::infinity();
      urgency = urgency_here;
      cloth::ParticleContact contact;
      contact.particle = static_cast<int>(i);
      contact.normal = body.end.linear() * there.normal;
      contact.place = body.end * begin;
      contact.gap = there.normal.dot(begin - predicted) - (kOffset - there.distance);
      contact.velocity = (contact.place - state.positions[i]) / h;
      contact.friction = body.friction;
      contact.end = state.time + h;
      if (!first) contacts_.pop_back();
      contacts_.push_back(contact);
    }
  }
}

void ObstacleCollision::resolve(const cloth::Cloth& cloth, cloth::ClothState& state,
                                double h) const {
  constexpr int kRounds = 3;  // what leaves one obstacle may enter another
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (cloth.attachments()[i]) continue;
    bool moved = true;
    for (int round = 0; moved && round < kRounds; ++round) {
      moved = false;
      for (const Body& body : bodies_) {
        const Vector3d begin = body.begin.inverse(Eigen::Isometry) * positions_[i];
        const Vector3d end = body.end.inverse(Eigen::Isometry) * state.positions[i];
        const double length = (end - begin).norm();
        if (begin.norm() > body.reach + length) continue;
        const double distance = body.shape.distance(begin).distance;
        if (distance > kOffset + length) continue;
        const Path path{begin, end};
        // What was that near at the beginning has nothing to be kept on a side of.
        const double touch =
            distance >= kUntouched ? firstTouch(body.shape, path, kUntouched) : 2.0;
        const Vector3d place = slidingEnd(body.shape, path, touch);
        const SurfaceDistance there = body.shape.distance(place);
        if (!there.normal.allFinite()) continue;
        if (touch > 1.0 && there.distance >= kOffset - kTolerance) continue;
        const Vector3d outside = place + std::max(0.0, kOffset - there.distance) * there.normal;
        const Vector3d normal = body.end.linear() * there.normal;
        const Vector3d velocity = (body.end * outside - body.begin * outside) / h;
        state.positions[i] = body.end * outside;
        state.velocities[i] -= std::min(0.0, normal.dot(state.velocities[i] - velocity)) * normal;
        moved = true;
      }
    }
  }
}

}  // namespace haptex::contact
