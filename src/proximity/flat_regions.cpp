#include "haptex/proximity/flat_regions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace haptex::proximity {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Polygon = std::vector<Vector2d>;

constexpr int kSmallest = 32;             // triangles of a region
constexpr double kPlanarity = 1e-9;       // of the size, by which a plane may be missed
constexpr double kAreaTolerance = 1e-11;  // of the hull, that may be missing by rounding

constexpr float kMostStretch = 8.0f;  // beyond it rounding may be larger than is allowed for

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

double areaOf(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    twice += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  }
  return 0.5 * twice;
}

/// Counter-clockwise, after Andrew's monotone chain.
Polygon convexHull(Polygon points) {
  std::sort(points.begin(), points.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  Polygon hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t begin = hull.size();
    for (const Vector2d& point : points) {
      while (hull.size() >= begin + 2 &&
             cross(hull.back() - hull[hull.size() - 2], point - hull[hull.size() - 2]) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(point);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

/// The part of a convex polygon within another.
Polygon clipped(Polygon polygon, const Polygon& hull) {
  for (std::size_t i = 0; i < hull.size() && !polygon.empty(); ++i) {
    const Vector2d& from = hull[i];
    const Vector2d way = hull[(i + 1) % hull.size()] - from;
    Polygon kept;
    for (std::size_t j = 0; j < polygon.size(); ++j) {
      const Vector2d& a = polygon[j];
      const Vector2d& b = polygon[(j + 1) % polygon.size()];
      const double of_a = cross(way, a - from), of_b = cross(way, b - from);
      if (of_a >= 0.0) kept.push_back(a);
      if ((of_a >= 0.0) != (of_b >= 0.0)) kept.push_back(a + of_a / (of_a - of_b) * (b - a));
    }
    polygon = std::move(kept);
  }
  return polygon;
}

/// Positions in the plane that they lie in, if they do.
std::optional<Polygon> inPlane(const std::vector<Vector3d>& positions,
                               const std::vector<std::array<int, 3>>& triangles) {
  Vector3d area(0, 0, 0);
  Eigen::AlignedBox3d box;
  for (const auto& t : triangles) {
    area += (positions[t[1]] - positions[t[0]]).cross(positions[t[2]] - positions[t[0]]);
    for (int vertex : t) box.extend(positions[vertex]);
  }
  if (!(area.norm() > 0.0)) return {};
  const Vector3d normal = area.normalized();
  const Vector3d along = normal.unitOrthogonal(), across = normal.cross(along);
  Polygon plane(positions.size(), Vector2d::Zero());
  for (const auto& t : triangles) {
    for (int vertex : t) {
      const Vector3d offset = positions[vertex] - positions[triangles[0][0]];
      if (std::abs(normal.dot(offset)) > kPlanarity * box.diagonal().norm()) return {};
      plane[vertex] = Vector2d(along.dot(offset), across.dot(offset));
    }
  }
  return plane;
}

}  // namespace

/// Finds the regions from the root to the leaves: the hull of a half lies in that of the whole.
class FlatRegions::Builder {
 public:
  Builder(FlatRegions& flat, const KdopHierarchy& hierarchy, Polygon plane)
      : flat_(flat), hierarchy_(hierarchy), plane_(std::move(plane)) {}

  void run() {
    const int count = static_cast<int>(hierarchy_.order().size());
    for (int i = 0; i < count; ++i) {
      const Polygon corners = cornersOf(i);
      if (!(areaOf(corners) > 0.0)) return;  // turned over, or without area
      Eigen::Matrix2d edges;
      edges << corners[1] - corners[0], corners[2] - corners[0];
      const Eigen::Matrix2d inverse = edges.inverse();
      flat_.largest_inverse_ = std::max(flat_.largest_inverse_, inverse.norm());
      for (int k = 0; k < 3; ++k) flat_.triangles_.corner[k].push_back(triangle(i)[k]);
      for (int k = 0; k < 4; ++k) {
        flat_.triangles_.inverse[k].push_back(static_cast<float>(inverse(k / 2, k % 2)));
      }
    }
    flat_.regions_.resize(2 * static_cast<std::size_t>(hierarchy_.leaves()) - 1);
    visit(0, 0, hierarchy_.leaves(), {});
  }

 private:
  const std::array<int, 3>& triangle(int i) const {
    return hierarchy_.triangles()[hierarchy_.order()[i]];
  }
  Polygon cornersOf(int i) const {
    return {plane_[triangle(i)[0]], plane_[triangle(i)[1]], plane_[triangle(i)[2]]};
  }

  /// @param others triangles beyond the volume that the hull of the volume above reaches into
  void visit(int volume, int leaf, int leaves, const std::vector<int>& others) {
    Region& region = flat_.regions_[volume];
    region.begin = hierarchy_.leafBegin(leaf);
    region.end = hierarchy_.leafBegin(leaf + leaves);
    if (region.end - region.begin < kSmallest) return;
    Polygon points;
    double covered = 0.0;
    for (int i = region.begin; i < region.end; ++i) {
      const Polygon corners = cornersOf(i);
      points.insert(points.end(), corners.begin(), corners.end());
      covered += areaOf(corners);
    }
    const Polygon hull = convexHull(std::move(points));
    const double area = areaOf(hull);
    std::vector<int> reached;
    for (int i : others) {
      const double common = areaWithin(cornersOf(i), hull);
      if (!(common > 0.0)) continue;
      reached.push_back(i);
      covered += common;
    }
    region.is_convex = std::abs(covered - area) <= kAreaTolerance * area;
    region.more_begin = static_cast<int>(flat_.more_.size());
    if (region.is_convex) flat_.more_.insert(flat_.more_.end(), reached.begin(), reached.end());
    region.more_end = static_cast<int>(flat_.more_.size());
    if (region.is_convex) addWeights(region);
    if (leaves == 1) return;
    const int middle = hierarchy_.leafBegin(leaf + leaves / 2);
    const int ends[3] = {region.begin, middle, region.end};
    for (int half = 0; half < 2; ++half) {
      std::vector<int> beyond = reached;
      for (int i = ends[1 - half]; i < ends[2 - half]; ++i) beyond.push_back(i);
      visit(2 * volume + 1 + half, leaf + half * leaves / 2, leaves / 2, beyond);
    }
  }

  static double areaWithin(const Polygon& corners, const Polygon& hull) {
    // Most are on the outer side of an edge of the hull.
    for (std::size_t j = 0; j < hull.size(); ++j) {
      const Vector2d way = hull[(j + 1) % hull.size()] - hull[j];
      const auto is_outside = [&](const Vector2d& p) { return cross(way, p - hull[j]) <= 0.0; };
      if (std::all_of(corners.begin(), corners.end(), is_outside)) return 0.0;
    }
    return areaOf(clipped(corners, hull));
  }

  void addWeights(Region& region) {
    std::map<int, Vector2d> weights;
    double area = 0.0;
    for (int i = region.begin; i < region.end; ++i) {
      const Polygon p = cornersOf(i);
      area += areaOf(p);
      for (int k = 0; k < 3; ++k) {
        const Vector2d opposite = p[(k + 2) % 3] - p[(k + 1) % 3];
        // Area times the gradient of the corner's share.
        const auto at = weights.emplace(triangle(i)[k], Vector2d::Zero()).first;
        at->second += 0.5 * Vector2d(-opposite.y(), opposite.x());
      }
    }
    region.weight_begin = static_cast<int>(flat_.weights_.size());
    for (const auto& [particle, weight] : weights) {
      if (weight.norm() < 1e-6 * std::sqrt(area / (region.end - region.begin))) continue;  // inside
      const Vector2d mean = weight / area;
      flat_.weights_.push_back(
          {particle, static_cast<float>(mean.x()), static_cast<float>(mean.y())});
    }
    region.weight_end = static_cast<int>(flat_.weights_.size());
  }

  FlatRegions& flat_;
  const KdopHierarchy& hierarchy_;
  Polygon plane_;
};

FlatRegions::FlatRegions(const KdopHierarchy& hierarchy, const std::vector<Vector3d>& reference) {
  std::optional<Polygon> plane = inPlane(reference, hierarchy.triangles());
  if (plane) Builder(*this, hierarchy, std::move(*plane)).run();
}

bool FlatRegions::isSteep(const float* positions, const float* frame, float least, int begin,
                          int end, const int* more) const {
  const int* const a = triangles_.corner[0].data();
  const int* const b = triangles_.corner[1].data();
  const int* const c = triangles_.corner[2].data();
  const float* const inverse[4] = {triangles_.inverse[0].data(), triangles_.inverse[1].data(),
                                   triangles_.inverse[2].data(), triangles_.inverse[3].data()};
  int steep = 0;
  for (int i = begin; i < end; ++i) {
    const int t = more == nullptr ? i : more[i];
    const float* const p = positions + 4 * std::ptrdiff_t{a[t]};
    const float* const q = positions + 4 * std::ptrdiff_t{b[t]};
    const float* const r = positions + 4 * std::ptrdiff_t{c[t]};
    float edges[2][2];  // of the triangle, along the frame: by frame vector, by edge
    for (int k = 0; k < 2; ++k) {
      const float* const n = frame + 3 * k;
      edges[k][0] = n[0] * (q[0] - p[0]) + n[1] * (q[1] - p[1]) + n[2] * (q[2] - p[2]);
      edges[k][1] = n[0] * (r[0] - p[0]) + n[1] * (r[1] - p[1]) + n[2] * (r[2] - p[2]);
    }
    const float xx = edges[0][0] * inverse[0][t] + edges[0][1] * inverse[2][t] - least;
    const float xy = edges[0][0] * inverse[1][t] + edges[0][1] * inverse[3][t];
    const float yx = edges[1][0] * inverse[0][t] + edges[1][1] * inverse[2][t];
    const float yy = edges[1][0] * inverse[1][t] + edges[1][1] * inverse[3][t] - least;
    const float mean = 0.5f * (xy + yx);
    const float most = std::max(std::max(xx, yy), std::max(std::abs(xy), std::abs(yx)));
    steep |= static_cast<int>(!(xx > 0.0f)) | static_cast<int>(!(xx * yy > mean * mean)) |
             static_cast<int>(!(most < kMostStretch));
  }
  return steep != 0;
}

bool FlatRegions::isFlat(const KdopHierarchy& hierarchy, int volume) const {
  if (static_cast<std::size_t>(volume) >= regions_.size()) return false;
  const Region& region = regions_[volume];
  if (!region.is_convex) return false;
  const float* positions = hierarchy.localPositions().data();
  Eigen::Matrix<double, 3, 2> mean = Eigen::Matrix<double, 3, 2>::Zero();
  for (int i = region.weight_begin; i < region.weight_end; ++i) {
    const Weight& weight = weights_[i];
    const float* const x = positions + 4 * std::ptrdiff_t{weight.particle};
    for (int k = 0; k < 3; ++k) {
      mean(k, 0) += static_cast<double>(x[k] * weight.x);
      mean(k, 1) += static_cast<double>(x[k] * weight.y);
    }
  }
  // The rotation nearest to the mean: F (F^T F)^-1/2, of a 2x2 matrix in closed form.
  const Eigen::Matrix2d square = mean.transpose() * mean;
  const double root = std::sqrt(std::max(0.0, square.determinant()));
  const double trace = std::sqrt(square.trace() + 2.0 * root);
  if (!(root > 1e-3)) return false;
  const Eigen::Matrix2d stretch = (square + root * Eigen::Matrix2d::Identity()) / trace;
  const Eigen::Matrix<double, 3, 2> rotation = mean * stretch.inverse();
  const Eigen::Matrix<float, 3, 2> frame = rotation.cast<float>();
  // Edges are off by the rounding of the positions, frame and inverse by their own.
  const double error = 8e-7 * hierarchy.extent() * largest_inverse_ + 1e-5;
  const auto least = static_cast<float>(kLeastStretch + error);
  constexpr int kAtATime = 256;
  for (int i = region.begin; i < region.end; i += kAtATime) {
    const int end = std::min(region.end, i + kAtATime);
    if (isSteep(positions, frame.data(), least, i, end, nullptr)) return false;
  }
  return !isSteep(positions, frame.data(), least, region.more_begin, region.more_end, more_.data());
}

}  // namespace haptex::proximity
