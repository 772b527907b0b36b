#include "haptex/garment/placement/seam_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace haptex::garment {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double kFlattening = 1e-3;  // m

double signedArea(const Outline& outline) {
  double area = 0.0;
  for (const Edge& edge : outline) area += edge.curve.sweptArea();
  return area;
}

/// Point and outward direction on one side of a seam, at a share of its length from its start.
void setSide(const Pattern& pattern, const SeamSide& side, double share, int index,
             SeamPoint& point) {
  const Panel& panel = pattern.panels[side.panel];
  const Outline& outline = panel.outlines[side.outline];
  const double total = lengthOf(pattern, side);
  double length = total * (side.reversed ? 1.0 - share : share);
  const std::vector<int> edges = edgesOf(pattern, side);
  std::size_t i = 0;
  while (i + 1 < edges.size() && length > outline[edges[i]].curve.length()) {
    length -= outline[edges[i]].curve.length();
    ++i;
  }
  const Curve& curve = outline[edges[i]].curve;
  const double t = curve.parameterAt(length), step = 1e-4;
  const Vector2d along =
      (curve.at(std::min(1.0, t + step)) - curve.at(std::max(0.0, t - step))).normalized();
  // On the right of an outline that runs counter-clockwise; into a hole on its left.
  const bool on_right = (signedArea(outline) > 0.0) == (side.outline == 0);
  const Vector2d right(along.y(), -along.x());
  point.points[index] = curve.at(t);
  point.outward[index] = on_right ? right : Vector2d(-right);
}

}  // namespace

PanelView::PanelView(const Panel& panel, double turn) {
  matrix_ = Eigen::Rotation2Dd(turn).toRotationMatrix();
  if (isTurnedOver(panel)) matrix_.col(0) *= -1.0;
  const double far = std::numeric_limits<double>::infinity();
  Vector2d low(far, far), high(-far, -far);
  for (const Edge& edge : panel.outlines.front()) {
    for (const Vector2d& point : edge.curve.flattened(kFlattening)) {
      outline_.push_back(matrix_ * point);
      low = low.cwiseMin(outline_.back());
      high = high.cwiseMax(outline_.back());
    }
  }
  middle_ = 0.5 * (low + high);
  half_height_ = 0.5 * (high - low).y();
  for (Vector2d& point : outline_) point -= middle_;
}

double PanelView::widthAt(double height) const {
  double left = std::numeric_limits<double>::infinity(), right = -left;
  for (std::size_t i = 0; i < outline_.size(); ++i) {
    const Vector2d &a = outline_[i], &b = outline_[(i + 1) % outline_.size()];
    if ((a.y() < height) == (b.y() < height)) continue;
    const double x = a.x() + (b.x() - a.x()) * (height - a.y()) / (b.y() - a.y());
    left = std::min(left, x);
    right = std::max(right, x);
  }
  return std::max(0.0, right - left);
}

std::vector<SeamPoint> seamPoints(const Pattern& pattern, const Seam& seam, int count) {
  std::vector<SeamPoint> points(count);
  for (int i = 0; i < count; ++i) {
    for (int side = 0; side < 2; ++side) {
      setSide(pattern, seam.sides[side], (i + 0.5) / count, side, points[i]);
    }
  }
  return points;
}

}  // namespace haptex::garment
