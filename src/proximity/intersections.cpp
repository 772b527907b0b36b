#include "haptex/proximity/intersections.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

#include "haptex/proximity/cursor.h"
#include "haptex/proximity/exact_orientation.h"

namespace haptex::proximity {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 3>;

/// Whether a place that lies on the line through two points lies between them, too.
bool isBetween(const Vector3d& place, const Vector3d& begin, const Vector3d& end) {
  for (int k = 0; k < 3; ++k) {
    if (place[k] < std::min(begin[k], end[k]) || place[k] > std::max(begin[k], end[k]))
      return false;
  }
  return true;
}

/// A coordinate axis along which the projected triangle has an area, or -1: the three are in a
/// line.
int axisOfArea(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  for (int axis = 0; axis < 3; ++axis) {
    if (projectedOrientation(a, b, c, axis) != 0) return axis;
  }
  return -1;
}

bool isOnSegment(const Vector3d& place, const Vector3d& begin, const Vector3d& end) {
  return isBetween(place, begin, end) && axisOfArea(place, begin, end) < 0;
}

/// Whether two segments in a plane meet that is not seen from its side along the axis.
bool segmentsMeet(const Vector3d& p, const Vector3d& q, const Vector3d& a, const Vector3d& b,
                  int axis) {
  const int of_a = projectedOrientation(p, q, a, axis), of_b = projectedOrientation(p, q, b, axis);
  const int of_p = projectedOrientation(a, b, p, axis), of_q = projectedOrientation(a, b, q, axis);
  if (of_a * of_b < 0 && of_p * of_q < 0) return true;
  return (of_a == 0 && isBetween(a, p, q)) || (of_b == 0 && isBetween(b, p, q)) ||
         (of_p == 0 && isBetween(p, a, b)) || (of_q == 0 && isBetween(q, a, b));
}

bool segmentsMeet(const Vector3d& p, const Vector3d& q, const Vector3d& a, const Vector3d& b) {
  if (orientation(p, q, a, b) != 0) return false;
  int axis = axisOfArea(p, q, a);
  if (axis < 0) axis = axisOfArea(p, q, b);
  if (axis < 0) axis = axisOfArea(a, b, p);
  if (axis < 0) axis = axisOfArea(a, b, q);
  if (axis >= 0) return segmentsMeet(p, q, a, b, axis);
  return isBetween(a, p, q) || isBetween(b, p, q) || isBetween(p, a, b) || isBetween(q, a, b);
}

/// Whether none of three signs is opposite to another.
bool agree(int a, int b, int c) {
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

bool isInPlanarTriangle(const Vector3d& place, const Corners& t, int axis) {
  return agree(projectedOrientation(t[0], t[1], place, axis),
               projectedOrientation(t[1], t[2], place, axis),
               projectedOrientation(t[2], t[0], place, axis));
}

bool isInTriangle(const Vector3d& place, const Corners& t) {
  const int axis = axisOfArea(t[0], t[1], t[2]);
  if (axis < 0) {
    return isOnSegment(place, t[0], t[1]) || isOnSegment(place, t[1], t[2]) ||
           isOnSegment(place, t[2], t[0]);
  }
  return orientation(t[0], t[1], t[2], place) == 0 && isInPlanarTriangle(place, t, axis);
}

/// Of a line through two points that is not in the triangle's plane. The border counts.
bool lineMeetsTriangle(const Vector3d& p, const Vector3d& q, const Corners& t) {
  return agree(orientation(p, q, t[0], t[1]), orientation(p, q, t[1], t[2]),
               orientation(p, q, t[2], t[0]));
}

bool segmentMeetsTriangle(const Vector3d& p, const Vector3d& q, const Corners& t) {
  const int axis = axisOfArea(t[0], t[1], t[2]);
  if (axis < 0) {
    return segmentsMeet(p, q, t[0], t[1]) || segmentsMeet(p, q, t[1], t[2]) ||
           segmentsMeet(p, q, t[2], t[0]);
  }
  const int of_p = orientation(t[0], t[1], t[2], p), of_q = orientation(t[0], t[1], t[2], q);
  if (of_p * of_q > 0) return false;
  if (of_p == 0 && of_q == 0) {
    if (isInPlanarTriangle(p, t, axis) || isInPlanarTriangle(q, t, axis)) return true;
    for (int i = 0; i < 3; ++i) {
      if (segmentsMeet(p, q, t[i], t[(i + 1) % 3], axis)) return true;
    }
    return false;
  }
  return lineMeetsTriangle(p, q, t);
}

/// Two triangles that have nothing to do with each other: an edge of one meets the other.
bool intersectApart(const Corners& s, const Corners& t) {
  for (int i = 0; i < 3; ++i) {
    if (segmentMeetsTriangle(s[i], s[(i + 1) % 3], t)) return true;
    if (segmentMeetsTriangle(t[i], t[(i + 1) % 3], s)) return true;
  }
  return false;
}

/// Whether the edge opposite of the shared corner, which comes first, meets the other triangle
/// elsewhere.
bool oppositeEdgeMeets(const Corners& s, const Corners& t) {
  for (int i = 1; i < 3; ++i) {
    if (s[i] != s[0] && isInTriangle(s[i], t)) return true;
  }
  return !isOnSegment(s[0], s[1], s[2]) && segmentMeetsTriangle(s[1], s[2], t);
}

/// Two triangles that share their first corner. What they have in common is convex. If it holds
/// more than the corner, it holds a way from there to where the first of them ends: at its opposite
/// edge.
bool intersectAtCorner(const Corners& s, const Corners& t) {
  return oppositeEdgeMeets(s, t) || oppositeEdgeMeets(t, s);
}

/// Two triangles that share the edge from their first to their second corner: they have more in
/// common if they lie in a plane on the same side of it.
bool intersectAtEdge(const Corners& s, const Corners& t) {
  if (orientation(s[0], s[1], s[2], t[2]) != 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const int of_s = projectedOrientation(s[0], s[1], s[2], axis);
    const int of_t = projectedOrientation(s[0], s[1], t[2], axis);
    if (of_s * of_t != 0) return of_s == of_t;
  }
  // At least one of them is no more than a segment.
  return (isInTriangle(s[2], t) && !isOnSegment(s[2], s[0], s[1])) ||
         (isInTriangle(t[2], s) && !isOnSegment(t[2], s[0], s[1]));
}

void requireMesh(const std::vector<Vector3d>& positions,
                 const std::vector<std::array<int, 3>>& triangles) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!isPlace(positions[i])) requirePlace(positions[i], "position " + std::to_string(i));
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (int vertex : triangles[i]) {
      if (vertex >= 0 && static_cast<std::size_t>(vertex) < positions.size()) continue;
      throw std::invalid_argument("triangle " + std::to_string(i) + " has vertex " +
                                  std::to_string(vertex) + ": there are " +
                                  std::to_string(positions.size()) + " positions");
    }
  }
}

