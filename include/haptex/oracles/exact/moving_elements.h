// Moving elements of which it is known exactly that they touch.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <random>

#include "haptex/proximity/element_pair.h"

namespace haptex::oracles {

/// A vertex and a triangle, or two edges, whose vertices move evenly from begin at time 0 to end at
/// time 1.
struct MovingElements {
  proximity::ElementPairKind kind;
  std::array<Eigen::Vector3d, 4> begin, end;  ///< m, in the order of proximity::verticesOf()
  /// They surely touch at this time or before it; nothing: not known.
  std::optional<double> contact;
};

/// Cases without end, always the same, in which all numbers are whole, or whole times a power of
/// two, so that nothing is rounded:
/// - contacts by construction, at a time and place that were chosen: in a face, on its edges and
///   corners, of edges and their ends, parallel or not, of elements without area or length, at
///   rest, moving in a plane, at the begin and at the end;
/// - random motion on a small grid, where whether they touch is found by rational arithmetic: the
///   volume that the four vertices span changes its sign between two times, between which the place
///   is inside of both elements.
class MovingElementCases {
 public:
  MovingElements next();

 private:
  int number(int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(generator_);
  }
  Eigen::Vector3d place(int reach);
  MovingElements constructed();
  MovingElements random();

  std::mt19937 generator_{1};
  unsigned count_ = 0;
};

}  // namespace haptex::oracles
