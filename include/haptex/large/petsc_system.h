// The linear systems that strips have in common, solved by PETSc over MPI.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "haptex/large/sheet.h"
#include "haptex/linear/block_matrix.h"

namespace haptex::large {

/// What a solve did.
struct PetscSolve {
  bool converged = false;
  int iterations = 0;
};

/// One symmetric system of all processes of PETSC_COMM_WORLD: each gives the rows of its own
/// particles, and gets the solution of all that it knows. All functions are called by all of them,
/// in the same order.
///
/// Conjugate gradients, to a relative residual of 1e-6, with overlapping additive Schwarz as
/// preconditioner (Dryja and Widlund 1987): each process has a factor in single precision of the
/// part of the matrix that it knows whole. The environment variable PETSC_OPTIONS chooses
/// otherwise, as always with PETSc.
class PetscSystem {
 public:
  /// @param pattern of the strip
  /// @throws std::runtime_error if PETSc fails, as all functions do
  PetscSystem(const linear::SymmetricBlockMatrix& pattern, const PartPlace& place);
  ~PetscSystem();
  PetscSystem(const PetscSystem&) = delete;
  PetscSystem& operator=(const PetscSystem&) = delete;

  /// @param matrix kg, is used up @param rhs N s
  void take(linear::SymmetricBlockMatrix& matrix, const linear::BlockVector& rhs);
  double rhsNorm() const;  ///< N s
  /// @param solution m/s, of all particles of the strip
  /// @returns not converged, and without a solution, if the matrix is not positive definite
  PetscSolve solve(linear::BlockVector& solution);
  /// Of right-hand side and solution (J).
  double product() const;

  /// Gives each particle of the strip the vector that the process has which owns it.
  void share(std::vector<Eigen::Vector3d>& vectors);
  /// Of all processes.
  static double sum(double number);

 private:
  struct Objects;
  std::unique_ptr<Objects> objects_;
};

}  // namespace haptex::large
