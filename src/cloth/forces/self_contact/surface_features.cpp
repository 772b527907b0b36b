#include "haptex/cloth/forces/self_contact/surface_features.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "haptex/proximity/element_pair.h"
#include "haptex/proximity/triangle_distance.h"

namespace haptex::cloth {

using Eigen::Vector3d;

SurfaceFeatures::SurfaceFeatures(const std::vector<std::array<int, 3>>& triangles,
                                 std::size_t vertices, std::vector<int> fabrics)
    : triangles_(triangles),
      fabrics_(std::move(fabrics)),
      across_(triangles.size(), {-1, -1, -1}),
      around_(vertices) {
  std::map<proximity::Edge, std::vector<std::array<int, 2>>> owners;  // triangle and corner
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    const auto& [a, b, c] = triangles[t];
    if (a == b || b == c || c == a) continue;
    for (int i = 0; i < 3; ++i) {
      around_[triangles[t][i]].push_back(t);
      owners[proximity::edgeBetween(triangles[t][i], triangles[t][(i + 1) % 3])].push_back({t, i});
    }
  }
  for (const auto& [edge, of_edge] : owners) {
    if (of_edge.size() == 2) {
      across_[of_edge[0][0]][of_edge[0][1]] = of_edge[1][0];
      across_[of_edge[1][0]][of_edge[1][1]] = of_edge[0][0];
    } else {
      for (int vertex : edge) around_[vertex].clear();
    }
  }
}

const std::vector<SurfaceFeatures::Feature>& SurfaceFeatures::nearest(const Positions& positions,
                                                                      const Vector3d& place,
                                                                      const std::vector<int>& near,
                                                                      double reach) {
  features_.clear();
  for (int triangle : near) countTriangle(positions, place, triangle, reach);
  for (int triangle : near) countShared(positions, place, near, triangle);
  // Shares of fabrics need not cancel to the last bit.
  constexpr double kNone = 1e-9;
  const auto is_none = [](const Feature& feature) { return std::abs(feature.times) < kNone; };
  features_.erase(std::remove_if(features_.begin(), features_.end(), is_none), features_.end());
  return features_;
}

void SurfaceFeatures::countTriangle(const Positions& positions, const Vector3d& place, int triangle,
                                    double reach) {
  const std::array<int, 3>& corners = triangles_[triangle];
  const proximity::TrianglePoint nearest = proximity::closestPoint(
      {positions[corners[0]], positions[corners[1]], positions[corners[2]]}, place);
  if (nearest.distance >= reach) return;
  Feature feature = {0, {-1, -1, -1}, {}, 1.0, fabricOf(triangle)};
  for (int i = 0; i < 3; ++i) {
    if (nearest.barycentric[i] == 0.0) continue;
    feature.ids[feature.size] = corners[i];
    feature.weights[feature.size++] = nearest.barycentric[i];
  }
  count(feature);
}

void SurfaceFeatures::countEdge(const Positions& positions, const Vector3d& place, int from, int to,
                                double times, int fabric) {
  const Vector3d way = positions[to] - positions[from];
  const double square = way.squaredNorm();
  const double t = way.dot(place - positions[from]);
  if (!(t > 0.0)) return count({1, {from, -1, -1}, {1.0}, times, fabric});
  if (!(t < square)) return count({1, {to, -1, -1}, {1.0}, times, fabric});
  count({2, {from, to, -1}, {1.0 - t / square, t / square}, times, fabric});
}

void SurfaceFeatures::count(Feature feature) {
  // In ascending order, with the weights.
  for (int i = 0; i + 1 < feature.size; ++i) {
    for (int j = i + 1; j < feature.size; ++j) {
      if (feature.ids[j] > feature.ids[i]) continue;
      std::swap(feature.ids[i], feature.ids[j]);
      std::swap(feature.weights[i], feature.weights[j]);
    }
  }
  for (Feature& known : features_) {
    if (known.ids != feature.ids || known.fabric != feature.fabric) continue;
    known.times += feature.times;
    return;
  }
  features_.push_back(feature);
}

/// The inner edges and vertices whose first triangle this is: all of their triangles are near.
void SurfaceFeatures::countShared(const Positions& positions, const Vector3d& place,
                                  const std::vector<int>& near, int triangle) {
  const auto is_near = [&near](int other) {
    return std::binary_search(near.begin(), near.end(), other);
  };
  for (int i = 0; i < 3; ++i) {
    const int corner = triangles_[triangle][i], across = across_[triangle][i];
    if (across > triangle && is_near(across)) {
      const int next = triangles_[triangle][(i + 1) % 3];
      const bool alike = fabricOf(across) == fabricOf(triangle);
      countEdge(positions, place, corner, next, alike ? -1.0 : -0.5, fabricOf(triangle));
      if (!alike) countEdge(positions, place, corner, next, -0.5, fabricOf(across));
    }
    const std::vector<int>& around = around_[corner];
    if (around.empty() || around.front() != triangle) continue;
    if (!std::all_of(around.begin(), around.end(), is_near)) continue;
    if (fabrics_.empty()) {
      count({1, {corner, -1, -1}, {1.0}, 1.0});
      continue;
    }
    const double share = 1.0 / static_cast<double>(around.size());
    for (const int of_vertex : around) {
      count({1, {corner, -1, -1}, {1.0}, share, fabricOf(of_vertex)});
    }
  }
}

}  // namespace haptex::cloth
