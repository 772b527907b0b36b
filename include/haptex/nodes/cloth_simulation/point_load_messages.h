// Conversions between contact forces on the cloth and their message.
#pragma once

#include <haptex/ContactForces.h>

#include <cstddef>
#include <vector>

#include "haptex/cloth/forces/point_loads.h"

namespace haptex::nodes {

/// Bounds of a point's numbers, the same as those of a commanded force: see
/// exoskeleton/command_check.h. A fingertip's force and stiffness are the sums over its points.
constexpr double kMaxPointForce = 1000.0;   ///< N, norm
constexpr double kMaxPointStiffness = 1e5;  ///< N/m, Frobenius norm
constexpr double kFarthestPoint = 100.0;    ///< m, norm, from the origin of the world
constexpr double kMaxWeights = 100.0;       ///< no unit, norm

/// @param triangle_count of the cloth
/// @throws std::invalid_argument naming what is wrong: the frame is not fixedFrame(), the arrays
///   differ in length, there are more points than PointLoads::kMax, a number is beyond the
///   bounds above, or what Cloth::setPointLoads() refuses
std::vector<cloth::PointLoad> pointLoads(const haptex::ContactForces& message,
                                         std::size_t triangle_count);

}  // namespace haptex::nodes
