// A triangle mesh in FCL, the second opinion on what a sphere touches.
#pragma once

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "haptex/proximity/kdop_hierarchy.h"

namespace haptex::oracles {

/// @tparam Volume bounding volume of FCL. For others than oriented boxes FCL copies the whole model
///   in every query, and frees the copy by another operator than it allocated it with.
template <typename Volume>
class FclSheet {
 public:
  /// @param triangles indices of the positions (m)
  FclSheet(const std::vector<std::array<int, 3>>& triangles,
           const std::vector<Eigen::Vector3d>& positions) {
    std::vector<fcl::Triangle> corners;
    for (const auto& t : triangles) corners.emplace_back(t[0], t[1], t[2]);
    model_.beginModel();
    model_.addSubModel(positions, corners);
    model_.endModel();
  }

  /// @param positions m, as many as before
  void refit(const std::vector<Eigen::Vector3d>& positions) {
    model_.beginReplaceModel();
    model_.replaceSubModel(positions);
    model_.endReplaceModel(true, true);
  }

  /// The triangles that a sphere touches, in ascending order.
  std::vector<int> touched(const proximity::Sphere& sphere) const {
    const fcl::CollisionRequestd request(static_cast<std::size_t>(model_.num_tris), false);
    fcl::CollisionResultd result;
    const fcl::Sphered shape(sphere.radius);
    fcl::collide(&model_, fcl::Transform3d::Identity(), &shape,
                 fcl::Transform3d(Eigen::Translation3d(sphere.centre)), request, result);
    std::vector<int> triangles;
    triangles.reserve(result.numContacts());
    for (std::size_t i = 0; i < result.numContacts(); ++i) {
      triangles.push_back(static_cast<int>(result.getContact(i).b1));
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
  }

 private:
  fcl::BVHModel<Volume> model_;
};

/// Whether FCL finds the elements that a hierarchy finds in touch with a sphere. Either may be
/// right about those whose distance is at most `touching`.
/// @param touching m, >= 0
template <typename Volume>
bool agree(const proximity::KdopHierarchy& hierarchy, const FclSheet<Volume>& sheet,
           const proximity::Sphere& sphere, double touching) {
  std::vector<proximity::NearElement> found;
  hierarchy.query(proximity::Cursor::spheres({sphere}), {touching}, found);
  std::vector<int> possible, sure;
  for (const proximity::NearElement& element : found) {
    possible.push_back(element.triangle);
    if (element.distance < -touching) sure.push_back(element.triangle);
  }
  std::sort(possible.begin(), possible.end());
  std::sort(sure.begin(), sure.end());
  const std::vector<int> of_fcl = sheet.touched(sphere);
  return std::includes(of_fcl.begin(), of_fcl.end(), sure.begin(), sure.end()) &&
         std::includes(possible.begin(), possible.end(), of_fcl.begin(), of_fcl.end());
}

}  // namespace haptex::oracles
