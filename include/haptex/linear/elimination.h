// Symbolic part of the sparse Cholesky factorisation: order of elimination and supernodes.
#pragma once

#include <vector>

#include "haptex/linear/block_matrix.h"

namespace haptex::linear {

/// Consecutive columns of the factor with (nearly) the same rows below them, kept as one dense
/// panel. Indices are in the order of elimination.
struct Supernode {
  int first;              ///< first column
  int end;                ///< one past the last column
  std::vector<int> rows;  ///< block rows below the last column, ascending
  int width() const { return end - first; }
};

/// Structure of the factor L of P A P^T = L L^T.
struct Elimination {
  std::vector<int> order;     ///< order[k]: block row of A that is eliminated k-th
  std::vector<int> position;  ///< inverse of order
  std::vector<Supernode> supernodes;
  std::vector<int> supernode_of;  ///< by column
};

/// Structure of the factor in a given order: postordered elimination tree (Liu 1990), and
/// supernodes that take up a child where the dense panel gains more than the explicit zeros cost
/// (relaxed amalgamation, Ashcraft and Grimes 1989).
Elimination analyse(const SymmetricBlockMatrix& pattern, const std::vector<int>& order);

/// The same in minimumDegreeOrder() or nestedDissectionOrder(), whichever needs fewer operations.
Elimination analyse(const SymmetricBlockMatrix& pattern);

/// Multiply-add operations that eliminate one supernode.
double supernodeCost(const Supernode& supernode);

/// Multiply-add operations of one numeric factorisation, from the structure.
double factorisationCost(const Elimination& elimination);

}  // namespace haptex::linear
