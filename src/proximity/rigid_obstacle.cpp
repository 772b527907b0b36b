#include "haptex/proximity/rigid_obstacle.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/detail/traversal/distance/bvh_shape_distance_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/traversal_recurse.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "haptex/proximity/kdop_hierarchy.h"
#include "haptex/proximity/triangle_pair.h"

namespace haptex::proximity {
namespace {

using Eigen::Vector3d;

constexpr double kRigid = 1e-9;  // of the entries of R^T R - I

[[noreturn]] void refuse(const std::string& what, double value, const std::string& allowed) {
  std::ostringstream message;
  message << what << " is " << value << ", must be " << allowed;
  throw std::invalid_argument(message.str());
}

void requireLength(const std::string& what, double value, bool may_be_zero) {
  const bool in_range = (value > 0.0 || (may_be_zero && value == 0.0)) && value <= kMaxLength;
  if (!in_range) refuse(what, value, std::string(may_be_zero ? ">= 0" : "> 0") + " and <= 1e9 m");
}

// The triangle of an FCL model that is nearest to a given one, by FCL's traversal of its boxes.
//
// FCL 0.7 could answer for each shape itself, but not to 1e-9 m. Measured against exact results on
// shapes and triangles of 1 mm to 1 m, largest error of
//   GJK of libccd, tolerance 1e-10: capsule 0.4 um (1 case in 70 above 1 nm)
//   GJK of its own, tolerance 1e-12: box 5 mm
//   sphere and triangle: 2.6 m if the triangle has no area (collisions are reported far away)
//   two triangles (BVHModel): 0.9 m where corners lie on a grid, as on a box beside a sheet (1 case
//     in 14000), 79 um with nearly parallel edges that nearly touch, 70 um below 0.2 mm
// So FCL finds which triangles have to be looked at, and triangle_pair.h tells how far they are.
class NearestTriangle : public fcl::detail::BVHShapeDistanceTraversalNode<fcl::AABBd, Triangle> {
 public:
  NearestTriangle(const fcl::BVHModel<fcl::AABBd>& model, const Triangle& triangle)
      : triangle_(triangle) {
    model1 = &model;
    corners_ = model.tri_indices;
    model2_bv = fcl::AABBd(triangle[0], triangle[1], triangle[2]);
  }

  /// The triangle that it is the nearest to.
  const fcl::Triangle& corners() const { return *corners_; }

  TrianglePoint find() {
    fcl::detail::distanceRecurse<double>(this, 0, 0, nullptr);
    return nearest_;
  }

  void leafTesting(int node, int) const override {
    const fcl::Triangle& corners = model1->tri_indices[model1->getBV(node).primitiveId()];
    const Vector3d* const places = model1->vertices;
    const TrianglePoint point = proximity::closestPoint(
        triangle_, Triangle{places[corners[0]], places[corners[1]], places[corners[2]]});
    if (point.distance >= nearest_.distance) return;
    nearest_ = point;
    corners_ = &corners;
  }

  bool canStop(double distance) const override { return distance >= nearest_.distance; }

 private:
  const Triangle& triangle_;
  mutable TrianglePoint nearest_{std::numeric_limits<double>::infinity(), Vector3d::UnitX()};
  mutable const fcl::Triangle* corners_;
};

/// Of a box around the origin.
SurfaceDistance distanceToBox(const Vector3d& half_sides, const Vector3d& place) {
  const Vector3d beyond = place.cwiseAbs() - half_sides;
  const Vector3d outside = beyond.cwiseMax(0.0);
  const auto with_signs = [&](const Vector3d& direction) {
    return Vector3d(direction.array() * (place.array() < 0.0).select(-1.0, Eigen::Array3d::Ones()));
  };
  const double distance = outside.norm();
  if (distance > 0.0) return {distance, with_signs(outside / distance)};
  int axis = 0;
  const double depth = beyond.maxCoeff(&axis);
  return {depth, with_signs(Vector3d::Unit(axis))};
}

class ObstacleBody : public Body {
 public:
  explicit ObstacleBody(const RigidObstacle& obstacle) : obstacle_(obstacle) {}

