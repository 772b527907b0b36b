#include "haptex/contact/obstacles/start_outside.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <variant>

#include "haptex/contact/obstacles/obstacle_collision.h"
#include "haptex/contact/obstacles/obstacles.h"
#include "haptex/proximity/element_pair.h"

namespace haptex::contact {
namespace {

using Eigen::Vector3d;
using proximity::RigidObstacle;
using proximity::SurfaceDistance;
using Positions = std::vector<Vector3d>;

constexpr double kClearance = ObstacleCollision::kOffset;
constexpr double kEnough = 0.5 * kClearance;  // m, from an obstacle
// At least as many as let what was moved pull at what is farther away.
constexpr int kLeastPasses = 200, kMostPasses = 1000;

/// Of a closed surface around a place: 1 or -1 inside, 0 outside (sum of the triangles' solid
/// angles: van Oosterom and Strackee, IEEE Trans. Biomedical Engineering 30, 1983).
double windingNumber(const mesh::ObstacleMesh& surface, const Vector3d& place) {
  double sum = 0.0;
  for (const auto& [i, j, k] : surface.triangles) {
    const Vector3d a = surface.vertices[i] - place, b = surface.vertices[j] - place,
                   c = surface.vertices[k] - place;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2.0 * M_PI);
}

/// An obstacle at the start, and which side of it is the wrong one.
class Body {
 public:
  Body(const mesh::Obstacle& obstacle, double time)
      : shape_(makeObstacle(obstacle, time)),
        to_own_(shape_.pose().inverse()),
        surface_(std::get_if<mesh::ObstacleMesh>(&obstacle.shape)) {}

  const RigidObstacle& shape() const { return shape_; }

  /// Of a mesh, the wrong side is that on which fewer of these particles start.
  void start(const Positions& places) {
    starts_ = &places;
    if (surface_ == nullptr) return;
    for (const Vector3d& place : places) {
      encloses_start_.push_back(encloses(place));
      start_distances_.push_back(shape_.distance(place).distance);
    }
    const auto inside = std::count(encloses_start_.begin(), encloses_start_.end(), 1);
    outside_is_wrong_ = 2 * inside > static_cast<std::ptrdiff_t>(places.size());
  }

  /// Negative on the wrong side, with the normal away from it.
  SurfaceDistance distance(const Vector3d& place) const {
    const SurfaceDistance found = shape_.distance(place);
    return surface_ == nullptr ? found : onSide(encloses(place), found);
  }

  /// Of a particle that has got there. It is on the side of its start as long as it is not as far
  /// away from there as the surface.
  SurfaceDistance distance(std::size_t particle, const Vector3d& place) const {
    const SurfaceDistance found = shape_.distance(place);
    if (surface_ == nullptr) return found;
    const bool may_have_crossed =
        (place - (*starts_)[particle]).norm() >= start_distances_[particle];
    return onSide(may_have_crossed ? encloses(place) : encloses_start_[particle] != 0, found);
  }

 private:
  SurfaceDistance onSide(bool inside, const SurfaceDistance& found) const {
    if (inside == outside_is_wrong_) return found;
    return {-found.distance, -found.normal};
  }
  bool encloses(const Vector3d& place) const {
    return std::abs(windingNumber(*surface_, to_own_ * place)) > 0.5;
  }

  RigidObstacle shape_;
  Eigen::Isometry3d to_own_;
  const mesh::ObstacleMesh* surface_;  // null of a solid
  bool outside_is_wrong_ = false;
  // Of the particles at their starts.
  const Positions* starts_ = nullptr;
  std::vector<char> encloses_start_;
  std::vector<double> start_distances_;  // m, to the surface
};

/// Particles on their way out.
class Mover {
 public:
  Mover(const mesh::ClothMesh& mesh, const std::vector<int>& held)
      : triangles_(mesh.triangles),
        edges_(proximity::MeshElements(mesh.triangles).edges),
        places_(mesh.initial_positions),
        distances_(places_.size()),
        is_held_(places_.size()) {
    for (const int particle : held) is_held_[particle] = 1;
    for (const auto& [a, b] : edges_) lengths_.push_back((places_[b] - places_[a]).norm());
  }

  const Positions& places() const { return places_; }

