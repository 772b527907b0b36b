#include "haptex/contact/obstacles/obstacle_collision.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "haptex/base/quoted.h"
#include "haptex/base/require.h"
#include "haptex/cloth/forces/element_assembly.h"
#include "haptex/contact/bodies/obstacle_path.h"
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
                              std::to_string(triangle) + " of the cloth touches obstacle " +
                              base::quoted(name) + " at the start: it has to be outside");
}

/// Neither attached nor tied to others.
bool goesByItself(const cloth::Cloth& cloth, int particle) {
  return !cloth.attachments()[particle] && !cloth.ties().isTied(particle);
}

}  // namespace

ObstacleCollision::ObstacleCollision(cloth::Cloth& cloth, std::vector<mesh::Obstacle> obstacles,
                                     double start)
    : obstacles_(std::move(obstacles)), positions_(cloth.particleCount()) {
  for (const mesh::Obstacle& obstacle : obstacles_) addObstacle(cloth, obstacle, start);
  if (cloth.fabrics().size() > 1) shareFriction(cloth);
  if (!bodies_.empty()) addBodies(cloth);
  if (cloth.selfContact() != nullptr) {
    cloth.setObstacles(obstacles_);
    if (start != 0.0) cloth.moveObstacles(start, start);
  } else {
    contacts_.reserve(cloth.particleCount());
  }
}

void ObstacleCollision::addObstacle(const cloth::Cloth& cloth, const mesh::Obstacle& obstacle,
                                    double start) {
  RigidObstacle shape = makeObstacle(obstacle, start);
  if (cloth.selfContact() != nullptr) requireApart(cloth.mesh(), obstacle.name, shape);
  shape.setPose(Eigen::Isometry3d::Identity());
  const double reach = shape.boundingRadius() + kOffset;
  PlacedObstacle placed{std::move(shape), reach, obstacle.pose, obstacle.pose,
                        frictionOn(obstacle, cloth.fabric())};
  if (obstacle.body) {
    placed.body = static_cast<int>(bodies_.size());
    bodies_.emplace_back(obstacle);
    placed.body_friction = bodies_.back().friction();
  }
  placed_.push_back(std::move(placed));
}

void ObstacleCollision::shareFriction(const cloth::Cloth& cloth) {
  for (std::size_t f = 1; f < cloth.fabrics().size(); ++f) requireFriction(cloth.fabrics()[f]);
  const std::vector<cloth::MembraneElement> elements = cloth::restElements(cloth.mesh());
  const auto shared = [&](const auto& of_fabric) {
    return cloth::shareOut(elements, cloth.particleCount(), [&](std::size_t triangle) {
      return of_fabric(cloth.mesh().fabricOf(triangle));
    });
  };
  const std::vector<double> areas = shared([](int) { return 1.0; });
  first_share_ = shared([](int fabric) { return fabric == 0 ? 1.0 : 0.0; });
  // Where obstacles have their own, fabrics need none.
  other_friction_ = shared([&](int fabric) {
    return fabric == 0 ? 0.0 : cloth.fabrics()[fabric].friction.value_or(0.0);
  });
  for (std::size_t i = 0; i < areas.size(); ++i) {
    first_share_[i] /= areas[i];
    other_friction_[i] /= areas[i];
  }
}

/// Of the cloth on an obstacle.
double ObstacleCollision::frictionAt(int particle, std::size_t obstacle) const {
  const double friction = placed_[obstacle].friction;
  if (first_share_.empty() || obstacles_[obstacle].friction) return friction;
  return first_share_[particle] * friction + other_friction_[particle];
}

void ObstacleCollision::addBodies(cloth::Cloth& cloth) {
  if (cloth.selfContact() != nullptr) {
    throw std::invalid_argument(
        "self_collision is modelled, which knows no obstacles with mass: allowed is one of both");
  }
  if (bodies_.size() > kMostBodies) {
    base::refuse(bodies_.size(), " obstacles have mass; allowed are ", kMostBodies);
  }
  for (std::size_t i = 0; i < placed_.size(); ++i) setPoints(obstacles_[i], kOffset, placed_[i]);
  const std::size_t contacts = mostBodyContacts(placed_);
  rigid_.bodies.resize(bodies_.size());
  rigid_.contacts.reserve(contacts);
  motions_.resize(bodies_.size());
  alone_.emplace(bodies_.size(), contacts);
  momenta_ = velocities_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(6 * bodies_.size()));
  cloth.reserveBodies(bodies_.size(), contacts);
}

