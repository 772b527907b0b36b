// Panels as they lie on a carrier, and the places along their seams that are to meet.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/garment/pattern/pattern.h"

namespace haptex::garment {

/// From a panel's plane to offsets from its middle as seen from the right side of the fabric, x to
/// the right and y up the carrier (m). The middle is that of the smallest upright rectangle around
/// it once it is turned.
class PanelView {
 public:
  /// @param turn rad, counter-clockwise as seen from the right side
  PanelView(const Panel& panel, double turn);

  Eigen::Vector2d offsetOf(const Eigen::Vector2d& point) const { return matrix_ * point - middle_; }
  Eigen::Vector2d directionOf(const Eigen::Vector2d& direction) const {
    return matrix_ * direction;
  }
  /// Of the outline, lines within 1 mm of it.
  const std::vector<Eigen::Vector2d>& outline() const { return outline_; }
  /// From below its middle to its top: half its height (m).
  double halfHeight() const { return half_height_; }
  /// m, from the leftmost to the rightmost point of the outline at that height above its middle; 0
  /// where it does not reach.
  double widthAt(double height) const;

 private:
  Eigen::Matrix2d matrix_;
  Eigen::Vector2d middle_ = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> outline_;
  double half_height_ = 0.0;
};

/// A place along a seam on either side, as points of the panels' planes, with the directions there
/// that point out of the fabric.
struct SeamPoint {
  std::array<Eigen::Vector2d, 2> points;
  std::array<Eigen::Vector2d, 2> outward;  ///< of length 1
};

/// Places in the middle of so many equal parts of a seam.
std::vector<SeamPoint> seamPoints(const Pattern& pattern, const Seam& seam, int count);

}  // namespace haptex::garment
