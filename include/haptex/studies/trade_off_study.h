// Study of speed against accuracy: many ways to compute the same motions beside converged ones.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "haptex/studies/trade_off.h"

namespace haptex::studies {

/// Distances of trajectories, or what they are measured by. Root mean squares over the instants,
/// and of positions also over the particles that are compared.
struct TradeOffErrors {
  double position = 0.0;  ///< m
  double force = 0.0;     ///< N
  double energy = 0.0;    ///< J
};

/// Infinite if one of them has fewer snapshots than the other, or a number is not finite.
TradeOffErrors difference(const Trajectory& a, const Trajectory& b);

struct TradeOffCase {
  Motion motion;
  material::Fabric fabric;
};

/// How finely a reference is computed.
struct ReferenceSettings {
  int cells = 32;           ///< along each side, a multiple of 8
  int steps_per_cycle = 8;  ///< even
};

struct Reference {
  Trajectory trajectory;
  /// A third of its distance from a reference with half as many cells and twice the steps, which
  /// is its own error where both are of second order (Richardson 1911).
  TradeOffErrors own_error;
  /// What errors are relative to: the size of the sample, its weight, weight times size.
  TradeOffErrors scale;
};

/// Of hang the static equilibrium; of swing, stretch and fold by TR-BDF2. Of drape, whose impacts
/// are of the first order by any method, by backward Euler, extrapolated to a step of zero from two
/// runs, one with half of the step; its cells are three quarters as many. Newton iterations to the
/// end.
/// @throws std::invalid_argument as follow(), std::runtime_error if a step is refused
Reference computeReference(const TradeOffCase& of, const ReferenceSettings& settings);

/// What a point did in a case.
struct TradeOffResult {
  bool followed = false;  ///< false: not computed, the point is too slow (followPoints())
  /// Every step accepted, no point that is compared ever further than twice the sample's size from
  /// where the reference has it, and the energy never further from that of the reference than ten
  /// times the scale.
  bool stable = false;
  TradeOffErrors distance;  ///< from the reference
  TradeOffErrors error;     ///< the larger of distance and the reference's own error
  /// Geometric mean of the three errors, each over the reference's scale and at least 1e-3, below
  /// which nobody cares.
  double relative_error = 0.0;
  double cost = 0.0;              ///< computing time of one thread per simulated time
  double solves_per_step = 0.0;   ///< linear ones, mean over the motion
  double settling_seconds = 0.0;  ///< Trajectory
};

TradeOffResult compare(const Trajectory& trajectory, const Reference& reference);

/// For progress: called from any thread, never at the same time, with what was done.
using Progress = std::function<void(const std::string& done)>;

/// Follows points in cases, shared among threads.
/// @param most_cost a point that costs more in a case in which nothing touches the cloth is not
///   followed in those after it
/// @return by point, then by case
std::vector<std::vector<TradeOffResult>> followPoints(const std::vector<TradeOffPoint>& points,
                                                      const std::vector<TradeOffCase>& cases,
                                                      const std::vector<Reference>& references,
                                                      double most_cost, int threads,
                                                      const Progress& progress);

/// References of cases, shared among threads.
std::vector<Reference> computeReferences(const std::vector<TradeOffCase>& cases,
                                         const ReferenceSettings& settings, int threads,
                                         const Progress& progress);

/// For what is told: name, value and unit of a quantity.
using Tell = std::function<void(const std::string& name, double value, const char* unit)>;
/// NAME/position_error, NAME/force_error and NAME/energy_error.
void tellErrors(const std::string& name, const TradeOffErrors& errors, const Tell& tell);

/// Unique, for example green_lagrange-backward_euler-12.5ms-16cells-2solves-automatic-0.000001, or
/// ...-20solves-0.001error-automatic-0.000001 where steps end by an error; an explicit method has
/// neither solves nor solver.
std::string nameOf(const TradeOffPoint& point);
const char* nameOf(Motion motion);
const char* nameOf(cloth::Elasticity elasticity);
const char* nameOf(linear::LinearSolverMethod method);

}  // namespace haptex::studies
