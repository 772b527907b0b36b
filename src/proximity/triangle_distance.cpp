#include "haptex/proximity/triangle_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "haptex/proximity/triangle_edges.h"

namespace haptex::proximity {
namespace {

using Eigen::Vector3d;

// sin^2 of the angle at the first corner below which a triangle counts as thin.
constexpr double kThin = 1e-4;

void keepNearer(TrianglePoint& nearest, double distance, const Vector3d& barycentric) {
  if (distance < nearest.distance) nearest = {distance, barycentric};
}

/// Unclamped weights of the projection of a place onto the plane of a triangle with area.
Vector3d projectedWeights(const Vector3d& ab, const Vector3d& ac, const Vector3d& normal,
                          const Vector3d& ap) {
  const double scale = 1.0 / normal.squaredNorm();
  const double v = ap.cross(ac).dot(normal) * scale;
  const double w = ab.cross(ap).dot(normal) * scale;
  return {1.0 - v - w, v, w};
}

/// Compares interior and edges instead of choosing between them.
TrianglePoint closestOnThin(const Triangle& corners, const Vector3d& normal,
                            const Vector3d& place) {
  TrianglePoint nearest{std::numeric_limits<double>::infinity(), Vector3d::Zero()};
  for (int edge = 0; edge < 3; ++edge) {
    const Vector3d& begin = corners[edge];
    const Vector3d& end = corners[(edge + 1) % 3];
    const double t = nearestFraction(place, begin, end);
    keepNearer(nearest, (begin + t * (end - begin) - place).norm(), edgeWeights(edge, t));
  }
  if (normal.squaredNorm() > 0.0) {
    const Vector3d weights = projectedWeights(corners[1] - corners[0], corners[2] - corners[0],
                                              normal, place - corners[0]);
    if (weights.allFinite() && weights.minCoeff() >= 0.0) {
      const TrianglePoint inside{0.0, weights};
      keepNearer(nearest, (inside.on(corners) - place).norm(), weights);
    }
  }
  return nearest;
}

/// The region of the projection tells where the closest point lies.
Vector3d closestWeights(const Triangle& corners, const Vector3d& ab, const Vector3d& ac,
                        const Vector3d& place) {
  const Vector3d ap = place - corners[0];
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {1.0, 0.0, 0.0};
  const Vector3d bp = place - corners[1];
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return {0.0, 1.0, 0.0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    const double t = d1 / (d1 - d3);
    return {1.0 - t, t, 0.0};
  }
  const Vector3d cp = place - corners[2];
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return {0.0, 0.0, 1.0};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    const double t = d2 / (d2 - d6);
    return {1.0 - t, 0.0, t};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0.0, 1.0 - t, t};
  }
  const double scale = 1.0 / (va + vb + vc);
  const double v = vb * scale, w = vc * scale;
  return {std::max(1.0 - v - w, 0.0), v, w};
}

/// Minimum over t in [0, 1] of |p - c(t)| - r(t) for a capsule with axis w, where p - begin lies
/// `along` (times |w|^2) along the axis and `beside` metres beside it. The derivative vanishes
/// where the distance along the axis is beside * dr / sqrt(|w|^2 - dr^2) beyond the foot.
double bestAxisParameter(double along, double beside, double axis_2, double growth) {
  const double slack_2 = axis_2 - growth * growth;
  if (slack_2 <= 0.0) return growth > 0.0 ? 1.0 : 0.0;  // one sphere holds the other
  return std::clamp((along + beside * growth * std::sqrt(axis_2 / slack_2)) / axis_2, 0.0, 1.0);
}

class CapsuleToTriangle {
 public:
  CapsuleToTriangle(const Triangle& corners, const TaperedCapsule& capsule)
      : corners_(corners),
        capsule_(capsule),
        axis_(capsule.end.centre - capsule.begin.centre),
        growth_(capsule.end.radius - capsule.begin.radius) {}

  TrianglePoint nearest() {
    tryEnd(capsule_.begin);
    tryEnd(capsule_.end);
    tryCrossing();
    for (int edge = 0; edge < 3; ++edge) tryEdge(edge);
    return nearest_;
  }

