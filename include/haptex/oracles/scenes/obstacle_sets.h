// Cloth that collides with itself, on and through obstacles.
#pragma once

#include <cstddef>
#include <vector>

#include "haptex/mesh/obstacle.h"
#include "haptex/oracles/scenes/self_collision_scenes.h"

namespace haptex::oracles {

/// - box_edge: a sheet is thrown at 2 m/s on an edge of a box,
/// - needle: likewise on the tip of an upright needle, 1 mm thick,
/// - edges_and_needles: a towel falls on two edges, six needles and a floor,
/// - funnel: a sheet is drawn by its middle through an open funnel,
/// - rotating_sphere: a sheet falls on a sphere that turns on a floor.
/// @param cells along 100 mm, > 0
std::vector<SelfCollidingCloth::Set> obstacleSets(int cells);

/// Triangles of a cloth that touch a solid obstacle or are inside of it; or pairs of triangles, of
/// the cloth and of a mesh, that intersect, by the exact test. @param time s
std::size_t countIntersections(const std::vector<Eigen::Vector3d>& positions,
                               const std::vector<std::array<int, 3>>& triangles,
                               const mesh::Obstacle& obstacle, double time);

}  // namespace haptex::oracles
