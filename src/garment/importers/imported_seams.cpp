#include "haptex/garment/importers/imported_seams.h"

#include <algorithm>
#include <cmath>

namespace haptex::garment {
namespace {

using Eigen::Vector3d;

// Where the outline enters and leaves the edges of a side, in the world frame.
std::array<Vector3d, 2> endsOf(const Pattern& pattern, const SeamSide& side) {
  const Panel& panel = pattern.panels[side.panel];
  const Outline& outline = panel.outlines[side.outline];
  const auto& pose = std::get<Eigen::Isometry3d>(panel.placement);
  const Eigen::Vector2d& first = outline[side.first].curve.start();
  const Eigen::Vector2d& last = outline[side.last].curve.end();
  return {pose * Vector3d(first.x(), first.y(), 0.0), pose * Vector3d(last.x(), last.y(), 0.0)};
}

}  // namespace

bool oppositeEndsMeet(const Pattern& pattern, const Seam& seam) {
  const auto a = endsOf(pattern, seam.sides[0]), b = endsOf(pattern, seam.sides[1]);
  const double same = (a[0] - b[0]).squaredNorm() + (a[1] - b[1]).squaredNorm();
  const double opposite = (a[0] - b[1]).squaredNorm() + (a[1] - b[0]).squaredNorm();
  return !(same < 0.5 * opposite);
}

double easingOf(const Pattern& pattern, const Seam& seam) {
  const double needed = std::ceil(1000.0 * lengthDifference(pattern, seam)) / 1000.0;
  return std::clamp(needed, kUsualEasing, kLargestEasing);
}

}  // namespace haptex::garment
