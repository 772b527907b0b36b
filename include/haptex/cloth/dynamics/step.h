// How a step in time is taken, and what it tells afterwards.
#pragma once

#include <array>

#include "haptex/cloth/dynamics/safe_motion.h"
#include "haptex/linear/linear_solver.h"

namespace haptex::cloth {

/// How a cloth is advanced in time; docs/mechanics.md has the equations.
enum class IntegrationMethod {
  kBackwardEuler,     ///< Baraff and Witkin 1998; order 1, damps all motion
  kBackwardMidpoint,  ///< Volino and Magnenat-Thalmann 2005; order 2, damps what would grow
  kBdf2,              ///< two-step backward differentiation; order 2, starts with TR-BDF2
  kTrBdf2,            ///< Bank et al. 1985; order 2, two stages
  kExplicitEuler,     ///< order 1
  kExplicitMidpoint,  ///< order 2
  kRungeKutta4,       ///< order 4
  kTwoStepEuler,      ///< Provot 1997: velocities, then positions from the new ones; order 1
};

struct NamedIntegrationMethod {
  const char* name;  ///< in scene files and in what the programs print
  IntegrationMethod method;
};

/// Every method once.
inline constexpr std::array<NamedIntegrationMethod, 8> kIntegrationMethods = {{
    {"backward_euler", IntegrationMethod::kBackwardEuler},
    {"backward_midpoint", IntegrationMethod::kBackwardMidpoint},
    {"bdf2", IntegrationMethod::kBdf2},
    {"tr_bdf2", IntegrationMethod::kTrBdf2},
    {"explicit_euler", IntegrationMethod::kExplicitEuler},
    {"midpoint", IntegrationMethod::kExplicitMidpoint},
    {"runge_kutta_4", IntegrationMethod::kRungeKutta4},
    {"two_step_euler", IntegrationMethod::kTwoStepEuler},
}};

/// Its name in kIntegrationMethods.
constexpr const char* nameOf(IntegrationMethod method) {
  for (const NamedIntegrationMethod& named : kIntegrationMethods) {
    if (named.method == method) return named.name;
  }
  return "";
}

/// Whether a step solves equations. Those that do not are stable for short steps only.
constexpr bool isImplicit(IntegrationMethod method) {
  return method == IntegrationMethod::kBackwardEuler ||
         method == IntegrationMethod::kBackwardMidpoint || method == IntegrationMethod::kBdf2 ||
         method == IntegrationMethod::kTrBdf2;
}

/// Whether a method knows cloth that collides with itself: the ends of its stages are where
/// straight ways from states lead, which can be kept free of intersections. With obstacles it has
/// one stage.
constexpr bool collidesWithItself(IntegrationMethod method, bool among_obstacles) {
  if (method == IntegrationMethod::kBackwardEuler) return true;
  return !among_obstacles &&
         (method == IntegrationMethod::kBdf2 || method == IntegrationMethod::kTrBdf2);
}

/// Whether cloth among rigid bodies (RigidBodies) can be stepped by the method. Backward Euler
/// moves them in one step with the cloth; with explicit methods they are pushed after it.
constexpr bool knowsBodies(IntegrationMethod method) {
  return method == IntegrationMethod::kBackwardEuler || !isImplicit(method);
}

/// Threads that a step may have.
constexpr int kMaxThreads = 64;

struct StepSettings {
  IntegrationMethod method = IntegrationMethod::kBackwardEuler;
  // What follows is for the implicit methods.
  linear::LinearSolverMethod solver = linear::LinearSolverMethod::kAutomatic;
  /// Relative residual |b - A dv| / |b| that every linear solve aims at;
  /// StepReport::linear_converged tells whether it was reached.
  double tolerance = 1e-6;
  /// 1: the linearised stage alone. More: Newton iterations with line search until the residual of
  /// the stage falls below newton_tolerance times the right-hand side of the linearised one, or its
  /// error is small enough (newton_error), or rounding ends it, or this number is spent; where
  /// cloth that touches turns by more than 0.02 rad in a step, at least 5. Of cloth that collides
  /// with itself up to 20 more where the last one was cut, or 40 where newton_error is
  /// missed.
  int newton_iterations = 1;
  double newton_tolerance = 1e-8;
  /// An error E of a stage that is small enough, relative; 0: none is. With weight = mass times
  /// standard gravity and size = square root of the cloth's area at rest, the iterate before the
  /// last solve has at most the error
  ///   E^2 weight size in its incremental potential (J), half of what Newton's step promises,
  ///   E weight in its forces (N), the norm of the residual.
  double newton_error = 0.0;
  /// Threads that share the work of a step, 1 to 64, with the one that calls it. The results are
  /// the same for any number.
  int threads = 1;
};

/// Where the cloth intersects itself, and what was done against it (Untangling).
struct TangleReport {
  int pairs = 0;                        ///< of triangles that intersect
  std::array<int, 2> first = {-1, -1};  ///< the first of them; -1: none
  /// J, of the cloth's potential energy: what it was given by being pulled apart at the end of the
  /// step, and by contact that acts from then on where it did not in the tangle. The energy balance
  /// of steps is without it.
  double energy = 0.0;
};

/// What a step did and took. An explicit one solves nothing: its numbers of solves are zero.
struct StepReport {
  bool accepted = false;         ///< false: system or result was not finite, the state is as before
  bool linear_converged = true;  ///< in every stage
  /// That gave the last solution; kCholesky stands for any factor, kept ones included.
  linear::LinearSolverMethod solver = linear::LinearSolverMethod::kCholesky;
  int linear_iterations = 0;     ///< conjugate gradient iterations of all solves
  double linear_residual = 0;    ///< relative, of the last solve
  int newton_iterations = 0;     ///< linear solves of all stages
  double newton_residual = 0;    ///< of the last stage, relative to the right-hand side of the
                                 ///< linearised one, which is rounding itself when the cloth is
                                 ///< at rest; 0 if not asked for
  bool newton_converged = true;  ///< in every stage, to a tolerance or to rounding
  double blend = 0;              ///< backward midpoint: how far it went from the midpoint, 0, to
                                 ///< the end of the step, 1/2, which is backward Euler
  double energy_taken = 0;  ///< J, that the step had gained and was taken out of its velocities
  bool taken_anew = false;  ///< by backward Euler, because it had gained much (Integrator)
  /// What the cloth was kept from because it would have passed through itself, or through an
  /// obstacle if it collides with itself, in the last motion of the step: where the step has
  /// converged, nothing.
  MotionCut self_cut;
  /// What obstacles of such a cloth were kept from because they would have pressed cloth against
  /// each other (SafeMotion::push()). They go on from there in the next step.
  MotionCut obstacle_cut;
  /// Of a cloth that collides with itself, in the state at the end.
  TangleReport tangle;
  int contact_rounds = 0;  ///< linear solves among them that looked for what touches
  double assembly_seconds = 0;
  double solve_seconds = 0;
  double total_seconds = 0;
};

}  // namespace haptex::cloth
