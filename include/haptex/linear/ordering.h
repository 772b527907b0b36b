// Orders of elimination that keep the factor of a sparse symmetric matrix small.
#pragma once

#include <vector>

#include "haptex/linear/block_matrix.h"

namespace haptex::linear {

// order[k] is the block row that is eliminated k-th.

/// Approximate minimum degree (Eigen's AMD): best for small patterns.
std::vector<int> minimumDegreeOrder(const SymmetricBlockMatrix& pattern);

/// Nested dissection (George 1973): a small set of rows that separates the others into two halves
/// is eliminated last, and each half is ordered likewise. Rows with at most four neighbours that
/// are not neighbours themselves go first of all, because that fills next to nothing in; in sheets
/// with alternating diagonals it halves the graph, and diagonal cuts through the rest are shorter
/// by sqrt 2. Works for any pattern: the cuts come from distances in the graph.
std::vector<int> nestedDissectionOrder(const SymmetricBlockMatrix& pattern);

}  // namespace haptex::linear
