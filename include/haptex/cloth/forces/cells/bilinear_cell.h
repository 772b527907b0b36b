// A quadrilateral of two triangles at rest, and the two strains it has.
#pragma once

#include <Eigen/Core>
#include <array>

#include "haptex/cloth/forces/cells/triangle_pairs.h"

namespace haptex::cloth {

/// The two particles of each of the six distances in a cell, as indices of its particles.
constexpr std::array<std::array<int, 2>, 6> kCellDistances = {
    {{1, 0}, {2, 0}, {2, 1}, {3, 0}, {3, 1}, {3, 2}}};

/// Strains of a cell: weft, warp and shear at its first point, then at its second.
using CellStrain = Eigen::Matrix<double, 6, 1>;

/// A cell at rest. As Green-Lagrange strains are linear in the squares of distances, and those of a
/// cell are sums of such strains,
///   strain = by_squares (squares of the six distances of its particles - those at rest).
struct BilinearCell {
  std::array<int, 4> particles;  ///< ascending
  std::array<int, 6> slots;      ///< of the matrix blocks of kCellDistances; -1 before bind()
  Eigen::Matrix<double, 6, 6> by_squares;  ///< 1/m^2, columns in the order of kCellDistances
  CellStrain rest_squares;                 ///< m^2, in the same order
  double area;                             ///< m^2; each of the two points stands for half of it
};

/// The two points have the strains E + h and E - h.
///
/// E is the mean strain. With G the mean gradient of the weights over a cell of the area A, which
/// is alike for either diagonal, and r_t, A_t of the four triangles that both diagonals make, it is
/// that of the quadratic form
///   2/3 G G^T + 1/6 sum_t A_t / A r_t r_t^T,
/// which in a parallelogram is the exact mean over the bilinear map.
///
/// h is what the cell keeps of the variation of its strain. Along the sides p the strain of a
/// parallelogram is linear across the cell between that of the one and of the other side, whose
/// difference is dp; likewise dq. In assumed modes that are linear across the cell a variation dp
/// relaxes to the uniaxial stress along p (Simo and Rifai 1990), so it costs A/12 Yp dp^2 / 2 with
/// Young's modulus
///   1 / Yp = pu^4 / k_weft + pv^4 / k_warp + pu^2 pv^2 / k_shear,
/// and shear that varies costs nothing. h is linear in dp and dq and has that energy. In a cell
/// along the threads it is (dp, dq, 0) / sqrt(12), and both points are Gauss' of either direction:
/// that is the bilinear element whose shear alone is reduced to one point.
/// @param pair   convex @param moduli of weft, warp and shear at rest, N/m; what is less than 1e-6
///   of the largest is taken as that
BilinearCell restCell(const TrianglePair& pair, const Eigen::Vector3d& moduli);

/// The distances of a cell as springs of no length: their stiffnesses `pulls` (N/m, may be < 0) are
/// those off the diagonal, with the sign reversed, of a 4 x 4 matrix whose rows have the sum 0.
/// @return those of the nearest matrix that is positive semidefinite
CellStrain projectPulls(const CellStrain& pulls);

}  // namespace haptex::cloth