 private:
  Vector3d centre(double t) const { return capsule_.begin.centre + t * axis_; }
  double radius(double t) const { return capsule_.begin.radius + t * growth_; }

  void tryEnd(const Sphere& sphere) {
    const TrianglePoint point = closestPoint(corners_, sphere.centre);
    keepNearer(nearest_, point.distance - sphere.radius, point.barycentric);
  }

  /// Seen from the interior, the distance along the axis has a kink where the axis crosses.
  void tryCrossing() {
    const Vector3d ab = corners_[1] - corners_[0], ac = corners_[2] - corners_[0];
    const Vector3d normal = ab.cross(ac);
    const double begin = normal.dot(capsule_.begin.centre - corners_[0]);
    const double end = normal.dot(capsule_.end.centre - corners_[0]);
    if (begin * end >= 0.0) return;  // an end is as near
    const double t = begin / (begin - end);
    const Vector3d weights = projectedWeights(ab, ac, normal, centre(t) - corners_[0]);
    if (!weights.allFinite() || weights.minCoeff() < 0.0) return;
    const TrianglePoint crossing{0.0, weights};
    keepNearer(nearest_, (crossing.on(corners_) - centre(t)).norm() - radius(t), weights);
  }

  /// The best t for the whole line of an edge; if its point lies beyond an end of the edge, that
  /// end is best, by convexity.
  void tryEdge(int edge) {
    const Vector3d& begin = corners_[edge];
    const Vector3d& end = corners_[(edge + 1) % 3];
    const Vector3d along = end - begin;
    const double length_2 = along.squaredNorm();
    double s = 0.0;
    if (length_2 > 0.0) {
      const auto across = [&](const Vector3d& v) -> Vector3d {
        return v - along * (along.dot(v) / length_2);
      };
      const Vector3d axis = across(axis_), offset = across(begin - capsule_.begin.centre);
      s = nearestFraction(centre(bestParameter(axis, offset)), begin, end);
    }
    const Vector3d point = begin + s * along;
    const double t = bestParameter(axis_, point - capsule_.begin.centre);
    keepNearer(nearest_, (point - centre(t)).norm() - radius(t), edgeWeights(edge, s));
  }

  double bestParameter(const Vector3d& axis, const Vector3d& offset) const {
    const double axis_2 = axis.squaredNorm();
    if (axis_2 == 0.0) return growth_ > 0.0 ? 1.0 : 0.0;
    const double along = axis.dot(offset);
    const double beside = (offset - axis * (along / axis_2)).norm();
    return bestAxisParameter(along, beside, axis_2, growth_);
  }

  const Triangle& corners_;
  const TaperedCapsule& capsule_;
  Vector3d axis_;
  double growth_;
  TrianglePoint nearest_{std::numeric_limits<double>::infinity(), Vector3d::Zero()};
};

}  // namespace

TrianglePoint closestPoint(const Triangle& corners, const Vector3d& place) {
  const Vector3d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
  const Vector3d normal = ab.cross(ac);
  if (!(normal.squaredNorm() > kThin * ab.squaredNorm() * ac.squaredNorm())) {
    return closestOnThin(corners, normal, place);
  }
  TrianglePoint nearest{0.0, closestWeights(corners, ab, ac, place)};
  nearest.distance = (nearest.on(corners) - place).norm();
  return nearest;
}

TrianglePoint closestPoint(const Triangle& triangle, const TaperedCapsule& capsule) {
  if (capsule.isSphere()) {
    TrianglePoint nearest = closestPoint(triangle, capsule.begin.centre);
    nearest.distance -= capsule.begin.radius;
    return nearest;
  }
  return CapsuleToTriangle(triangle, capsule).nearest();
}

Vector3d unitNormal(const Triangle& corners) {
  const Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double length = normal.norm();
  if (!(length > 0.0)) return Vector3d::Zero();
  return normal / length;
}

}  // namespace haptex::proximity
