// What Membrane adds to linear systems, for four elements at a time, for processors with AVX2 and
// FMA.
#pragma once

#include "haptex/cloth/forces/batches/membrane_batches.h"

namespace haptex::cloth::kernels {

/// Four elements of a membrane, one per lane: [which][lane]. Weights are those of the second and
/// third particle, because the weights of a triangle sum to zero.
struct alignas(32) MembraneBatch {
  static constexpr int kStrains = 3;  // of an element
  double weft_weights[2][kBatch];     ///< 1/m
  double warp_weights[2][kBatch];     ///< 1/m
  double area[kBatch];                ///< m^2
  int particles[3][kBatch];
  int slots[3][kBatch];  ///< of the matrix blocks (1,0), (2,0), (2,1)
};

/// Whether this processor can run the functions below.
bool canAddBatches();

/// Adds the elements one after the other, so that the sums are the same in every run.
void addStep(const MembraneBatch* batches, int count, const MembraneStep& step);
void addNewton(const MembraneBatch* batches, int count, const MembraneNewton& newton);

/// Membrane::incrementalPotential() of the elements (J); without viscosity the elastic energy.
/// @param begin_strains three per element, not read without viscosity; nor is h (s)
double potential(const MembraneBatch* batches, int count, const double* positions,
                 const double* begin_strains, double h, const MembraneLaw& law);

}  // namespace haptex::cloth::kernels
