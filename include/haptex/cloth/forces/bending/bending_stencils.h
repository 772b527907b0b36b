// The hinges around every particle of a mesh and what each of them resists.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/mesh/mesh.h"

namespace haptex::cloth {

/// A hinge without its stiffness. For a displacement with the second derivatives wuu, wvv, wuv its
/// bending vector has the length |resists . (wuu, wvv, wuv)|.
struct BendingStencil {
  std::array<int, 4> particles;
  std::array<double, 4> weights;  ///< no unit, sum 0
  int centre;  ///< particle on the line of the second kind of hinge, -1: an edge of the first
  Eigen::Vector3d resists = Eigen::Vector3d::Zero();  ///< m^2
};

/// A particle with what can resist bending around it.
struct BendingNeighbourhood {
  double area = 0.0;  ///< m^2, nearest to this particle; all of them together are the mesh's
  std::vector<int> stencils;                  ///< lines before edges
  std::vector<Eigen::Vector2d> free_normals;  ///< of its boundary edges, unit length
};

struct BendingStencils {
  std::vector<BendingStencil> stencils;
  std::vector<BendingNeighbourhood> neighbourhoods;  ///< by particle
};

/// @param mesh without defects
BendingStencils findBendingStencils(const mesh::ClothMesh& mesh);

/// The x >= 0 with the smallest |columns x - target| (Lawson and Hanson 1974, chapter 23).
Eigen::VectorXd nonNegativeLeastSquares(const Eigen::MatrixXd& columns,
                                        const Eigen::VectorXd& target);

}  // namespace haptex::cloth
