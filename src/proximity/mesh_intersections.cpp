#include "haptex/proximity/mesh_intersections.h"

#include <algorithm>
#include <utility>

namespace haptex::proximity {

using Eigen::Vector3d;

MeshIntersections::MeshIntersections(std::vector<std::array<int, 3>> triangles,
                                     const std::vector<Vector3d>& positions)
    : triangles_(std::move(triangles)),
      boxes_(triangles_.size(), BoxTree::Box(Vector3d::Zero(), Vector3d::Zero())),
      tree_(boxes_) {
  fitBoxes(positions);
  tree_ = BoxTree(boxes_);
}

void MeshIntersections::fitBoxes(const std::vector<Vector3d>& positions) {
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    boxes_[t].setEmpty();
    for (const int corner : triangles_[t]) boxes_[t].extend(positions[corner]);
  }
}

const std::vector<TrianglePair>& MeshIntersections::find(const std::vector<Vector3d>& positions) {
  fitBoxes(positions);
  tree_.refit(boxes_);
  found_.clear();
  for (int first = 0; first < static_cast<int>(triangles_.size()); ++first) {
    tree_.visit(boxes_[first], [&](int second) {
      if (second <= first || !intersect(positions, triangles_[first], triangles_[second])) return;
      found_.push_back({first, second});
    });
  }
  std::sort(found_.begin(), found_.end());
  return found_;
}

}  // namespace haptex::proximity