void ObstacleCollision::setPenalty(double stiffness) {
  if (!std::isfinite(stiffness) || !(stiffness > 0.0)) {
    base::refuse("penalty = ", stiffness, " N/m: allowed are finite numbers > 0");
  }
  penalty_ = stiffness;
  before_.resize(positions_.size());
  bodies_before_ = bodies_;
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
  placeObstacles(cloth, state.time, state.time + time_step);
  if (penalty_) pushOut(cloth, state, time_step);
  if (!bodies_.empty()) predictBodies(cloth.effects().gravity, time_step);
  findContacts(cloth, state, time_step);
  cloth.setContacts(contacts_, rigid_);
  std::copy(state.positions.begin(), state.positions.end(), positions_.begin());
  const cloth::StepReport report = integrator.step(cloth, state, time_step);
  if (!report.accepted) {
    if (penalty_) takeBack(state);
    return report;
  }
  if (!bodies_.empty()) moveBodies(cloth.effects().gravity, integrator.bodyMotions(), time_step);
  if (!penalty_) resolve(cloth, state, time_step);
  return report;
}

void ObstacleCollision::placeObstacles(const cloth::Cloth& cloth, double begin, double end) {
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    placed_[i].friction = frictionOn(obstacles_[i], cloth.fabric());
    if (placed_[i].body >= 0) {
      placed_[i].begin = placed_[i].end = bodies_[placed_[i].body].pose();
      continue;
    }
    placed_[i].begin = obstacles_[i].poseAt(begin);
    placed_[i].end = obstacles_[i].poseAt(end);
  }
}

/// As they would go without the cloth.
void ObstacleCollision::predictBodies(const Vector3d& gravity, double h) {
  for (PlacedObstacle& obstacle : placed_) {
    if (obstacle.body < 0) continue;
    const FreeBody& body = bodies_[obstacle.body];
    cloth::Twist free = body.velocity();
    free.head<3>() += h * gravity;
    rigid_.bodies[obstacle.body] = {body.mass(), body.inertia(), free, free};
    velocities_.segment<6>(static_cast<Eigen::Index>(6 * obstacle.body)) = free;
    obstacle.end = body.poseAfter(free, h);
  }
  findBodyContacts(placed_, h, rigid_.contacts);
  alone_->begin(rigid_, h);
  momenta_.noalias() = alone_->masses() * velocities_;
  velocities_ = alone_->solve(momenta_);
  momenta_.noalias() = alone_->masses() * velocities_;
  const Eigen::VectorXd& settled = alone_->settle(momenta_);
  for (PlacedObstacle& obstacle : placed_) {
    if (obstacle.body < 0) continue;
    const auto row = static_cast<Eigen::Index>(6 * obstacle.body);
    motions_[obstacle.body] = {velocities_.segment<6>(row), settled.segment<6>(row)};
    rigid_.bodies[obstacle.body].predicted = velocities_.segment<6>(row);
    obstacle.end = bodies_[obstacle.body].poseAfter(rigid_.bodies[obstacle.body].predicted, h);
  }
}

void ObstacleCollision::findContacts(const cloth::Cloth& cloth, const cloth::ClothState& state,
                                     double h) {
  contacts_.clear();
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    const int particle = static_cast<int>(i);
    if (!goesByItself(cloth, particle)) continue;
    findContact(state, particle, h);
  }
}

