// Which triangles of a moving mesh intersect, asked again and again.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/proximity/box_tree.h"
#include "haptex/proximity/intersections.h"

namespace haptex::proximity {

/// Gives the answers of intersectingTriangles(), with boxes in a tree instead of a sweep. Allocates
/// nothing once its buffers have had the size that they need.
class MeshIntersections {
 public:
  /// @param triangles vertex indices, at least one triangle
  /// @param positions m, where neighbours lie beside each other: of cloth the rest coordinates
  MeshIntersections(std::vector<std::array<int, 3>> triangles,
                    const std::vector<Eigen::Vector3d>& positions);

  /// All pairs for which intersect() holds, ascending, until the next call.
  /// @param positions m, each isPlace()
  const std::vector<TrianglePair>& find(const std::vector<Eigen::Vector3d>& positions);

 private:
  void fitBoxes(const std::vector<Eigen::Vector3d>& positions);

  std::vector<std::array<int, 3>> triangles_;
  std::vector<BoxTree::Box> boxes_;
  BoxTree tree_;
  std::vector<TrianglePair> found_;
};

}  // namespace haptex::proximity
