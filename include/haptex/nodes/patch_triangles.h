// Which triangles of the cloth a patch is made of. Knows no ROS.
#pragma once

#include <cstddef>
#include <vector>

namespace haptex::nodes {

/// A triangle found near a fingertip.
struct NearTriangle {
  int triangle;
  double excess;  ///< m, how much further away than a patch has to reach; negative: nearer
};

/// Keeps the set while it is good enough, so that a patch does not change whenever a fingertip
/// moves by a micrometre: a new one is made only when a triangle is missing that has to be there,
/// or one is there whose excess is beyond the slack. The new set reaches to half the slack.
class PatchTriangles {
 public:
  /// @param slack m, > 0
  explicit PatchTriangles(double slack) : slack_(slack) {}

  /// @param found all triangles with an excess up to the slack, in any order, repetition allowed
  /// @returns whether the set has changed
  bool update(const std::vector<NearTriangle>& found);

  /// Sorted, each once.
  const std::vector<int>& triangles() const { return triangles_; }

 private:
  bool isGoodEnough(const std::vector<NearTriangle>& found) const;

  double slack_;
  std::vector<int> triangles_;
};

}  // namespace haptex::nodes
