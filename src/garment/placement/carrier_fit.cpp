#include "haptex/garment/placement/carrier_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "haptex/base/require.h"

namespace haptex::garment {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// How far (m) beyond a range of heights the body is looked at, as its triangles reach over it.
constexpr double kBeyond = 0.02;

/// Corners of the line above all points that bends downwards only, by height.
std::vector<NeededRadius> upperHull(std::vector<NeededRadius> points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return a.height < b.height || (a.height == b.height && a.radius > b.radius);
  });
  std::vector<NeededRadius> hull;
  for (const NeededRadius& point : points) {
    if (!hull.empty() && point.height == hull.back().height) continue;
    while (hull.size() > 1) {
      const NeededRadius &a = hull[hull.size() - 2], &b = hull.back();
      const double turn = (b.height - a.height) * (point.radius - a.radius) -
                          (b.radius - a.radius) * (point.height - a.height);
      if (turn < 0.0) break;
      hull.pop_back();
    }
    hull.push_back(point);
  }
  return hull;
}

/// Of the piece of the hull above the middle of its heights.
double slopeAtMiddle(const std::vector<NeededRadius>& hull) {
  const double middle = 0.5 * (hull.front().height + hull.back().height);
  for (std::size_t i = 1; i < hull.size(); ++i) {
    if (hull[i].height < middle) continue;
    return (hull[i - 1].radius - hull[i].radius) / (hull[i].height - hull[i - 1].height);
  }
  return 0.0;
}

}  // namespace

SegmentAxis::SegmentAxis(const Body& body, int segment) {
  const Segment& of = body.segments[segment];
  starts_below_ = of.start.z() <= of.end.z();
  const Vector3d &low = starts_below_ ? of.start : of.end,
                 &high = starts_below_ ? of.end : of.start;
  length_ = (high - low).norm();
  if (!(length_ > 0.0)) {
    base::refuse("segment '", of.name, "' has no length: there can be no carrier around it");
  }
  axis_.origin = low;
  axis_.up = (high - low) / length_;
  const bool along_x = std::abs(axis_.up.x()) > 0.9;
  const Vector3d forward = along_x ? Vector3d::UnitZ() : Vector3d::UnitX();
  axis_.front = (forward - forward.dot(axis_.up) * axis_.up).normalized();
  for (std::size_t i = 0; i < body.vertices.size(); ++i) {
    const Segment& other = body.segments[body.shares[i].front().segment];
    if (other.chain == of.chain || other.within == of.chain) vertices_.push_back(body.vertices[i]);
  }
}

void SegmentAxis::centre(const HeightRange& range) {
  const Vector3d left = axis_.up.cross(axis_.front);
  std::vector<Vector2d> points;
  for (const Vector3d& vertex : vertices_) {
    const Vector3d offset = vertex - axis_.origin;
    const double height = offset.dot(axis_.up);
    if (height < range.low - kBeyond || height > range.high + kBeyond) continue;
    points.emplace_back(offset.dot(axis_.front), offset.dot(left));
  }
  if (points.empty()) return;
  Vector2d centre = Vector2d::Zero();
  for (int step = 1; step <= 200; ++step) {
    const auto farthest =
        std::max_element(points.begin(), points.end(), [&](const Vector2d& a, const Vector2d& b) {
          return (a - centre).squaredNorm() < (b - centre).squaredNorm();
        });
    centre += (*farthest - centre) / (step + 1.0);
  }
  axis_.origin += centre.x() * axis_.front + centre.y() * left;
}

std::vector<NeededRadius> SegmentAxis::bodyRadii(const HeightRange& range) const {
  std::vector<NeededRadius> radii;
  for (const Vector3d& vertex : vertices_) {
    const Vector3d offset = vertex - axis_.origin;
    const double height = offset.dot(axis_.up);
    if (height < range.low - kBeyond || height > range.high + kBeyond) continue;
    radii.push_back({height, (offset - height * axis_.up).norm()});
  }
  return radii;
}

void fitRadius(Carrier::Shape shape, const std::vector<NeededRadius>& needed,
               CarrierSurface& surface) {
  const double slope = shape == Carrier::Shape::kCone ? slopeAtMiddle(upperHull(needed)) : 0.0;
  surface.slope = std::clamp(slope, -kSteepestCone, kSteepestCone);
  surface.radius = -std::numeric_limits<double>::infinity();
  for (const NeededRadius& here : needed) {
    surface.radius = std::max(surface.radius, here.radius + surface.slope * here.height);
  }
}

}  // namespace haptex::garment
