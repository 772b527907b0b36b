// Membrane::addStep() for four elements at a time, for processors with AVX2 and FMA.
#pragma once

#include <array>

#include "haptex/material/strain_stress_curve.h"

namespace haptex::cloth::kernels {

constexpr int kBatch = 4;

/// Four elements of a membrane, one per lane: [which][lane]. Weights are those of the second and
/// third particle, because the weights of a triangle sum to zero.
struct alignas(32) MembraneBatch {
  double weft_weights[2][kBatch];  ///< 1/m
  double warp_weights[2][kBatch];  ///< 1/m
  double area[kBatch];             ///< m^2
  int particles[3][kBatch];
  int slots[3][kBatch];  ///< of the matrix blocks (1,0), (2,0), (2,1)
};

/// What addStep() reads and adds to: three doubles per particle, nine per block (by columns).
struct MembraneStep {
  const double* positions;
  const double* velocities;
  double a;                                                   ///< s
  double ahead;                                               ///< s
  const std::array<material::StrainStressCurve, 3>* elastic;  ///< weft, warp, shear
  const std::array<material::StrainStressCurve, 3>* viscous;  ///< null: none
  double coupling;                                            ///< N/m, of weft and warp; 0: none
  double* diagonal;
  double* lower;
  double* rhs;
};

/// Whether this processor can run addStep().
bool canAddBatches();

/// Elastic energy of the elements (J).
/// @param positions three doubles per particle
double elasticEnergy(const MembraneBatch* batches, int count, const double* positions,
                     const std::array<material::StrainStressCurve, 3>& elastic, double coupling);

/// Adds the elements one after the other, so that the sums are the same in every run.
void addStep(const MembraneBatch* batches, int count, const MembraneStep& step);

}  // namespace haptex::cloth::kernels
