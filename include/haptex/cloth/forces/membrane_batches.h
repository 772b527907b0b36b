// The states and systems of elements that are added four at a time.
#pragma once

#include <array>

#include "haptex/material/strain_stress_curve.h"

namespace haptex::cloth::kernels {

constexpr int kBatch = 4;

struct MembraneLaw {
  const std::array<material::StrainStressCurve, 3>* elastic;  ///< weft, warp, shear
  const std::array<material::StrainStressCurve, 3>* viscous;  ///< null: none
  double coupling;                                            ///< N/m, of weft and warp; 0: none
};

/// The linear system that the elements are added to: nine doubles per block (by columns), three per
/// particle.
struct MembraneSystem {
  double* diagonal;
  double* lower;
  double* rhs;
};

/// Of addStep(). Positions and velocities are three doubles per particle.
struct MembraneStep {
  const double* positions;
  const double* velocities;
  double a;      ///< s
  double ahead;  ///< s
  MembraneLaw law;
  MembraneSystem system;
};

/// Of addNewton().
struct MembraneNewton {
  const double* positions;
  const double* begin_strains;  ///< of the elements, one after the other
  double h;                     ///< s
  bool exact;                   ///< the Hessian, not projected
  MembraneLaw law;
  MembraneSystem system;
};

}  // namespace haptex::cloth::kernels
