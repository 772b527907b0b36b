// What a proximity query answers, and the slow way to the same answer.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "haptex/proximity/cursor.h"
#include "haptex/proximity/triangle_distance.h"

namespace haptex::proximity {

/// An element of a mesh near a cursor. A cursor may have several parts; what is said here is of the
/// nearest part, of the first one if there are several at the same distance.
struct NearElement {
  int triangle;                 ///< index in the mesh
  int part;                     ///< of the cursor, from 0
  double distance;              ///< m, signed: negative where the element enters the cursor
  Eigen::Vector3d point;        ///< m, of the element, with that distance
  Eigen::Vector3d barycentric;  ///< of the point
  Eigen::Vector3d normal;       ///< unit length; zero for an element without area
};

/// The order of answers: by distance, then by index.
inline bool isNearer(const NearElement& a, const NearElement& b) {
  return a.distance < b.distance || (a.distance == b.distance && a.triangle < b.triangle);
}

/// How far and how many.
struct Range {
  /// m, >= 0, may be infinite: elements at exactly this distance are near. Compared in double
  /// precision with the computed distance.
  double distance = std::numeric_limits<double>::infinity();
  /// Only the nearest so many; of several at the same distance those of smaller index.
  std::size_t count = std::numeric_limits<std::size_t>::max();
};

/// @throws std::invalid_argument naming the value unless the distance is >= 0 (NaN is not)
void requireValid(const Range& range);

/// What both ways tell about one triangle.
NearElement nearElement(int index, const Triangle& triangle, const Cursor& cursor);

/// Asks every triangle: the oracle of KdopHierarchy::query().
/// @returns sorted by distance, then by index
/// @throws std::invalid_argument what requireValid() throws
std::vector<NearElement> nearElementsByBruteForce(const std::vector<std::array<int, 3>>& triangles,
                                                  const std::vector<Eigen::Vector3d>& positions,
                                                  const Cursor& cursor, const Range& range);

}  // namespace haptex::proximity