  int parts() const override { return 1; }
  double least(int, const Vector3d& normal) const override { return -obstacle_.support(-normal); }
  NearElement near(int index, const Triangle& triangle) const override {
    const TrianglePoint point = obstacle_.closestPoint(triangle);
    return {index, 0, point.distance, point.on(triangle), point.barycentric, unitNormal(triangle)};
  }

 private:
  const RigidObstacle& obstacle_;
};

}  // namespace

// What is within `radius` of some triangles, and for a box what is inside of them. The triangle of
// a sphere is a point, that of a capsule a segment.
struct RigidObstacle::Shape {
  Shape(const std::vector<Vector3d>& vertices, const std::vector<std::array<int, 3>>& triangles,
        double swept_radius)
      : radius(swept_radius) {
    std::vector<fcl::Triangle> model_triangles;
    std::vector<bool> used(vertices.size(), false);
    for (const auto& triangle : triangles) {
      model_triangles.emplace_back(triangle[0], triangle[1], triangle[2]);
      for (const int vertex : triangle) used[vertex] = true;
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (!used[i]) continue;
      corners.push_back(vertices[i]);
      reach = std::max(reach, vertices[i].cwiseAbs().maxCoeff() + radius);
    }
    model.beginModel();
    model.addSubModel(vertices, model_triangles);
    model.endModel();
  }

  /// The point of the triangles that is nearest to a place.
  Vector3d nearest(const Vector3d& place) const {
    if (corners.size() == 1) return corners[0];
    if (corners.size() == 2) {
      const Vector3d along = corners[1] - corners[0];
      const double length = along.squaredNorm();
      const double share = length > 0.0 ? (place - corners[0]).dot(along) / length : 0.0;
      return corners[0] + std::min(1.0, std::max(0.0, share)) * along;
    }
    const Triangle point = {place, place, place};
    NearestTriangle search(model, point);
    search.find();
    const fcl::Triangle& found = search.corners();
    const Triangle triangle = {model.vertices[found[0]], model.vertices[found[1]],
                               model.vertices[found[2]]};
    return proximity::closestPoint(triangle, place).on(triangle);
  }

  fcl::BVHModel<fcl::AABBd> model;
  std::vector<Vector3d> corners;       // of the triangles, each once
  double radius;                       // m
  double reach = 0.0;                  // m, largest coordinate
  std::optional<Vector3d> half_sides;  // of a box
};

RigidObstacle::RigidObstacle(std::shared_ptr<const Shape> shape) : shape_(std::move(shape)) {}

RigidObstacle RigidObstacle::sphere(double radius) {
  requireLength("the radius of a sphere", radius, false);
  using Triangles = std::vector<std::array<int, 3>>;
  return RigidObstacle(std::make_shared<Shape>(std::vector<Vector3d>{Vector3d::Zero()},
                                               Triangles{{0, 0, 0}}, radius));
}

RigidObstacle RigidObstacle::capsule(double radius, double length) {
  requireLength("the radius of a capsule", radius, false);
  requireLength("the length of a capsule", length, true);
  const Vector3d end(0.0, 0.0, length / 2.0);
  using Triangles = std::vector<std::array<int, 3>>;
  return RigidObstacle(
      std::make_shared<Shape>(std::vector<Vector3d>{-end, end}, Triangles{{0, 1, 1}}, radius));
}

RigidObstacle RigidObstacle::box(const Vector3d& sides) {
  for (int axis = 0; axis < 3; ++axis) {
    requireLength(std::string("side ") + "xyz"[axis] + " of a box", sides[axis], false);
  }
  const Vector3d half = sides / 2.0;
  std::vector<Vector3d> corners;  // bit i of the index says on which side along axis i
  for (int i = 0; i < 8; ++i) {
    const Vector3d signs(i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0);
    corners.push_back(signs.cwiseProduct(half));
  }
  std::vector<std::array<int, 3>> triangles;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3;
    for (const int first : {0, 1 << axis}) {
      triangles.push_back({first, first + u, first + u + v});
      triangles.push_back({first, first + u + v, first + v});
    }
  }
  auto shape = std::make_shared<Shape>(corners, triangles, 0.0);
  shape->half_sides = half;
  return RigidObstacle(std::move(shape));
}

