// The curvature of every triangle of a mesh from the particles around it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/mesh/mesh.h"

namespace haptex::cloth {

/// A displacement w out of the plane with w_i at particles[i] has in a triangle the mean second
/// derivatives (wuu, wvv, wuv) = weights w (1/m^2).
struct CurvatureStencil {
  std::vector<int> particles;  ///< the triangle's, its neighbours' and theirs; at most 12
  Eigen::Matrix3Xd weights;    ///< 1/m^2; zero for every affine w
  double area;                 ///< m^2, at rest
  /// Of the edges that no other triangle has, unit length. The curvature across them is not in the
  /// weights: no moment acts there.
  std::vector<Eigen::Vector2d> free_normals;
};

/// By Gauss' theorem the mean second derivatives in a triangle of area A are
///   1/A sum over its edges of length (outer normal) (gradient)^T.
/// Along an edge the gradient is the difference of its ends; across it, it is one number for both
/// triangles, recovered from the corners of the two and of the four that surround them so that it
/// is right for every quadratic w as far as these particles can tell. So
/// - the curvature is exact for every quadratic w, and
/// - a moment that is the same everywhere does work on no inner particle, because the edges' two
///   sides cancel.
/// These are the conditions under which a mesh of any shape bends as the plate does (patch test);
/// the element is that of Morley (1968) with the slopes of its edges taken from the particles.
///
/// @param mesh without defects
std::vector<CurvatureStencil> findCurvatureStencils(const mesh::ClothMesh& mesh);

}  // namespace haptex::cloth
