#pragma once
namespace haptex::cloth {
/// How a linear system is solved.
enum class LinearSolverMethod {
  kConjugateGradient,
  kCholesky,
  kAutomatic,  ///< whichever is cheaper for the system at hand, see LinearSolver
};
}
