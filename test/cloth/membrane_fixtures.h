// What tests of the membrane look at.
#pragma once

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/linear/block_matrix.h"

namespace haptex::cloth {

/// What the membrane adds to an empty system.
struct MembraneSystem {
  linear::SymmetricBlockMatrix matrix;
  linear::BlockVector rhs;
  explicit MembraneSystem(const Cloth& cloth)
      : matrix(static_cast<int>(cloth.particleCount()), cloth.mesh().triangles),
        rhs(linear::BlockVector::Zero(3, cloth.particleCount())) {}
};

}  // namespace haptex::cloth
