// Lengths and girths of a body as a tailor takes them.
#pragma once

#include <string>
#include <vector>

#include "haptex/garment/body/body.h"

namespace haptex::garment {

/// What is measured on a body that has the segments of the figure (docs/bodies.md): its height, the
/// length of a segment, or a girth. A girth is the length of a tape around a plane section of the
/// segments named, that is the perimeter of its convex hull.
struct Measurement {
  enum class Kind { kHeight, kLength, kLevelGirth, kGirth };
  std::string name;
  Kind kind = Kind::kHeight;
  std::string segment;
  double along = 0.0;               ///< where on the segment the plane is, from 0 to 1
  std::vector<std::string> around;  ///< segments that the tape goes around
};

/// All of them: height; chest, waist and hips in horizontal planes; neck, upper_arm, wrist, thigh,
/// knee, calf and ankle across their segment, on the left; lengths of the segments of the left arm
/// and leg.
const std::vector<Measurement>& measurements();

/// @throws std::invalid_argument naming it and all that there are
const Measurement& measurementNamed(const std::string& name);

/// Measures the same again and again on a body that changes.
class Tape {
 public:
  /// @throws std::invalid_argument naming a segment that the body does not have
  Tape(const Measurement& measurement, const Body& body);
  /// m. @param body the same, whose vertices and joints may have moved
  double measure(const Body& body) const;

 private:
  double girth(const Body& body) const;

  Measurement measurement_;
  int segment_ = -1;
  std::vector<int> triangles_;  // that the tape may touch
};

/// m. @throws as Tape()
double measure(const Body& body, const std::string& measurement);

}  // namespace haptex::garment
