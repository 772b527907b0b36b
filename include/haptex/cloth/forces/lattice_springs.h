// Which springs the cells of a rectangular mesh ask for.
#pragma once

#include <vector>

#include "haptex/mesh/mesh.h"

namespace haptex::cloth {

/// A spring between two particles. Its energy is `area` times the integral of a stress (N/m) over
/// its Green-Lagrange strain e = (length^2 / rest length^2 - 1) / 2; SpringLattice says which
/// stress that is for each kind.
struct LatticeSpring {
  enum class Kind { kWeft, kWarp, kShear, kWeftBend, kWarpBend };
  Kind kind;
  int first;                   ///< particle
  int second;                  ///< particle, > first
  double area;                 ///< m^2
  double inverse_rest_square;  ///< 1 / (rest length)^2, 1/m^2
  /// Weft and warp: rest length over that of the cell's other side. Shear: strain of the fabric's
  /// shear curve over e, negative for the diagonals that shorten under positive shear. Bend:
  /// modulus over the fabric's rigidity, 1/m^2.
  double scale;
  int slot = -1;  ///< of its block in the matrix, -1: not bound
};

/// Structural springs along the sides of all cells, half of each cell's area on either; shear
/// springs along both diagonals, half of its area on each; and, if asked for, bend springs from
/// each particle to the one after the next along weft and warp, where both sides between them
/// exist. Sorted by kind.
/// @param mesh without defects
/// @throws std::invalid_argument naming a triangle if the mesh does not consist of rectangles along
///   weft and warp of two triangles each, to 1e-9 of their sides; or if it has seams that are
///   merged
std::vector<LatticeSpring> findLatticeSprings(const mesh::ClothMesh& mesh, bool bend);

}  // namespace haptex::cloth
