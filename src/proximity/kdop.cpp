#include "haptex/proximity/kdop.h"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

namespace haptex::proximity {
namespace {

using Eigen::Vector3d;
using Axes = std::vector<Vector3d>;

const Axes kFaces = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const Axes kCorners = {{1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};
const Axes kEdges = {{1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}};

Axes join(std::initializer_list<Axes> groups) {
  Axes axes;
  for (const Axes& group : groups) axes.insert(axes.end(), group.begin(), group.end());
  return axes;
}

using Polygon = std::vector<Vector3d>;

/// How far a place lies beyond the plane of a half-space (m), negative inside.
double beyond(const HalfSpace& half_space, const Vector3d& place) {
  return (half_space.normal.dot(place) - half_space.height) / half_space.normal.norm();
}

/// The part of a polygon inside a half-space, after Sutherland and Hodgman (1974). Corners beyond
/// the plane by less than `slack` stay, so that flat volumes keep their two faces.
Polygon clip(const Polygon& polygon, const HalfSpace& half_space, double slack) {
  Polygon inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d& begin = polygon[i];
    const Vector3d& end = polygon[(i + 1) % polygon.size()];
    const double from = beyond(half_space, begin), to = beyond(half_space, end);
    if (from <= slack) inside.push_back(begin);
    if ((from <= slack) != (to <= slack)) {
      inside.push_back(begin + (end - begin) * (from / (from - to)));
    }
  }
  return inside;
}

Polygon withoutDoubleCorners(const Polygon& polygon, double resolution) {
  Polygon corners;
  for (const Vector3d& corner : polygon) {
    if (corners.empty() || (corner - corners.back()).norm() > resolution) corners.push_back(corner);
  }
  while (corners.size() > 1 && (corners.front() - corners.back()).norm() <= resolution) {
    corners.pop_back();
  }
  return corners;
}

bool hasArea(const Polygon& polygon, double resolution) {
  Vector3d area = Vector3d::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    area += 0.5 * (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  }
  return area.norm() > resolution * resolution;
}

/// A square in the plane of a half-space, counter-clockwise seen from beyond it.
Polygon square(const HalfSpace& half_space, const Vector3d& centre, double half_side) {
  const Vector3d normal = half_space.normal.normalized();
  const Vector3d foot = centre - normal * beyond(half_space, centre);
  const Vector3d u = normal.unitOrthogonal() * half_side, v = normal.cross(u);
  return {foot - u - v, foot + u - v, foot + u + v, foot - u + v};
}

}  // namespace

const Axes& kdopAxes(KdopKind kind) {
  static const Axes axes[] = {kFaces, join({kFaces, kCorners}), join({kFaces, kEdges}),
                              join({kFaces, kCorners, kEdges})};
  return axes[static_cast<int>(kind)];
}

std::vector<Polygon> polytopeFaces(const Kdop& kdop, double resolution) {
  // The first three pairs of normals are the coordinate axes.
  Vector3d upper, lower;
  for (int k = 0; k < 3; ++k) {
    upper[k] = kdop[2 * k].height;
    lower[k] = -kdop[2 * k + 1].height;
  }
  const Vector3d centre = 0.5 * (lower + upper);
  const double half_side = (upper - lower).norm() + resolution;
  std::vector<Polygon> faces;
  for (std::size_t i = 0; i < kdop.size(); ++i) {
    Polygon face = square(kdop[i], centre, half_side);
    for (std::size_t j = 0; j < kdop.size() && !face.empty(); ++j) {
      if (j != i) face = clip(face, kdop[j], 0.1 * resolution);
    }
    face = withoutDoubleCorners(face, resolution);
    if (hasArea(face, resolution)) faces.push_back(std::move(face));
  }
  return faces;
}

}  // namespace haptex::proximity