/// Paths are predicted with the velocity at the beginning of the step. Of a particle that could
/// touch several obstacles the one that it touches first counts, or else the nearest.
void ObstacleCollision::findContact(const cloth::ClothState& state, int particle, double h) {
  constexpr double kAcceleration = 50.0;  // m/s^2, that a particle may have beside its velocity
  const double margin = 2.0 * kOffset + kAcceleration * h * h;
  const Vector3d& position = state.positions[particle];
  double urgency = std::numeric_limits<double>::infinity();
  for (const PlacedObstacle& obstacle : placed_) {
    const Vector3d begin = obstacle.begin.inverse(Eigen::Isometry) * position;
    const Vector3d end =
        obstacle.end.inverse(Eigen::Isometry) * (position + h * state.velocities[particle]);
    const double reach = margin + (end - begin).norm();
    if (begin.norm() > obstacle.reach + reach) continue;
    if (obstacle.shape.distance(begin).distance > kOffset + reach) continue;
    const Path path{begin, end};
    const double touch = firstTouch(obstacle.shape, path, kOffset);
    const Vector3d predicted = slidingEnd(obstacle.shape, path, touch);
    const SurfaceDistance there = obstacle.shape.distance(predicted);
    const double urgency_here = touch <= 1.0 ? touch - 1.0 : there.distance;
    // Numbers may overflow where an explicit step has blown up.
    if (!(urgency_here < urgency) || !there.normal.allFinite()) continue;
    const bool first = urgency == std::numeric_limits<double>::infinity();
    urgency = urgency_here;
    cloth::ParticleContact contact;
    contact.particle = particle;
    contact.normal = obstacle.end.linear() * there.normal;
    contact.place = obstacle.end * begin;
    contact.gap = there.normal.dot(begin - predicted) - (kOffset - there.distance);
    contact.velocity = (contact.place - position) / h;
    contact.friction = frictionAt(particle, &obstacle - placed_.data());
    contact.end = state.time + h;
    contact.body = obstacle.body;
    if (obstacle.body >= 0) {
      const Vector3d on_surface = predicted - (there.distance - kOffset) * there.normal;
      contact.arm = obstacle.end.linear() * on_surface;
    }
    if (!first) contacts_.pop_back();
    contacts_.push_back(contact);
  }
}

/// Whether a body is so far from everything that nothing could touch it.
bool ObstacleCollision::isAlone(int body) const {
  return std::none_of(
             rigid_.contacts.begin(), rigid_.contacts.end(),
             [&](const auto& contact) { return contact.body == body || contact.other == body; }) &&
         std::none_of(contacts_.begin(), contacts_.end(),
                      [&](const auto& contact) { return contact.body == body; });
}

/// @param motions of an implicit step; empty: of the bodies alone
void ObstacleCollision::moveBodies(const Vector3d& gravity,
                                   const std::vector<cloth::BodyMotion>& motions, double h) {
  const std::vector<cloth::BodyMotion>& gone = motions.empty() ? motions_ : motions;
  for (PlacedObstacle& obstacle : placed_) {
    if (obstacle.body < 0) continue;
    FreeBody& body = bodies_[obstacle.body];
    if (isAlone(obstacle.body)) {
      body.fly(gravity, h);
    } else {
      body.move(gone[obstacle.body].way, h, gone[obstacle.body].end);
    }
    obstacle.end = body.pose();
  }
}

void ObstacleCollision::resolve(const cloth::Cloth& cloth, cloth::ClothState& state, double h) {
  constexpr int kRounds = 3;  // what leaves one obstacle may enter another
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (!goesByItself(cloth, static_cast<int>(i))) continue;
    bool moved = true;
    for (int round = 0; moved && round < kRounds; ++round) {
      moved = false;
      for (PlacedObstacle& obstacle : placed_) {
        moved = bringBack(cloth.masses()[i], positions_[i], h, obstacle, state.positions[i],
                          state.velocities[i]) ||
                moved;
      }
    }
  }
  cloth.ties().place(state.time, state.positions);
  cloth.ties().carry(state.time, state.velocities);
}

