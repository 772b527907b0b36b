#include "haptex/mesh/merged_seams.h"

#include <algorithm>
#include <map>

namespace haptex::mesh {
namespace {

using Eigen::Vector2d;

/// An edge of a triangle, in rest coordinates from the particle with the lower number.
struct EdgeOfTriangle {
  int triangle;
  std::array<Vector2d, 2> ends;
  Vector2d opposite;

  Vector2d along() const { return (ends[1] - ends[0]).normalized(); }
  double length() const { return (ends[1] - ends[0]).norm(); }
  /// Across the edge, into the triangle.
  Vector2d inward() const {
    const Vector2d direction = along();
    const Vector2d across(-direction.y(), direction.x());
    return across.dot(opposite - ends[0]) > 0.0 ? across : Vector2d(-across);
  }
};

EdgeOfTriangle sideOpposite(const ClothMesh& mesh, int triangle, int corner) {
  const std::array<Vector2d, 3> rest = mesh.restCorners(triangle);
  int first = (corner + 1) % 3, second = (corner + 2) % 3;
  const std::array<int, 3>& particles = mesh.triangles[triangle];
  if (particles[first] > particles[second]) std::swap(first, second);
  return {triangle, {rest[first], rest[second]}, rest[corner]};
}

bool isSeam(const ClothMesh& mesh, const EdgeOfTriangle& one, const EdgeOfTriangle& other) {
  constexpr double kSame = 1e-9;  // of the edge's length
  if (mesh.panelOf(one.triangle) != mesh.panelOf(other.triangle)) return true;
  const double apart =
      std::max((one.ends[0] - other.ends[0]).norm(), (one.ends[1] - other.ends[1]).norm());
  return apart > kSame * one.length();
}

}  // namespace

void addHingesOfMergedSeams(ClothMesh& mesh) {
  std::map<std::array<int, 2>, EdgeOfTriangle> sides;  // the first of every edge
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const auto [low, high] =
          std::minmax(mesh.triangles[t][(corner + 1) % 3], mesh.triangles[t][(corner + 2) % 3]);
      const EdgeOfTriangle side = sideOpposite(mesh, static_cast<int>(t), corner);
      const auto [found, is_first] = sides.try_emplace({low, high}, side);
      const EdgeOfTriangle& first = found->second;
      if (is_first || !isSeam(mesh, first, side)) continue;
      mesh.seam_hinges.push_back({{first.triangle, side.triangle},
                                  {first.along(), side.along()},
                                  {first.inward(), side.inward()},
                                  0.5 * (first.length() + side.length()),
                                  0.0});
    }
  }
}

}  // namespace haptex::mesh
