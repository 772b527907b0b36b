#include "haptex/garment/triangulation/triangle_quality.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "haptex/garment/pattern/plane_predicates.h"

namespace haptex::garment {
namespace {

using Eigen::Vector2d;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

TriangleQuality qualityOf(const mesh::ClothMesh& mesh,
                          const std::function<bool(const std::array<int, 3>&)>& counts) {
  TriangleQuality quality;
  quality.least_angle = M_PI;
  const auto& rest = mesh.rest_coordinates;
  std::map<std::array<int, 2>, int> opposite;  // of edges as their triangles run along them
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    const Vector2d &p = rest[triangle[0]], &q = rest[triangle[1]], &r = rest[triangle[2]];
    quality.area += 0.5 * cross(q - p, r - p);
    if (turn(p, q, r) <= 0) ++quality.clockwise;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      opposite[{triangle[i], triangle[j]}] = triangle[k];
      const Vector2d a = rest[triangle[j]] - rest[triangle[i]];
      const Vector2d b = rest[triangle[k]] - rest[triangle[i]];
      const double angle = std::atan2(std::abs(cross(a, b)), a.dot(b));
      if (counts(triangle)) quality.least_angle = std::min(quality.least_angle, angle);
    }
  }
  double sum = 0.0, squares = 0.0;
  int edges = 0;
  quality.shortest = mesh.triangles.empty() ? 0.0 : 1e9;
  for (const auto& [edge, point] : opposite) {
    const auto& [a, b] = edge;
    const auto other = opposite.find({b, a});
    if (other != opposite.end()) {
      if (a > b) continue;  // once
      if (inCircle(rest[a], rest[b], rest[point], rest[other->second]) > 0) ++quality.not_delaunay;
    }
    const double length = (rest[b] - rest[a]).norm();
    sum += length;
    squares += length * length;
    quality.shortest = std::min(quality.shortest, length);
    quality.longest = std::max(quality.longest, length);
    ++edges;
  }
  quality.mean = sum / std::max(edges, 1);
  quality.spread =
      std::sqrt(std::max(0.0, squares / std::max(edges, 1) - quality.mean * quality.mean));
  return quality;
}

}  // namespace haptex::garment
