// The linear systems of a patch, one per millisecond, of which each is close to the one before.
#pragma once

#include "haptex/contact/kept_factor.h"
#include "haptex/linear/block_cholesky.h"
#include "haptex/linear/block_matrix.h"

namespace haptex::contact {

/// Conjugate gradients on the matrix as it is, preconditioned with a factor that is kept from step
/// to step and renewed piece by piece, and started where the last two solutions lead to. If the
/// iterations become many, the factor is made anew at once; if that does not help either, a factor
/// in double precision solves the system directly. So the age of the factor costs time, not
/// accuracy.
///
/// Nothing allocates after the constructor.
class PatchSolver {
 public:
  /// @param pattern of the leading part of the matrices
  explicit PatchSolver(const linear::SymmetricBlockMatrix& pattern);

  /// Solves A x = b, where A is the leading part of the matrix.
  /// @param rhs leading columns: b
  /// @param guess a direction, in which the first two solutions are sought first, the same for all
  ///   particles: that in which a cloth falls freely, exactly; zero: none
  /// @returns false if A is not positive definite to rounding, or a number is not finite
  bool solve(const linear::SymmetricBlockMatrix& matrix, const linear::BlockVector& rhs,
             const Eigen::Vector3d& guess, linear::BlockVector& solution);

  /// The same by a factor in double precision, made for this system alone.
  bool solveDirectly(const linear::SymmetricBlockMatrix& matrix, const linear::BlockVector& rhs,
                     linear::BlockVector& solution);

  /// One iteration towards the solution of another system with the matrix of the last solve(), from
  /// where `solution` is. The error never grows.
  void improve(const linear::SymmetricBlockMatrix& matrix, const linear::BlockVector& rhs,
               linear::BlockVector& solution);

  /// Of the last solve().
  int iterations() const { return iterations_; }

  /// Whether the last solve() took few iterations, so that there is time for an improve().
  bool wasShort() const { return iterations_ <= kFew; }

 private:
  static constexpr int kFew = 3;  // iterations of a step: the factor is good enough as it is

  bool iterate(const linear::SymmetricBlockMatrix& matrix, const linear::BlockVector& rhs, int most,
               linear::BlockVector& solution);
  bool solveByKept(const linear::SymmetricBlockMatrix& matrix, const linear::BlockVector& rhs,
                   linear::BlockVector& solution);
  double foretell(const linear::SymmetricBlockMatrix& matrix, const linear::BlockVector& rhs,
                  linear::BlockVector& solution);
  double addDirection(const linear::SymmetricBlockMatrix& matrix, double slope,
                      linear::BlockVector& solution);

  KeptFactor kept_;
  linear::BlockCholesky direct_;
  bool has_kept_ = false;
  bool has_direct_ = false;  // of the last system
  int iterations_ = 0;
  int solved_ = 0;  // systems, one after the other; 2: or more
  Eigen::Vector3d guess_ = Eigen::Vector3d::Zero();
  linear::BlockVector residual_, preconditioned_, direction_, product_;
  linear::BlockVector last_, before_last_;  // solutions
};

}  // namespace haptex::contact
