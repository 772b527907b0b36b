// Where weft and warp of a large-scale triangle are in space.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/contact/large_scale_motion.h"
#include "haptex/mesh/mesh.h"

namespace haptex::contact {

/// Which of the cloth's fabrics every triangle is of; empty: all are of the first.
std::vector<int> fabricsOfTriangles(const mesh::ClothMesh& mesh);

/// Images of the unit vectors along weft and warp of a triangle: the columns of its deformation
/// gradient. World frame.
Eigen::Matrix<double, 3, 2> fabricDirections(const mesh::ClothMesh& mesh, int triangle,
                                             const LargeScaleMotion& motion);

/// What takes a displacement to the fabric's own directions: dx = U du + V dv has the least-squares
/// solution (du, dv) for the deformed directions U, V. Zero if those are parallel.
/// @param directions U and V
Eigen::Matrix<double, 2, 3> toFabric(const Eigen::Matrix<double, 3, 2>& directions);

}  // namespace haptex::contact
