// What tests measure on the triangles of panels.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "haptex/garment/panel_mesh.h"
#include "haptex/garment/plane_predicates.h"

namespace haptex::garment {

struct MeshMeasures {
  double area = 0.0;          ///< m^2
  double least_angle = M_PI;  ///< rad
  int clockwise = 0;          ///< triangles
  int not_delaunay = 0;       ///< edges with the point behind them inside of the circle
  double mean = 0.0, spread = 0.0, shortest = 1e9, longest = 0.0;  ///< m, of edges
};

/// @param far whether a triangle's angles count
template <typename Far>
MeshMeasures measure(const mesh::ClothMesh& mesh, const Far& far) {
  using Eigen::Vector2d;
  MeshMeasures measures;
  std::map<std::array<int, 2>, int> opposite;
  std::map<std::array<int, 2>, double> lengths;
  const auto& rest = mesh.rest_coordinates;
  for (const auto& triangle : mesh.triangles) {
    std::array<Vector2d, 3> p;
    for (int i = 0; i < 3; ++i) p[i] = rest[triangle[i]];
    const Vector2d u = p[1] - p[0], v = p[2] - p[0];
    measures.area += 0.5 * (u.x() * v.y() - u.y() * v.x());
    if (turn(p[0], p[1], p[2]) <= 0) ++measures.clockwise;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      const Vector2d a = p[j] - p[i], b = p[k] - p[i];
      const double angle = std::atan2(std::abs(a.x() * b.y() - a.y() * b.x()), a.dot(b));
      if (far(triangle)) measures.least_angle = std::min(measures.least_angle, angle);
      opposite[{triangle[i], triangle[j]}] = triangle[k];
      lengths[{std::min(triangle[i], triangle[j]), std::max(triangle[i], triangle[j])}] = a.norm();
    }
  }
  for (const auto& [edge, point] : opposite) {
    const auto other = opposite.find({edge[1], edge[0]});
    if (other == opposite.end()) continue;
    if (inCircle(rest[edge[0]], rest[edge[1]], rest[point], rest[other->second]) > 0) {
      ++measures.not_delaunay;
    }
  }
  double squares = 0.0;
  for (const auto& [edge, length] : lengths) {
    measures.mean += length / static_cast<double>(lengths.size());
    squares += length * length / static_cast<double>(lengths.size());
    measures.shortest = std::min(measures.shortest, length);
    measures.longest = std::max(measures.longest, length);
  }
  measures.spread = std::sqrt(std::max(0.0, squares - measures.mean * measures.mean));
  return measures;
}

inline MeshMeasures measure(const mesh::ClothMesh& mesh) {
  return measure(mesh, [](const std::array<int, 3>&) { return true; });
}

/// m^2, of the polygons that the particles along the edges make.
inline double outlinedArea(const PanelMesh& panel) {
  double area = 0.0;
  for (std::size_t k = 0; k < panel.edges.size(); ++k) {
    double part = 0.0;
    for (const EdgeParticles& edge : panel.edges[k]) {
      for (std::size_t i = 1; i < edge.particles.size(); ++i) {
        const auto& a = panel.mesh.rest_coordinates[edge.particles[i - 1]];
        const auto& b = panel.mesh.rest_coordinates[edge.particles[i]];
        part += 0.5 * (a.x() * b.y() - a.y() * b.x());
      }
    }
    area += k == 0 ? std::abs(part) : -std::abs(part);
  }
  return area;
}

}  // namespace haptex::garment
