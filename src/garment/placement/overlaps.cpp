#include "haptex/garment/placement/overlaps.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "haptex/proximity/mesh_intersections.h"

namespace haptex::garment {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// Triangles of panels and a body in one mesh.
struct Together {
  std::vector<Vector3d> positions;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> panels;  // per triangle

  void add(const std::vector<Vector3d>& places, const std::vector<std::array<int, 3>>& faces,
           int panel) {
    const int first = static_cast<int>(positions.size());
    positions.insert(positions.end(), places.begin(), places.end());
    for (const auto& [a, b, c] : faces) triangles.push_back({first + a, first + b, first + c});
    panels.insert(panels.end(), faces.size(), panel);
  }
};

/// Of the body, what is in the box of some panel: faces, hands and feet have many triangles.
std::vector<std::array<int, 3>> trianglesNear(const std::vector<AlignedBox3d>& boxes,
                                              const Body& body) {
  std::vector<std::array<int, 3>> near;
  for (const auto& triangle : body.triangles) {
    AlignedBox3d box;
    for (const int vertex : triangle) box.extend(body.vertices[vertex]);
    if (std::any_of(boxes.begin(), boxes.end(),
                    [&](const AlignedBox3d& other) { return other.intersects(box); })) {
      near.push_back(triangle);
    }
  }
  return near;
}

}  // namespace

std::map<std::array<int, 2>, int> findOverlaps(const std::vector<PanelMesh>& meshes,
                                               const Body& body) {
  Together all;
  std::vector<AlignedBox3d> boxes;
  const int body_index = static_cast<int>(meshes.size());
  for (int i = 0; i < body_index; ++i) {
    all.add(meshes[i].mesh.initial_positions, meshes[i].mesh.triangles, i);
    boxes.emplace_back();
    for (const Vector3d& position : meshes[i].mesh.initial_positions) {
      boxes.back().extend(position);
    }
  }
  all.add(body.vertices, trianglesNear(boxes, body), body_index);
  std::map<std::array<int, 2>, int> counts;
  if (all.triangles.empty()) return counts;
  proximity::MeshIntersections intersections(all.triangles, all.positions);
  for (const auto& [first, second] : intersections.find(all.positions)) {
    const int a = all.panels[first], b = all.panels[second];  // ascending, as the triangles are
    if (a != body_index) ++counts[{a, b}];
  }
  return counts;
}

}  // namespace haptex::garment
