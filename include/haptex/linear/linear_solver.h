// One interface to the linear solvers, and the choice between them.
#pragma once

#include <memory>

#include "haptex/linear/backoff.h"
#include "haptex/linear/block_cholesky.h"
#include "haptex/linear/block_matrix.h"
#include "haptex/linear/conjugate_gradient.h"
#include "haptex/linear/kept_factor.h"
#include "haptex/linear/multigrid.h"

namespace haptex::linear {

/// How a linear system is solved.
enum class LinearSolverMethod {
  kConjugateGradient,
  /// a factor in double precision of every system, see LinearSolver for those with couplings; in
  /// StepReport: any factor
  kCholesky,
  kAutomatic,  ///< the cheaper way for the system at hand, see LinearSolver
};

/// Solves the systems of successive steps to a stated relative residual.
///
/// The automatic choice is between conjugate gradients with the diagonal blocks as preconditioner
/// and conjugate gradients with a kept factor in single precision (KeptFactor), or, in patterns of
/// more than kMostFactoredRows, with a multigrid cycle (Multigrid).
///
/// Of large patterns: what ten iterations with the diagonal blocks do not solve is solved by
/// multigrid, and so are the next systems, at first 8 and twice as many after each further failure
/// up to 512. The hierarchy is made for the first such system, and anew for one that it does not
/// solve within 100 iterations. All that follows is of the others.
///
/// Diagonal blocks get as many iterations as cost what a solve by the kept factor costs, as long as
/// they are on the way to suffice (ConjugateGradient::Patience). When they do not, the factor
/// solves this system and the next ones, at first 8 and twice as many after each further failure up
/// to 512, before they are tried again.
///
/// A system that is not positive definite to single precision, or that the factor does not solve,
/// is factorised in double precision; in patterns of more than 500 rows the first such one
/// allocates memory. Folded cloth does not need it: what costs there is that every system needs a
/// factor of its own.
///
/// A system that need not be positive definite, and is not, is given up once a factor has said so,
/// instead of being iterated on.
///
/// The factor is that of the fixed pattern, and so is the one in double precision; where a matrix
/// has couplings they precondition conjugate gradients on the whole matrix. Springs of stiffness
/// k > 0 along n, which put k n n^T into the diagonal blocks of two particles and -k n n^T into
/// their coupling, leave the fixed part positive definite: it is the rest of the matrix plus terms
/// that are not negative. Couplings much softer than the rest take a few iterations in all. In
/// exact arithmetic a spring takes at most two more, and any other coupling six; hundreds of
/// springs that are ten thousand times as stiff as the rest take hundreds, and rounding adds to
/// that. So when they have cost what a factor of the whole matrix does, which knows the couplings
/// and needs a few iterations, that solves this system and the next ones with couplings: at first
/// 8, and twice as many after each further failure up to 512, before the fixed pattern is tried
/// again. Only patterns of more than 500 rows have it, as it allocates memory when couplings appear
/// that the last one had no room for; no smaller pattern ever allocates. It also solves systems
/// that are positive definite with their couplings only. kCholesky knows none of that: there such a
/// matrix counts as one that is not positive definite.
///
/// All costs are counts of operations times the times of one that scripts/bench linear_solver
/// measured, so that the choices depend on the systems alone and a run repeats exactly. They
/// leave out what couplings add to a product.
class LinearSolver {
 public:
  /// About 1.2 million triangles: beyond, a factor takes more than 1.5 kB per triangle. Up to there
  /// it is faster, too, where it serves some systems (scripts/bench scale).
  static constexpr int kMostFactoredRows = 600'000;

  /// @param pool shares the work of a factor and of multigrid if it is given; has to outlive this
  /// @param most_factored_rows of a pattern that kAutomatic has factors of
  LinearSolver(const SymmetricBlockMatrix& pattern, LinearSolverMethod method,
               ThreadPool* pool = nullptr, int most_factored_rows = kMostFactoredRows);

  /// What is known of a system. Matters for kAutomatic and kCholesky.
  enum class Definiteness {
    kPositive,  ///< but for rounding
    kUnknown,   ///< without a solution that is worth a search where it is not positive definite
  };

  /// Solves A x = b until |b - A x| <= tolerance |b|.
  /// @param x initial guess of the conjugate gradients, overwritten by the solution
  SolveResult solve(const SymmetricBlockMatrix& matrix, const BlockVector& rhs, double tolerance,
                    BlockVector& x, Definiteness definiteness = Definiteness::kPositive);

  /// What gave the last solution: kConjugateGradient, also with multigrid, or kCholesky for any
  /// factor.
  LinearSolverMethod lastMethod() const { return last_method_; }
  /// Iterations with the diagonal blocks that are tried first: as many as cost what a solve by a
  /// factor costs; 0 where nothing else would follow.
  int iterationBudget() const;
  /// Factors made so far.
  long factorisations() const;

 private:
  SolveResult solveDirectly(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                            double tolerance, BlockVector& x);
  SolveResult solveByKeptFactor(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                                double tolerance, BlockVector& x);
  SolveResult tryIterations(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                            double tolerance, BlockVector& x);
  SolveResult solveIteratively(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                               double tolerance, int max_iterations, BlockVector& x);
  SolveResult solveByWholeFactor(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                                 double tolerance, BlockVector& x);
  SolveResult solveLarge(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                         double tolerance, BlockVector& x, bool worth_more);
  int lastTry() const;  // iterations
  static int mostIterations(const SymmetricBlockMatrix& matrix);

  LinearSolverMethod method_;
  LinearSolverMethod last_method_ = LinearSolverMethod::kConjugateGradient;
  ThreadPool* pool_;
  ConjugateGradient conjugate_gradient_;
  std::unique_ptr<BlockCholesky> cholesky_;   // of kCholesky, or once it is needed
  std::unique_ptr<KeptFactor> factor_;        // of kAutomatic, as the next one
  std::unique_ptr<KeptFactor> whole_factor_;  // of those of more than 500 rows
  bool is_large_ = false;                     // of kAutomatic, beyond what is factorised
  std::unique_ptr<Multigrid> multigrid_;      // of a large one, once it is needed
  long factorisations_ = 0;                   // in double precision
  Backoff iterations_{8, 512};                // with the diagonal blocks
  Backoff fixed_pattern_{8, 512};             // with a factor of it, where there are couplings
  BlockVector residual_;                      // of solves in double precision
  BlockVector product_;
};

}  // namespace haptex::linear
