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
/// Conjugate gradients with a factor by MUMPS as preconditioner, to a relative residual of 1e-6;
/// the environment variable PETSC_OPTIONS chooses otherwise, as always with PETSc.
class PetscSystem {
 public:
  /// @param pattern of the strip
  /// @throws std::runtime_error if PETSc fails, as all functions do
  PetscSystem(const linear::SymmetricBlockMatrix& pattern, const PartPlace& place);
  ~PetscSystem();
  PetscSystem(const PetscSystem&) = delete;
  PetscSystem& operator=(const PetscSystem&) = delete;

  /// @param positions m, of the strip: the rigid motions from here are nearly without resistance
  void take(const linear::SymmetricBlockMatrix& matrix, const linear::BlockVector& rhs,
            const std::vector<Eigen::Vector3d>& positions);
  double rhsNorm() const;
  /// @param solution of all particles of the strip
  PetscSolve solve(linear::BlockVector& solution);
  /// Of right-hand side and solution.
  double product() const;

  /// Gives each particle of the strip the vector that the process has which owns it.
  void share(std::vector<Eigen::Vector3d>& vectors);
  /// Of all processes.
  static double sum(double number);

 private:
  struct Objects;
  std::unique_ptr<Objects> objects_;
  PartPlace place_;
};

}  // namespace haptex::large
