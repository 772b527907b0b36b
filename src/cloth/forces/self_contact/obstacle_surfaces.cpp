#include "haptex/cloth/forces/self_contact/obstacle_surfaces.h"

#include <utility>
#include <variant>

namespace haptex::cloth {
namespace {

using Eigen::Vector3d;
using Triangles = std::vector<std::array<int, 3>>;

/// Adds the surface of a shape. @return its radius (m)
struct AddShape {
  std::vector<Vector3d>& vertices;
  Triangles& triangles;

  double operator()(const mesh::ObstacleSphere& sphere) const {
    const int centre = static_cast<int>(vertices.size());
    vertices.push_back(Vector3d::Zero());
    triangles.push_back({centre, centre, centre});
    return sphere.radius;
  }
  double operator()(const mesh::ObstacleCapsule& capsule) const {
    const int first = static_cast<int>(vertices.size());
    const Vector3d end(0.0, 0.0, 0.5 * capsule.length);
    vertices.push_back(-end);
    vertices.push_back(end);
    triangles.push_back({first, first + 1, first + 1});
    return capsule.radius;
  }
  double operator()(const mesh::ObstacleBox& box) const {
    const int first = static_cast<int>(vertices.size());
    for (int i = 0; i < 8; ++i) {  // bit k tells on which side along axis k
      const Vector3d sides(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
      vertices.push_back(sides.cwiseProduct(box.sides));
    }
    for (int axis = 0; axis < 3; ++axis) {
      const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3;
      for (const int side : {first, first + (1 << axis)}) {
        triangles.push_back({side, side + u, side + u + v});
        triangles.push_back({side, side + u + v, side + v});
      }
    }
    return 0.0;
  }
  double operator()(const mesh::ObstacleMesh& mesh) const {
    const int first = static_cast<int>(vertices.size());
    vertices.insert(vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (const auto& [a, b, c] : mesh.triangles) {
      triangles.push_back({first + a, first + b, first + c});
    }
    return 0.0;
  }
};

}  // namespace

ObstacleSurfaces::ObstacleSurfaces(std::vector<mesh::Obstacle> obstacles)
    : obstacles_(std::move(obstacles)),
      elements_(Triangles{}),
      turn_(obstacles_.size(), Eigen::Matrix3d::Identity()) {
  Triangles triangles;
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    radius_.push_back(std::visit(AddShape{own_, triangles}, obstacles_[i].shape));
    obstacle_of_.resize(own_.size(), static_cast<int>(i));
  }
  elements_ = proximity::MeshElements(triangles);
  place(0.0, end_);
  begin_ = end_;
}

void ObstacleSurfaces::place(double time, std::vector<Vector3d>& places) const {
  places.resize(own_.size());
  Eigen::Isometry3d pose;
  for (std::size_t i = 0; i < own_.size(); ++i) {
    const bool is_first = i == 0 || obstacle_of_[i] != obstacle_of_[i - 1];
    if (is_first) pose = obstacles_[obstacle_of_[i]].poseAt(time);
    places[i] = pose * own_[i];
  }
}

bool ObstacleSurfaces::move(double begin, double end) {
  const bool goes_on = begin == end_time_ || begin == begin_time_;
  if (begin == end_time_) {
    begin_ = end_;
  } else if (begin != begin_time_) {
    place(begin, begin_);
  }
  place(end, end_);
  begin_time_ = begin;
  end_time_ = end;
  moved_ = end_ != begin_;
  for (int i = 0; i < count(); ++i) {
    const mesh::Obstacle& obstacle = obstacles_[i];
    if (!obstacle.moves()) continue;
    turn_[i] = obstacle.poseAt(begin).linear() * obstacle.poseAt(end).linear().transpose();
    moved_ = moved_ || !turn_[i].isIdentity(0.0);
  }
  ++revision_;
  return goes_on;
}

void ObstacleSurfaces::stopAt(const std::vector<Vector3d>& places) {
  end_ = places;
  ++revision_;
}

Vector3d ObstacleSurfaces::wayOf(int obstacle, int count, const int* vertices,
                                 const double* weights, const Vector3d& offset, bool at_end) const {
  Vector3d way = at_end ? Vector3d(offset - turn_[obstacle] * offset)
                        : Vector3d(turn_[obstacle].transpose() * offset - offset);
  for (int i = 0; i < count; ++i) way += weights[i] * (end_[vertices[i]] - begin_[vertices[i]]);
  return way;
}

}  // namespace haptex::cloth
