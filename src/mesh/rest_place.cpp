#include "haptex/mesh/rest_place.h"

#include <numeric>

namespace haptex::mesh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double doubleArea(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

std::optional<RestPlace> findRestPlace(const ClothMesh& mesh, const std::vector<int>& triangles,
                                       const Vector2d& rest) {
  constexpr double kRounding = 1e-9;
  for (const int triangle : triangles) {
    const auto [a, b, c] = mesh.restCorners(triangle);
    const double whole = doubleArea(b - a, c - a);
    const double of_b = doubleArea(rest - a, c - a) / whole;
    const double of_c = doubleArea(b - a, rest - a) / whole;
    const Vector3d weights(1.0 - of_b - of_c, of_b, of_c);
    if (!(weights.minCoeff() >= -kRounding)) continue;
    const Vector3d within = weights.cwiseMax(0.0);
    return RestPlace{triangle, within / within.sum()};
  }
  return std::nullopt;
}

std::optional<RestPlace> findRestPlace(const ClothMesh& mesh, const Vector2d& rest) {
  std::vector<int> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0);
  return findRestPlace(mesh, all, rest);
}

}  // namespace haptex::mesh
