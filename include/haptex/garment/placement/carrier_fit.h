// Cylinders and cones around a part of a body.
#pragma once

#include <utility>
#include <vector>

#include "haptex/garment/body/body.h"
#include "haptex/garment/pattern/pattern.h"
#include "haptex/garment/placement/carrier_surface.h"

namespace haptex::garment {

/// Steepest slope of a cone.
constexpr double kSteepestCone = 0.6;

/// Heights along an axis, m.
struct HeightRange {
  double low = 0.0, high = 0.0;
};

/// How large a radius has to be somewhere, m.
struct NeededRadius {
  double height = 0.0;
  double radius = 0.0;
};

/// The axis of a segment, from its lower end (height 0) to the higher one, and what of the body is
/// around it: all vertices that belong most to a segment of its chain or of one within it.
class SegmentAxis {
 public:
  /// Along the segment, with its front towards the world's x, or towards z for a segment along x.
  /// @param segment of the body
  /// @throws std::invalid_argument naming it if it has no length
  SegmentAxis(const Body& body, int segment);

  /// Shifts the axis to the middle of the smallest circle around what of the body lies between
  /// these heights (Badoiu and Clarkson 2003, 200 steps: to half a percent of its radius or so).
  void centre(const HeightRange& range);

  /// Of the body between these heights.
  std::vector<NeededRadius> bodyRadii(const HeightRange& range) const;

  /// The surface's place and axes, without a radius.
  const CarrierSurface& axis() const { return axis_; }
  double length() const { return length_; }  ///< m, of the segment
  /// Whether heights run from the segment's start to its end.
  bool startsBelow() const { return starts_below_; }

 private:
  CarrierSurface axis_;
  double length_ = 0.0;
  bool starts_below_ = true;
  std::vector<Eigen::Vector3d> vertices_;
};

/// Sets the least radius that is as large as needed everywhere; for a cone radius and slope such
/// that the radius in the middle of the heights is the least.
/// @param needed at least one
void fitRadius(Carrier::Shape shape, const std::vector<NeededRadius>& needed,
               CarrierSurface& surface);

}  // namespace haptex::garment
