// What BilinearCells adds to linear systems, for four cells at a time, for processors with AVX2 and
// FMA (kernels::canAddBatches()).
#pragma once

#include "haptex/cloth/forces/batches/membrane_batches.h"
#include "haptex/cloth/forces/cells/bilinear_cell.h"

namespace haptex::cloth::kernels {

/// Four cells, one per lane: [which][lane]. With the vectors x_1, x_2, x_3 from the first particle
/// to the others, s the six numbers x_1.x_1, x_2.x_2, x_3.x_3, x_1.x_2, x_1.x_3, x_2.x_3, and Q a
/// symmetric matrix whose entries are written in the same order, each of the six strains is
///   sum_ab Q_ab (s_ab - those at rest).
struct alignas(32) BilinearBatch {
  static constexpr int kStrains = 6;  // of a cell
  double forms[6][6][kBatch];         ///< Q of each strain, 1/m^2
  double rest_products[6][kBatch];    ///< m^2
  double area[kBatch];                ///< m^2
  int particles[4][kBatch];
  int slots[6][kBatch];  ///< of the matrix blocks of kCellDistances
};

/// @param cells four, with their slots
BilinearBatch batchOf(const BilinearCell* cells);

/// Adds the cells one after the other, so that the sums are the same in every run.
/// @param step its law without coupling
void addStep(const BilinearBatch* batches, int count, const MembraneStep& step);
/// @param newton likewise; six strains at the beginning per cell
void addNewton(const BilinearBatch* batches, int count, const MembraneNewton& newton);

/// BilinearCells::incrementalPotential() of the cells (J); without viscosity the elastic energy.
/// @param begin_strains six per cell, not read without viscosity; nor is h (s)
double potential(const BilinearBatch* batches, int count, const double* positions,
                 const double* begin_strains, double h, const MembraneLaw& law);

}  // namespace haptex::cloth::kernels