RigidObstacle RigidObstacle::mesh(const std::vector<Vector3d>& vertices,
                                  const std::vector<std::array<int, 3>>& triangles) {
  if (triangles.empty()) throw std::invalid_argument("a mesh obstacle must have triangles");
  const int count = static_cast<int>(vertices.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const int vertex : triangles[i]) {
      if (vertex < 0 || vertex >= count) {
        refuse("a vertex of triangle " + std::to_string(i), vertex,
               "from 0 to " + std::to_string(count - 1));
      }
    }
  }
  for (int i = 0; i < count; ++i) {
    for (const double coordinate : vertices[i]) {
      if (!(std::abs(coordinate) <= kMaxLength)) {
        refuse("a coordinate of vertex " + std::to_string(i), coordinate,
               "finite and at most 1e9 m");
      }
    }
  }
  return RigidObstacle(std::make_shared<Shape>(vertices, triangles, 0.0));
}

void RigidObstacle::setPose(const Eigen::Isometry3d& pose) {
  if (!pose.matrix().allFinite()) {
    throw std::invalid_argument("the pose of an obstacle is not finite");
  }
  const double farthest = pose.translation().cwiseAbs().maxCoeff();
  if (farthest > kMaxLength) refuse("the place of an obstacle", farthest, "at most 1e9 m away");
  const Eigen::Matrix3d rotation = pose.linear();
  const double defect =
      (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(defect <= kRigid)) refuse("the scale or shear of a pose", defect, "at most 1e-9");
  if (rotation.determinant() < 0.0) {
    throw std::invalid_argument("the pose of an obstacle is a reflection, must be a rotation");
  }
  pose_ = pose;
}

double RigidObstacle::support(const Vector3d& d) const {
  const Vector3d own = pose_.linear().transpose() * d;
  double largest = -std::numeric_limits<double>::infinity();
  for (const Vector3d& corner : shape_->corners) largest = std::max(largest, own.dot(corner));
  return largest + shape_->radius * d.norm() + d.dot(pose_.translation());
}

TrianglePoint RigidObstacle::closestPoint(const Triangle& triangle) const {
  Triangle own;
  double farthest = std::max(shape_->reach, pose_.translation().cwiseAbs().maxCoeff());
  for (int i = 0; i < 3; ++i) {
    own[i] = pose_.linear().transpose() * (triangle[i] - pose_.translation());
    if (shape_->half_sides && (own[i].array().abs() <= shape_->half_sides->array()).all()) {
      return {0.0, Vector3d::Unit(i)};
    }
    farthest = std::max(farthest, triangle[i].cwiseAbs().maxCoeff());
  }
  TrianglePoint point = NearestTriangle(shape_->model, own).find();
  // Coordinates of this size are known to so much after a change of frame.
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * farthest;
  point.distance -= shape_->radius;
  if (point.distance <= rounding) point.distance = 0.0;
  return point;
}

SurfaceDistance RigidObstacle::distance(const Vector3d& place) const {
  const Vector3d own = pose_.linear().transpose() * (place - pose_.translation());
  if (shape_->half_sides) {
    const SurfaceDistance found = distanceToBox(*shape_->half_sides, own);
    return {found.distance, pose_.linear() * found.normal};
  }
  const Vector3d way = own - shape_->nearest(own);
  const double length = way.norm();
  const Vector3d normal = length > 0.0 ? Vector3d(way / length) : Vector3d::UnitX();
  return {length - shape_->radius, pose_.linear() * normal};
}

double RigidObstacle::boundingRadius() const {
  double farthest = 0.0;
  for (const Vector3d& corner : shape_->corners) farthest = std::max(farthest, corner.norm());
  return farthest + shape_->radius;
}

void query(const KdopHierarchy& hierarchy, const RigidObstacle& obstacle, const Range& range,
           std::vector<NearElement>& found) {
  hierarchy.query(ObstacleBody(obstacle), range, found);
}

std::vector<VolumeIndex> tested(const KdopHierarchy& hierarchy, const RigidObstacle& obstacle,
                                const Range& range) {
  return hierarchy.tested(ObstacleBody(obstacle), range);
}

}  // namespace haptex::proximity