std::vector<Eigen::AlignedBox3d> boxesOf(const std::vector<Vector3d>& positions,
                                         const std::vector<std::array<int, 3>>& triangles) {
  std::vector<Eigen::AlignedBox3d> boxes(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (int vertex : triangles[i]) boxes[i].extend(positions[vertex]);
  }
  return boxes;
}

}  // namespace

int bringSharedFirst(std::array<int, 3>& first, std::array<int, 3>& second) {
  int shared = 0;
  for (int i = 0; i < 3; ++i) {
    const auto same = std::find(second.begin() + shared, second.end(), first[i]);
    if (same == second.end()) continue;
    std::iter_swap(second.begin() + shared, same);
    std::swap(first[shared], first[i]);
    ++shared;
  }
  return shared;
}

bool passesThrough(const std::vector<Vector3d>& positions, const std::array<int, 2>& segment,
                   const std::array<int, 3>& triangle) {
  const Vector3d &p = positions[segment[0]], &q = positions[segment[1]];
  const Corners t = {positions[triangle[0]], positions[triangle[1]], positions[triangle[2]]};
  return orientation(t[0], t[1], t[2], p) * orientation(t[0], t[1], t[2], q) < 0 &&
         lineMeetsTriangle(p, q, t);
}

bool intersect(const std::vector<Vector3d>& positions, const std::array<int, 3>& first,
               const std::array<int, 3>& second) {
  std::array<int, 3> s = first, t = second;
  const int shared = bringSharedFirst(s, t);
  const Corners of_s = {positions[s[0]], positions[s[1]], positions[s[2]]};
  const Corners of_t = {positions[t[0]], positions[t[1]], positions[t[2]]};
  switch (shared) {
    case 0:
      return intersectApart(of_s, of_t);
    case 1:
      return intersectAtCorner(of_s, of_t);
    case 2:
      return intersectAtEdge(of_s, of_t);
    default:
      return true;  // the same triangle twice
  }
}

std::vector<TrianglePair> intersectingTriangles(const std::vector<Vector3d>& positions,
                                                const std::vector<std::array<int, 3>>& triangles) {
  requireMesh(positions, triangles);
  std::vector<TrianglePair> found;
  if (triangles.empty()) return found;
  const std::vector<Eigen::AlignedBox3d> boxes = boxesOf(positions, triangles);
  Eigen::AlignedBox3d all;
  for (const auto& box : boxes) all.extend(box);
  int axis;
  all.sizes().maxCoeff(&axis);
  std::vector<int> order(triangles.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::make_pair(boxes[a].min()[axis], a) < std::make_pair(boxes[b].min()[axis], b);
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Eigen::AlignedBox3d& box = boxes[order[i]];
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const Eigen::AlignedBox3d& other = boxes[order[j]];
      if (other.min()[axis] > box.max()[axis]) break;
      if (!box.intersects(other)) continue;
      if (!intersect(positions, triangles[order[i]], triangles[order[j]])) continue;
      found.push_back({std::min(order[i], order[j]), std::max(order[i], order[j])});
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::size_t countIntersections(const std::vector<Vector3d>& positions,
                               const std::vector<std::array<int, 3>>& triangles) {
  return intersectingTriangles(positions, triangles).size();
}

}  // namespace haptex::proximity
