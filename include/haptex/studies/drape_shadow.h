// The shadow that a draped fabric throws: drape coefficient and folds.
#pragma once

#include <vector>

#include "haptex/mesh/mesh.h"

namespace haptex::studies {

/// Radius of the shadow (m) that a mesh throws along z, at angles 2 pi i / count about the origin.
std::vector<double> shadowRadii(const mesh::ClothMesh& mesh, int count);

/// Drape coefficient, 0 to 1: the area between support and shadow over that between support and
/// flat fabric.
/// @param radii of the shadow, m
/// @param fabric_radius, support_radius m
double drapeCoefficient(const std::vector<double>& radii, double fabric_radius,
                        double support_radius);

/// Maxima of a closed curve of radii that stand out from the minima on both sides by more than
/// `prominence` (m).
int countNodes(const std::vector<double>& radii, double prominence);

}  // namespace haptex::studies
