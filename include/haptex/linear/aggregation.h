// From the unknowns of a block matrix to fewer ones: smoothed aggregation.
#pragma once

#include <vector>

#include "haptex/linear/block_rows.h"

namespace haptex::linear {

/// Interpolation from coarse rows to fine ones, alike in x, y and z: fine row i is the sum of
/// weights[k] times coarse row columns[k], k in [begin[i], begin[i + 1]), columns ascending.
struct Interpolation {
  int coarse_size = 0;
  std::vector<int> begin;
  std::vector<int> columns;
  std::vector<float> weights;

  /// From fine rows to coarse ones: coarse_size of them, from as many as were fine.
  Interpolation transposed() const;
};

/// Groups of rows that are strongly coupled with one in their middle become a coarse row each. What
/// is interpolated from them is smoothed by one step of Jacobi's method on the graph of the strong
/// couplings, so that it is nearly linear in between (Vanek, Mandel and Brezina, Algebraic
/// multigrid by smoothed aggregation for second and fourth order elliptic problems, Computing
/// 1996). A coupling is strong if its block is at least half as large as the largest one of one of
/// its rows: where warp is stiffer than weft by far, groups are along the warp. Weights of a row
/// add up to one, so that translations are exact; a row without couplings has none.
Interpolation smoothedAggregation(const BlockRows& matrix);

}  // namespace haptex::linear