  /// @return whether nothing was too near
  bool passOut(const Body& body) {
    bool free = true;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const SurfaceDistance found = body.distance(i, places_[i]);
      distances_[i] = std::max(found.distance, kClearance);
      if (found.distance >= kClearance) continue;
      free = free && found.distance >= kEnough;
      if (is_held_[i] == 0) places_[i] += (kClearance - found.distance) * found.normal;
    }
    for (const auto& corners : triangles_) {
      const auto& [a, b, c] = corners;
      const double size =
          std::max((places_[b] - places_[a]).norm(), (places_[c] - places_[a]).norm());
      if (distances_[a] - size >= kClearance) continue;  // the whole triangle is within that of a
      const proximity::TrianglePoint nearest =
          body.shape().closestPoint({places_[a], places_[b], places_[c]});
      if (nearest.distance >= kClearance) continue;
      free = free && nearest.distance >= kEnough;
      moveOut(body, corners, nearest);
    }
    return free;
  }

  /// One sweep over all edges, half of what is missing each.
  void keepLengths() {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const auto& [a, b] = edges_[e];
      const double movable = (is_held_[a] == 0) + (is_held_[b] == 0);
      const Vector3d along = places_[b] - places_[a];
      const double length = along.norm();
      if (movable == 0.0 || length == 0.0 || length == lengths_[e]) continue;
      const Vector3d correction = (1.0 - lengths_[e] / length) / movable * along;
      if (is_held_[a] == 0) places_[a] += correction;
      if (is_held_[b] == 0) places_[b] -= correction;
    }
  }

 private:
  /// The corners share the way of their nearest point by its weights.
  void moveOut(const Body& body, const std::array<int, 3>& corners,
               const proximity::TrianglePoint& nearest) {
    const auto& [a, b, c] = corners;
    const Vector3d& w = nearest.barycentric;
    const Vector3d place = w[0] * places_[a] + w[1] * places_[b] + w[2] * places_[c];
    const SurfaceDistance found = body.distance(place);
    const Vector3d way = (kClearance - found.distance) / w.squaredNorm() * found.normal;
    for (int i = 0; i < 3; ++i) {
      if (is_held_[corners[i]] == 0) places_[corners[i]] += w[i] * way;
    }
  }

  const std::vector<std::array<int, 3>>& triangles_;
  std::vector<proximity::Edge> edges_;
  Positions places_;               // m
  std::vector<double> lengths_;    // m, of edges at the start
  std::vector<double> distances_;  // m, of particles from the body of this pass
  std::vector<char> is_held_;
};

bool areApart(const std::vector<Body>& bodies, const mesh::ClothMesh& mesh,
              const Positions& places) {
  return std::all_of(bodies.begin(), bodies.end(), [&](const Body& body) {
    return firstTouching(mesh.triangles, places, body.shape()) < 0;
  });
}

}  // namespace

StartMove moveOutside(mesh::ClothMesh& mesh, const std::vector<mesh::Obstacle>& obstacles,
                      const std::vector<int>& held, double start) {
  StartMove move;
  std::vector<Body> touched, others;
  for (const mesh::Obstacle& obstacle : obstacles) {
    Body body(obstacle, start);
    const int triangle = firstTouching(mesh.triangles, mesh.initial_positions, body.shape());
    if (triangle < 0) {
      others.push_back(std::move(body));
      continue;
    }
    if (move.triangle < 0) {
      move.triangle = triangle;
      move.obstacle = obstacle.name;
    }
    body.start(mesh.initial_positions);
    touched.push_back(std::move(body));
  }
  if (touched.empty()) return move;

  Mover mover(mesh, held);
  bool free = false;
  for (int pass = 0; pass < kMostPasses && (!free || pass < kLeastPasses); ++pass) {
    mover.keepLengths();
    free = true;
    for (const Body& body : touched) free = mover.passOut(body) && free;
  }
  const Positions& outside = mover.places();
  if (!free || !areApart(touched, mesh, outside) || !areApart(others, mesh, outside)) return move;
  for (std::size_t i = 0; i < outside.size(); ++i) {
    const double way = (outside[i] - mesh.initial_positions[i]).norm();
    move.particles += way > 0.0;
    move.longest = std::max(move.longest, way);
  }
  mesh.initial_positions = outside;
  return move;
}

}  // namespace haptex::contact
