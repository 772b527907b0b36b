#include "haptex/garment/placement/overlaps.h"

#include "haptex/proximity/mesh_intersections.h"

namespace haptex::garment {

std::map<std::array<int, 2>, int> findOverlaps(const std::vector<PanelMesh>& meshes,
                                               const Body* body) {
  std::vector<Eigen::Vector3d> positions;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> panel_of;
  const auto add = [&](const std::vector<Eigen::Vector3d>& places,
                       const std::vector<std::array<int, 3>>& faces, int panel) {
    const int first = static_cast<int>(positions.size());
    positions.insert(positions.end(), places.begin(), places.end());
    for (const auto& [a, b, c] : faces) triangles.push_back({first + a, first + b, first + c});
    panel_of.insert(panel_of.end(), faces.size(), panel);
  };
  const int body_index = static_cast<int>(meshes.size());
  for (int i = 0; i < body_index; ++i) {
    add(meshes[i].mesh.initial_positions, meshes[i].mesh.triangles, i);
  }
  if (body != nullptr) add(body->vertices, body->triangles, body_index);
  std::map<std::array<int, 2>, int> counts;
  if (triangles.empty()) return counts;
  proximity::MeshIntersections intersections(triangles, positions);
  for (const auto& [first, second] : intersections.find(positions)) {
    const int a = panel_of[first], b = panel_of[second];  // ascending, as the triangles are
    if (a != body_index) ++counts[{a, b}];
  }
  return counts;
}

}  // namespace haptex::garment
