// Round meshes from circles of particles.
#pragma once

#include <vector>

#include "haptex/mesh/mesh.h"

namespace haptex::mesh {

/// Circles of particles around the origin with triangles between each two that follow each other.
/// The particles of a circle are as many as make triangles as high as the distance to the circle
/// inside of it (of the first one: outside) nearly equilateral, and they are turned against those
/// of the next one by the golden angle, so that there is no rotational symmetry that folds could
/// keep to. Particles follow from circle to circle, outwards. Rest coordinates are (x, y) of the
/// initial positions, which lie in the plane z = 0 of the world frame.
/// @param radii m, at least two, ascending; 0 as the first: one particle in the middle
/// @throws std::invalid_argument naming the number or the radius that is not as above or not finite
ClothMesh meshOfCircles(const std::vector<double>& radii);

}  // namespace haptex::mesh
