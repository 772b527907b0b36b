// The states and systems of elements that are added four at a time.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "haptex/cloth/forces/batches/batch_list.h"
#include "haptex/cloth/forces/force.h"
#include "haptex/linear/block_matrix.h"
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

/// @param matrix bound to the forces of the elements @param rhs a column per particle
inline MembraneSystem systemOf(linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) {
  return {matrix.diagonal(0).data(), matrix.lower(0).data(), rhs.data()};
}

/// What Force::assembleLinearised() is given, for the batches of its elements.
inline MembraneStep stepOf(const ForceState& state, const StageTimes& times, const MembraneLaw& law,
                           linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) {
  return {
      state.positions.data()->data(), state.velocities.data()->data(), times.a, times.ahead, law,
      systemOf(matrix, rhs)};
}

/// What Force::assembleNewton() is given, likewise.
inline MembraneNewton newtonOf(const ForceState& state, const Eigen::Vector3d* held, double a,
                               Hessian hessian, const MembraneLaw& law,
                               linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) {
  return {state.positions.data()->data(), held->data(), a,
          hessian == Hessian::kExact,     law,          systemOf(matrix, rhs)};
}

/// Numbers of the strains that are held for the elements of the batches before one.
template <typename Batch>
std::ptrdiff_t strainsBefore(int batch) {
  return std::ptrdiff_t{Batch::kStrains} * kBatch * batch;
}

/// addStep(), addNewton() and potential() of all batches; nothing without one.
template <typename Batch>
void addStep(const BatchList<Batch>& batches, const ForceState& state, const StageTimes& times,
             const MembraneLaw& law, linear::SymmetricBlockMatrix& matrix,
             linear::BlockVector& rhs) {
  if (batches.size() == 0) return;
  const MembraneStep step = stepOf(state, times, law, matrix, rhs);
  batches.forEachPart(state.pool,
                      [&](const Batch* part, int, int count) { addStep(part, count, step); });
}
template <typename Batch>
void addNewton(const BatchList<Batch>& batches, const ForceState& state,
               const Eigen::Vector3d* held, double a, Hessian hessian, const MembraneLaw& law,
               linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) {
  if (batches.size() == 0) return;
  const MembraneNewton newton = newtonOf(state, held, a, hessian, law, matrix, rhs);
  batches.forEachPart(state.pool, [&](const Batch* part, int first, int count) {
    MembraneNewton its = newton;
    if (law.viscous != nullptr) its.begin_strains += strainsBefore<Batch>(first);
    addNewton(part, count, its);
  });
}
/// @param held null without viscosity
template <typename Batch>
double potential(const BatchList<Batch>& batches, const ForceState& state,
                 const Eigen::Vector3d* held, double a, const MembraneLaw& law) {
  const double* positions = state.positions.data()->data();
  return batches.sumOfParts(state.pool, [&](const Batch* part, int first, int count) {
    const double* strains = nullptr;
    if (law.viscous != nullptr) strains = held->data() + strainsBefore<Batch>(first);
    return potential(part, count, positions, strains, a, law);
  });
}

}  // namespace haptex::cloth::kernels
