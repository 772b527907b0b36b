// Whether two moving elements touch on the way.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "haptex/proximity/element_pair.h"

namespace haptex::proximity {

/// A time before which the elements surely stay more than `least_distance` apart, while each vertex
/// moves evenly along the straight way from `begin` at time 0 to `end` at time 1; nothing if they
/// surely do so up to time 1, and at it.
///
/// No contact is missed, whatever the rounding: an interval of time is passed only if a direction
/// was found along which all points of one element are beyond all points of the other at both its
/// ends. The distance of two vertices along a direction changes linearly, so they are apart within
/// the interval, too; the error of its computation is bounded. Where no direction is found the
/// interval is halved, down to kShortestInterval. So a contact is reported where there is none only
/// if the distance falls to least_distance or to some 1e-7 of the way that the elements move
/// against each other, or if kMostIntervals do not suffice. Degenerate triangles and edges,
/// parallel edges and motion in a plane need no cases of their own. As the inclusion-based root
/// finding of Wang et al. (ACM Trans. Graphics 40(5), 2021), but subdividing time only.
/// @param begin, end      m, in the order of verticesOf(), finite and at most kMaxLength
/// @param least_distance  m, finite and >= 0
std::optional<double> earliestContact(ElementPairKind kind,
                                      const std::array<Eigen::Vector3d, 4>& begin,
                                      const std::array<Eigen::Vector3d, 4>& end,
                                      double least_distance = 0.0);
/// The same, where the nearest points at the beginning are known.
/// @param nearest PairDistance::weights at `begin`
std::optional<double> earliestContact(ElementPairKind kind,
                                      const std::array<Eigen::Vector3d, 4>& begin,
                                      const std::array<Eigen::Vector3d, 4>& end,
                                      double least_distance, const Eigen::Vector4d& nearest);

constexpr double kShortestInterval = 1.0 / (1 << 24);  ///< of the motion
constexpr int kMostIntervals = 4096;                   ///< that are tested

}  // namespace haptex::proximity
