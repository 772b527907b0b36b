#include "haptex/mesh/circles.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "haptex/base/require.h"

namespace haptex::mesh {
namespace {

struct Circle {
  int begin;     // its first particle
  int count;     // particles
  double phase;  // rad, of the first one
  double step() const { return 2.0 * M_PI / count; }
};

void requireAscending(const std::vector<double>& radii) {
  if (radii.size() < 2) {
    base::refuse("a round mesh has ", radii.size(), " circles: allowed are 2 or more");
  }
  for (std::size_t k = 0; k < radii.size(); ++k) {
    const double least = k == 0 ? 0.0 : radii[k - 1];
    if (std::isfinite(radii[k]) && (k == 0 ? radii[k] >= 0.0 : radii[k] > least)) continue;
    base::refuse("radius ", k, " of a round mesh is ", radii[k], " m: allowed are finite numbers ",
                 k == 0 ? ">= " : "> ", least);
  }
}

Circle addCircle(const std::vector<double>& radii, std::size_t k, ClothMesh& mesh) {
  const double golden_angle = M_PI * (3.0 - std::sqrt(5.0));
  Circle circle{static_cast<int>(mesh.rest_coordinates.size()), 1, 0.0};
  if (radii[k] > 0.0) {
    const double height = k == 0 ? radii[1] - radii[0] : radii[k] - radii[k - 1];
    // The height of an equilateral triangle is sqrt 3 / 2 of its side.
    const long count = std::lround(M_PI * std::sqrt(3.0) * radii[k] / height);
    circle.count = std::max(3, static_cast<int>(count));
    circle.phase = std::fmod(static_cast<double>(k) * golden_angle, circle.step());
  }
  for (int i = 0; i < circle.count; ++i) {
    const double angle = circle.phase + i * circle.step();
    mesh.rest_coordinates.emplace_back(radii[k] * std::cos(angle), radii[k] * std::sin(angle));
  }
  return circle;
}

/// Around both circles at once, from the side that lags behind.
void addTriangles(const Circle& inner, const Circle& outer, ClothMesh& mesh) {
  const bool is_middle = inner.count == 1;
  for (int in = 0, out = 0; out < outer.count || (!is_middle && in < inner.count);) {
    const bool by_outer = is_middle || in == inner.count ||
                          (out < outer.count && outer.phase + (out + 0.5) * outer.step() <=
                                                    inner.phase + (in + 0.5) * inner.step());
    const int a = inner.begin + in % inner.count, b = outer.begin + out % outer.count;
    if (by_outer) {
      mesh.triangles.push_back({a, b, outer.begin + ++out % outer.count});
    } else {
      mesh.triangles.push_back({a, b, inner.begin + ++in % inner.count});
    }
  }
}

}  // namespace

ClothMesh meshOfCircles(const std::vector<double>& radii) {
  requireAscending(radii);
  ClothMesh mesh;
  Circle inner = addCircle(radii, 0, mesh);
  for (std::size_t k = 1; k < radii.size(); ++k) {
    const Circle outer = addCircle(radii, k, mesh);
    addTriangles(inner, outer, mesh);
    inner = outer;
  }
  mesh.initial_positions = flatPositions(mesh);
  return mesh;
}

ClothMesh makeDisc(double radius, int rings) {
  if (!std::isfinite(radius) || radius <= 0.0) {
    base::refuse("radius is ", radius, " m; it must be finite and greater than 0");
  }
  if (rings < 1) base::refuse("rings is ", rings, "; it must be at least 1");
  std::vector<double> radii;
  for (int ring = 0; ring <= rings; ++ring) radii.push_back(radius * ring / rings);
  return meshOfCircles(radii);
}

}  // namespace haptex::mesh
