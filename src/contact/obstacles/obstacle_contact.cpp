#include "haptex/contact/obstacles/obstacle_contact.h"

#include <algorithm>
#include <utility>

#include "haptex/contact/obstacles/obstacle_collision.h"
#include "haptex/contact/obstacles/obstacles.h"

namespace haptex::contact {

using Eigen::Matrix3d;
using Eigen::Vector3d;

PlacedObstacles::PlacedObstacles(std::vector<mesh::Obstacle> obstacles,
                                 const std::vector<material::Fabric>& fabrics)
    : obstacles_(std::move(obstacles)) {
  const auto has_mass = [](const mesh::Obstacle& obstacle) { return obstacle.body.has_value(); };
  obstacles_.erase(std::remove_if(obstacles_.begin(), obstacles_.end(), has_mass),
                   obstacles_.end());
  for (const mesh::Obstacle& obstacle : obstacles_) {
    proximity::RigidObstacle shape = makeObstacle(obstacle);
    shape.setPose(Eigen::Isometry3d::Identity());
    std::vector<double> friction;
    for (const material::Fabric& fabric : fabrics) {
      friction.push_back(frictionOn(obstacle, fabric));
    }
    bodies_.push_back({std::move(shape), std::move(friction), obstacle.pose,
                       obstacle.pose.inverse(Eigen::Isometry)});
  }
}

void PlacedObstacles::moveTo(double time) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!obstacles_[i].moves()) continue;
    bodies_[i].pose = obstacles_[i].poseAt(time);
    bodies_[i].to_own = bodies_[i].pose.inverse(Eigen::Isometry);
  }
}

ObstacleContact::ObstacleContact(const PlacedObstacles& obstacles,
                                 const std::vector<material::Fabric>& fabrics,
                                 std::vector<std::uint8_t> of_particles, double sticking,
                                 std::size_t most_particles)
    : obstacles_(obstacles),
      of_particles_(std::move(of_particles)),
      sticking_(sticking),
      places_(obstacles.bodies().size() * most_particles),
      particles_(most_particles) {
  touched_.reserve(places_.size());
  for (const material::Fabric& fabric : fabrics) compressions_.push_back(*fabric.compression);
}

void ObstacleContact::clear() {
  std::fill(places_.begin(), places_.end(), Place());
  touched_.clear();
}

void ObstacleContact::adopt(int particle, const ObstacleContact& other, int other_particle) {
  for (std::size_t b = 0; b < obstacles_.bodies().size(); ++b) {
    places_[b * particles_ + particle] = other.places_[b * other.particles_ + other_particle];
  }
}

/// Whether a particle is within kTracked of an obstacle. What was farther away is asked for again
/// only when it has moved so far.
bool ObstacleContact::isNear(const PlacedObstacles::Body& body, const Vector3d& own, Place& place,
                             Nearest& nearest) const {
  if ((own - place.last).squaredNorm() < place.clearance * place.clearance) return false;
  const proximity::SurfaceDistance found = body.shape.distance(own);
  nearest = {found.distance, found.normal, own - found.distance * found.normal, true};
  if (place.tracked) {
    const double side = place.normal.dot(own - place.surface);
    if (side < 0.0 && found.normal.dot(place.normal) < 0.0) {
      nearest = {side, place.normal, place.surface, false};
      return true;
    }
  }
  place.last = own;
  place.clearance = std::max(0.0, found.distance - kTracked);
  return place.clearance == 0.0 && found.normal.allFinite();
}

bool ObstacleContact::touch(const PlacedObstacles::Body& body, const Nearest& nearest,
                            const Place& place, const Vector3d& own, double area,
                            TouchedParticle& result) const {
  result.depth = ObstacleCollision::kOffset - nearest.distance;
  if (!(result.depth > 0.0)) return false;
  const std::size_t fabric = fabricOf(result.particle);
  const material::Compression& compression = compressions_[fabric];
  const double half = 0.5 * compression.thickness;
  const material::CurveValue pressure = compression.pressure.evaluate(result.depth / half);
  result.normal = body.pose.linear() * nearest.normal;
  result.normal_force = std::max(0.0, area * pressure.stress);
  const Matrix3d along = result.normal * result.normal.transpose();
  result.stiffness = std::max(0.0, area * pressure.slope / half) * along;
  result.damping.setZero();
  const Vector3d anchored = place.holds ? Vector3d(body.pose.linear() * (own - place.anchor))
                                        : Vector3d(Vector3d::Zero());
  addFriction(anchored, area * sticking_, body.friction[fabric], result);
  return true;
}

template <typename Visit>
void ObstacleContact::visitAll(const Particles& particles, const Visit& visit) {
  for (std::size_t b = 0; b < obstacles_.bodies().size(); ++b) {
    const PlacedObstacles::Body& body = obstacles_.bodies()[b];
    for (int i = 0; i < particles.count; ++i) {
      const Vector3d own = body.to_own * particles.positions[i];
      visit(body, i, own, places_[b * particles_ + i]);
    }
  }
}

const std::vector<TouchedParticle>& ObstacleContact::evaluate(const Particles& particles) {
  touched_.clear();
  Nearest nearest;
  TouchedParticle touched;
  const auto add = [&](const PlacedObstacles::Body& body, int particle, const Vector3d& own,
                       Place& place) {
    if (!isNear(body, own, place, nearest)) return;
    touched.particle = particle;
    if (!touch(body, nearest, place, own, particles.areas[particle], touched)) return;
    touched_.push_back(touched);
  };
  visitAll(particles, add);
  return touched_;
}

void ObstacleContact::commit(const Particles& particles) {
  Nearest nearest;
  TouchedParticle touched;
  const auto remember = [&](const PlacedObstacles::Body& body, int particle, const Vector3d& own,
                            Place& place) {
    if (!isNear(body, own, place, nearest)) {
      place.tracked = place.holds = false;
      return;
    }
    const double area = particles.areas[particle];
    touched.particle = particle;
    const bool touches = touch(body, nearest, place, own, area, touched);
    if (nearest.on_side) {
      place.surface = nearest.surface;
      place.normal = nearest.normal;
    }
    place.tracked = true;
    if (touches && (!place.holds || touched.slips)) {
      // The spring that is left after the slip pulls with exactly the friction.
      place.anchor = own + body.to_own.linear() * touched.friction / (sticking_ * area);
    }
    place.holds = touches;
  };
  visitAll(particles, remember);
}

}  // namespace haptex::contact