/// @param from m, where the particle has been
/// @return whether it had to be moved
bool ObstacleCollision::bringBack(double mass, const Vector3d& from, double h,
                                  PlacedObstacle& obstacle, Vector3d& position,
                                  Vector3d& velocity) {
  const Vector3d begin = obstacle.begin.inverse(Eigen::Isometry) * from;
  const Vector3d end = obstacle.end.inverse(Eigen::Isometry) * position;
  const double length = (end - begin).norm();
  if (begin.norm() > obstacle.reach + length) return false;
  const double distance = obstacle.shape.distance(begin).distance;
  if (distance > kOffset + length) return false;
  const Path path{begin, end};
  // What was that near at the beginning has nothing to be kept on a side of.
  const double touch = distance >= kUntouched ? firstTouch(obstacle.shape, path, kUntouched) : 2.0;
  const Vector3d place = slidingEnd(obstacle.shape, path, touch);
  const SurfaceDistance there = obstacle.shape.distance(place);
  if (!there.normal.allFinite()) return false;
  if (touch > 1.0 && there.distance >= kOffset - kTolerance) return false;
  const Vector3d outside = place + std::max(0.0, kOffset - there.distance) * there.normal;
  const Vector3d reached = obstacle.end * outside;
  const Vector3d way = reached - position, before = velocity;
  position = reached;
  stopAt(obstacle, mass, outside, obstacle.end.linear() * there.normal, h, velocity);
  if (obstacle.body < 0) return true;
  // The centre of mass of both stays, and so does the angular momentum about it.
  FreeBody& body = bodies_[obstacle.body];
  const Vector3d relative = before - body.momentum() / body.mass();
  body.shift(-mass / body.mass() * way, -mass * way.cross(relative));
  obstacle.end = body.pose();
  return true;
}

/// Takes out of a particle's velocity what leads into an obstacle, as an inelastic impact.
/// @param place m, in the obstacle's frame
void ObstacleCollision::stopAt(const PlacedObstacle& obstacle, double mass, const Vector3d& place,
                               const Vector3d& normal, double h, Vector3d& velocity) {
  if (obstacle.body < 0) {
    const Vector3d of_obstacle = (obstacle.end * place - obstacle.begin * place) / h;
    velocity -= std::min(0.0, normal.dot(velocity - of_obstacle)) * normal;
    return;
  }
  FreeBody& body = bodies_[obstacle.body];
  const Vector3d arm = body.pose().linear() * place;
  const double closing = normal.dot(velocity - cloth::velocityAt(body.velocity(), arm));
  if (!(closing < 0.0)) return;
  const double impulse = -closing / (1.0 / mass + body.mobility(normal, arm));
  velocity += impulse / mass * normal;
  body.push(-impulse * normal, arm);
}

/// What setPenalty() says, at the beginning of the step.
void ObstacleCollision::pushOut(const cloth::Cloth& cloth, cloth::ClothState& state, double h) {
  std::copy(state.velocities.begin(), state.velocities.end(), before_.begin());
  bodies_before_ = bodies_;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (!goesByItself(cloth, static_cast<int>(i))) continue;
    for (const PlacedObstacle& obstacle : placed_) {
      const Vector3d place = obstacle.begin.inverse(Eigen::Isometry) * state.positions[i];
      if (place.norm() > obstacle.reach) continue;
      const SurfaceDistance there = obstacle.shape.distance(place);
      if (!(there.distance < kOffset) || !there.normal.allFinite()) continue;
      const Vector3d normal = obstacle.begin.linear() * there.normal;
      const double mass = cloth.masses()[i];
      stopAt(obstacle, mass, place, normal, h, state.velocities[i]);
      const double impulse = h * *penalty_ * std::max(0.0, -there.distance);
      state.velocities[i] += impulse / mass * normal;
      if (obstacle.body < 0) continue;
      bodies_[obstacle.body].push(-impulse * normal, obstacle.begin.linear() * place);
    }
  }
  cloth.ties().carry(state.time, state.velocities);
}

/// What pushOut() did, as the step was not taken.
void ObstacleCollision::takeBack(cloth::ClothState& state) {
  std::copy(before_.begin(), before_.end(), state.velocities.begin());
  bodies_ = bodies_before_;
}

}  // namespace haptex::contact
