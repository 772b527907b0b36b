#include "haptex/proximity/mesh_intersections.h"

#include <algorithm>
#include <utility>

namespace haptex::proximity {

using Eigen::Vector3d;

namespace {

using Corners = std::array<Vector3d, 3>;

/// Whether a plane between two triangles, through what they share, tells that they have nothing
/// else in common: by doubles, with a margin far beyond rounding. Spares neighbours in flat cloth,
/// which lie in one plane, the exact test.
bool isSurelyApart(const std::vector<Vector3d>& positions, std::array<int, 3> s,
                   std::array<int, 3> t) {
  constexpr double kMargin = 1e-9;
  const int shared = bringSharedFirst(s, t);
  if (shared == 3) return false;
  Corners of_s, of_t;  // from the first shared corner, or one of them
  for (int i = 0; i < 3; ++i) {
    of_s[i] = positions[s[i]] - positions[s[0]];
    of_t[i] = positions[t[i]] - positions[s[0]];
  }
  Vector3d across;
  if (shared == 0) {
    across = (of_t[0] + of_t[1] + of_t[2]) - (of_s[0] + of_s[1] + of_s[2]);
  } else if (shared == 1) {
    across = (of_t[1].normalized() + of_t[2].normalized()) -
             (of_s[1].normalized() + of_s[2].normalized());
  } else {
    const Vector3d edge = of_s[1].normalized();
    across = of_t[2].normalized() - of_s[2].normalized();
    across -= edge.dot(across) * edge;
  }
  double highest = shared == 0 ? of_s[0].dot(across) : -1e300;
  double lowest = shared == 0 ? of_t[0].dot(across) : 1e300, largest = 0.0;
  for (int i = 0; i < 3; ++i) {
    largest = std::max({largest, of_s[i].norm(), of_t[i].norm()});
    if (i < shared) continue;
    highest = std::max(highest, of_s[i].dot(across));
    lowest = std::min(lowest, of_t[i].dot(across));
  }
  const double margin = kMargin * largest * across.norm();
  return shared == 0 ? lowest - highest > margin : highest < -margin && lowest > margin;
}

}  // namespace

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
      if (second <= first) return;
      if (isSurelyApart(positions, triangles_[first], triangles_[second])) return;
      if (!intersect(positions, triangles_[first], triangles_[second])) return;
      found_.push_back({first, second});
    });
  }
  std::sort(found_.begin(), found_.end());
  return found_;
}

}  // namespace haptex::proximity
