#include "haptex/cloth/forces/self_contact/rest_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace haptex::cloth {

using Eigen::Vector3d;

RestSurface::RestSurface(const mesh::ClothMesh& mesh)
    : triangles(mesh.triangles), flat_(mesh.panelCount() == 1 && mesh.corner_coordinates.empty()) {
  places_ = flat_ ? mesh::flatPositions(mesh) : mesh.initial_positions;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    std::array<Vector3d, 3>& places = corners.emplace_back();
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector2d& corner = mesh.corner_coordinates.empty()
                                          ? mesh.rest_coordinates[triangles[t][i]]
                                          : mesh.corner_coordinates[t][i];
      places[i] = {corner.x(), corner.y(), 0.0};
    }
    fabrics.push_back(mesh.fabricOf(t));
  }
  const auto is_first = [](int fabric) { return fabric == 0; };
  if (std::all_of(fabrics.begin(), fabrics.end(), is_first)) fabrics.clear();
}

double RestSurface::shortestAltitude() const {
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : corners) {
    const Vector3d ab = b - a, ac = c - a;
    const double longest = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
    shortest = std::min(shortest, ab.cross(ac).norm() / longest);
  }
  return shortest;
}

double RestSurface::area(std::size_t triangle) const {
  const auto& [a, b, c] = corners[triangle];
  const Vector3d ab = b - a, ac = c - a;
  return 0.5 * ab.cross(ac).norm();
}

}  // namespace haptex::cloth
