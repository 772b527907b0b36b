// Which triangles of a mesh intersect: the judge of everything that is to prevent it. It shares no
// code with what detects nearness, and it is exact.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace haptex::proximity {

/// Whether two triangles of a mesh have a point in common beyond the vertices and the edge that
/// they share by index. Touching and overlap in a plane count. A triangle without area counts as
/// the segment or point that it is. Exact: all decisions are those of orientation(), which see for
/// coordinates that are allowed.
/// @param first, second vertex indices, not checked
bool intersect(const std::vector<Eigen::Vector3d>& positions, const std::array<int, 3>& first,
               const std::array<int, 3>& second);

/// Whether a segment goes through a triangle, from one side of its plane to the other. Its border
/// counts. Exact, likewise.
/// @param segment, triangle vertex indices, not checked
bool passesThrough(const std::vector<Eigen::Vector3d>& positions, const std::array<int, 2>& segment,
                   const std::array<int, 3>& triangle);

/// Brings the vertices that two triangles share to the beginning of both, in the same order.
/// @return how many they are
int bringSharedFirst(std::array<int, 3>& first, std::array<int, 3>& second);

/// Two triangles, by index, the smaller one first.
using TrianglePair = std::array<int, 2>;

/// All pairs for which intersect() holds, ascending. Pairs whose boxes overlap are found by
/// sweeping a plane along the longest side of the mesh.
/// @param positions m
/// @param triangles vertex indices
/// @throws std::invalid_argument naming a position that is not finite or beyond kMaxLength, or a
///   triangle with an index outside of the positions
std::vector<TrianglePair> intersectingTriangles(const std::vector<Eigen::Vector3d>& positions,
                                                const std::vector<std::array<int, 3>>& triangles);

/// How many they are.
std::size_t countIntersections(const std::vector<Eigen::Vector3d>& positions,
                               const std::vector<std::array<int, 3>>& triangles);

}  // namespace haptex::proximity
