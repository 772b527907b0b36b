#include "haptex/garment/placement/overlaps.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "haptex/proximity/mesh_intersections.h"

namespace haptex::garment {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;
using Triangle = std::array<int, 3>;

AlignedBox3d boxOf(const std::vector<Vector3d>& positions, const Triangle& triangle) {
  AlignedBox3d box;
  for (const int corner : triangle) box.extend(positions[corner]);
  return box;
}

std::vector<AlignedBox3d> boxesOfPanels(const mesh::ClothMesh& cloth) {
  std::vector<AlignedBox3d> boxes(cloth.panelCount());
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t) {
    boxes[cloth.panelOf(t)].extend(boxOf(cloth.initial_positions, cloth.triangles[t]));
  }
  return boxes;
}

}  // namespace

std::map<std::array<int, 2>, int> findOverlaps(const mesh::ClothMesh& cloth,
                                               const std::vector<Vector3d>& vertices,
                                               const std::vector<Triangle>& triangles) {
  std::map<std::array<int, 2>, int> counts;
  if (cloth.triangles.empty()) return counts;
  const std::vector<AlignedBox3d> boxes = boxesOfPanels(cloth);
  std::vector<Vector3d> positions = cloth.initial_positions;
  positions.insert(positions.end(), vertices.begin(), vertices.end());
  std::vector<Triangle> all = cloth.triangles;
  const int first = static_cast<int>(cloth.initial_positions.size());
  for (const Triangle& triangle : triangles) {
    const AlignedBox3d box = boxOf(vertices, triangle);
    // Of a body the face, the hands and the feet have many triangles, which are near no panel.
    if (std::any_of(boxes.begin(), boxes.end(),
                    [&](const AlignedBox3d& other) { return other.intersects(box); })) {
      all.push_back({first + triangle[0], first + triangle[1], first + triangle[2]});
    }
  }
  const std::size_t of_cloth = cloth.triangles.size();
  const auto panel_of = [&](std::size_t t) {
    return t < of_cloth ? cloth.panelOf(t) : cloth.panelCount();
  };
  proximity::MeshIntersections intersections(std::move(all), positions);
  for (const auto& [a, b] : intersections.find(positions)) {
    // The smaller index comes first, but in a merged mesh that need not be the smaller panel.
    const auto panels = std::minmax({panel_of(a), panel_of(b)});
    if (panels.first != cloth.panelCount()) ++counts[{panels.first, panels.second}];
  }
  return counts;
}

}  // namespace haptex::garment
