// Conversions between contact forces on the cloth and their message.
#pragma once

#include <haptex/ContactForces.h>

#include <cstddef>
#include <vector>

#include "haptex/cloth/point_load.h"

namespace haptex::nodes {

/// @param triangle_count of the cloth
/// @throws std::invalid_argument naming what is wrong: the frame is not kFixedFrame, the arrays
///   differ in length, there are more points than Cloth::kMostPointLoads, or what
///   Cloth::setPointLoads() refuses
std::vector<cloth::PointLoad> pointLoads(const haptex::ContactForces& message,
                                         std::size_t triangle_count);

}  // namespace haptex::nodes
