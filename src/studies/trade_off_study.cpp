#include "haptex/studies/trade_off_study.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <numeric>
#include <stdexcept>

#include "haptex/base/constants.h"
#include "haptex/linear/thread_pool.h"
#include "haptex/oracles/checks/cloth_oracles.h"

namespace haptex::studies {
namespace {

using cloth::IntegrationMethod;

Trajectory followed(const TradeOffCase& of, const TradeOffPoint& point) {
  Trajectory trajectory = follow(of.motion, of.fabric, point);
  if (!trajectory.accepted) {
    throw std::runtime_error(std::string("a step of the reference of ") + nameOf(of.motion) +
                             " was not accepted");
  }
  return trajectory;
}

/// To a step of zero, of a method of the first order.
Trajectory extrapolated(const Trajectory& twice_the_step, Trajectory fine) {
  for (std::size_t k = 0; k < fine.snapshots.size(); ++k) {
    Snapshot& to = fine.snapshots[k];
    const Snapshot& from = twice_the_step.snapshots[k];
    for (std::size_t i = 0; i < to.positions.size(); ++i) {
      to.positions[i] = 2.0 * to.positions[i] - from.positions[i];
    }
    to.force = 2.0 * to.force - from.force;
    to.energy = 2.0 * to.energy - from.energy;
  }
  return fine;
}

Trajectory converged(const TradeOffCase& of, int cells, int steps_per_cycle) {
  TradeOffPoint point;
  point.cells = cells;
  point.steps_per_cycle = steps_per_cycle;
  point.step.tolerance = 1e-8;
  point.step.newton_iterations = 20;
  point.step.newton_tolerance = 1e-7;
  if (of.motion == Motion::kHang) return restOfHang(of.fabric, point);
  if (of.motion != Motion::kDrape) {
    point.step.method = IntegrationMethod::kTrBdf2;
    point.step.newton_error = 1e-5;
    return followed(of, point);
  }
  // What impacts leave open is in the steps: finer cells would cost without showing it.
  point.cells = 3 * cells / 4;
  TradeOffPoint fine = point;
  fine.steps_per_cycle *= 2;
  return extrapolated(followed(of, point), followed(of, fine));
}

TradeOffErrors scaleOf(const TradeOffCase& of) {
  const double weight =
      of.fabric.areal_density * kSampleSize * kSampleSize * base::kStandardGravity;
  return {kSampleSize, weight, weight * kSampleSize};
}

Reference referenceOf(const TradeOffCase& of, Trajectory fine, const Trajectory& coarse) {
  const TradeOffErrors apart = difference(fine, coarse);
  return {
      std::move(fine), {apart.position / 3.0, apart.force / 3.0, apart.energy / 3.0}, scaleOf(of)};
}

/// Runs tasks on threads; the first exception is thrown when all are done.
template <typename Task>
void share(int tasks, int threads, const Task& run) {
  std::mutex mutex;
  std::exception_ptr failure;
  linear::ThreadPool(threads).run(tasks, [&](int task, int) {
    try {
      run(task);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  });
  if (failure) std::rethrow_exception(failure);
}

bool isStable(const Trajectory& trajectory, const Reference& reference) {
  const std::vector<Snapshot>& true_ones = reference.trajectory.snapshots;
  if (!trajectory.accepted || trajectory.snapshots.size() != true_ones.size()) return false;
  for (std::size_t k = 0; k < true_ones.size(); ++k) {
    const Snapshot& snapshot = trajectory.snapshots[k];
    const double gained = std::abs(snapshot.energy - true_ones[k].energy);
    if (!(gained <= 10.0 * reference.scale.energy)) return false;
    for (std::size_t i = 0; i < snapshot.positions.size(); ++i) {
      const double way = (snapshot.positions[i] - true_ones[k].positions[i]).norm();
      if (!(way <= 2.0 * reference.scale.position)) return false;
    }
  }
  return true;
}

double relativeError(const TradeOffErrors& error, const TradeOffErrors& scale) {
  constexpr double kNegligible = 1e-3;
  return std::cbrt(std::max(kNegligible, error.position / scale.position) *
                   std::max(kNegligible, error.force / scale.force) *
                   std::max(kNegligible, error.energy / scale.energy));
}

}  // namespace

TradeOffErrors difference(const Trajectory& a, const Trajectory& b) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  if (a.snapshots.size() != b.snapshots.size() || a.snapshots.empty()) {
    return {kInfinite, kInfinite, kInfinite};
  }
  TradeOffErrors squares;
  const double share = 1.0 / static_cast<double>(a.snapshots.size());
  for (std::size_t k = 0; k < a.snapshots.size(); ++k) {
    const Snapshot& one = a.snapshots[k];
    const Snapshot& other = b.snapshots[k];
    for (std::size_t i = 0; i < one.positions.size(); ++i) {
      squares.position += share / static_cast<double>(one.positions.size()) *
                          (one.positions[i] - other.positions[i]).squaredNorm();
    }
    squares.force += share * (one.force - other.force).squaredNorm();
    squares.energy += share * std::pow(one.energy - other.energy, 2);
  }
  const auto root = [](double square) {
    return std::isfinite(square) ? std::sqrt(square) : kInfinite;
  };
  return {root(squares.position), root(squares.force), root(squares.energy)};
}

Reference computeReference(const TradeOffCase& of, const ReferenceSettings& settings) {
  return computeReferences({of}, settings, 1, {}).front();
}

std::vector<Reference> computeReferences(const std::vector<TradeOffCase>& cases,
                                         const ReferenceSettings& settings, int threads,
                                         const Progress& progress) {
  std::mutex mutex;
  std::vector<Trajectory> trajectories(2 * cases.size());  // fine ones, then coarse ones
  share(static_cast<int>(trajectories.size()), threads, [&](int task) {
    const TradeOffCase& of = cases[task % cases.size()];
    const int coarser = task < static_cast<int>(cases.size()) ? 1 : 2;
    trajectories[task] =
        converged(of, settings.cells / coarser, settings.steps_per_cycle / coarser);
    const std::lock_guard<std::mutex> lock(mutex);
    if (progress) {
      progress(std::string("reference of ") + nameOf(of.motion) + ", " + of.fabric.name + ", " +
               std::to_string(settings.cells / coarser) + " cells");
    }
  });
  std::vector<Reference> references;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    references.push_back(
        referenceOf(cases[i], std::move(trajectories[i]), trajectories[cases.size() + i]));
  }
  return references;
}

TradeOffResult compare(const Trajectory& trajectory, const Reference& reference) {
  TradeOffResult result;
  result.followed = true;
  result.distance = difference(trajectory, reference.trajectory);
  result.stable = isStable(trajectory, reference);
  const TradeOffErrors& own = reference.own_error;
  result.error = {std::max(result.distance.position, own.position),
                  std::max(result.distance.force, own.force),
                  std::max(result.distance.energy, own.energy)};
  result.relative_error = relativeError(result.error, reference.scale);
  if (trajectory.simulated_seconds > 0.0) {
    result.cost = trajectory.computing_seconds / trajectory.simulated_seconds;
  }
  if (trajectory.steps > 0) {
    result.solves_per_step = static_cast<double>(trajectory.solves) / trajectory.steps;
  }
  result.settling_seconds = trajectory.settling_seconds;
  return result;
}

std::vector<std::vector<TradeOffResult>> followPoints(const std::vector<TradeOffPoint>& points,
                                                      const std::vector<TradeOffCase>& cases,
                                                      const std::vector<Reference>& references,
                                                      double most_cost, int threads,
                                                      const Progress& progress) {
  std::mutex mutex;
  std::vector<std::vector<TradeOffResult>> results(points.size(),
                                                   std::vector<TradeOffResult>(cases.size()));
  share(static_cast<int>(points.size()), threads, [&](int task) {
    for (std::size_t i = 0; i < cases.size(); ++i) {
      if (!canFollow(cases[i].motion, points[task])) continue;
      results[task][i] =
          compare(follow(cases[i].motion, cases[i].fabric, points[task]), references[i]);
      if (!isTouched(cases[i].motion) && results[task][i].cost > most_cost) break;
    }
    const std::lock_guard<std::mutex> lock(mutex);
    if (progress) progress(nameOf(points[task]));
  });
  return results;
}

void tellErrors(const std::string& name, const TradeOffErrors& errors, const Tell& tell) {
  tell(name + "/position_error", errors.position, "m");
  tell(name + "/force_error", errors.force, "N");
  tell(name + "/energy_error", errors.energy, "J");
}

std::string nameOf(const TradeOffPoint& point) {
  std::string name =
      std::string(nameOf(point.elasticity)) + "-" + cloth::nameOf(point.step.method) + "-" +
      oracles::numbered(1e3 * point.timeStep()) + "ms-" + std::to_string(point.cells) + "cells";
  if (isImplicit(point.step.method)) {
    name += "-" + std::to_string(point.step.newton_iterations) + "solves-";
    if (point.step.newton_error > 0.0)
      name += oracles::numbered(point.step.newton_error) + "error-";
    name += std::string(nameOf(point.step.solver)) + "-" + oracles::numbered(point.step.tolerance);
  }
  if (point.thickness != 1.0) name += "-" + oracles::numbered(point.thickness) + "thickness";
  return name;
}

const char* nameOf(Motion motion) { return kMotions[static_cast<std::size_t>(motion)].name; }

const char* nameOf(cloth::Elasticity elasticity) {
  switch (elasticity) {
    case cloth::Elasticity::kBilinear:
      return "bilinear";
    case cloth::Elasticity::kMassSpring:
      return "mass_spring";
    case cloth::Elasticity::kCorotational:
      return "corotational";
    default:
      return "green_lagrange";
  }
}

const char* nameOf(linear::LinearSolverMethod method) {
  switch (method) {
    case linear::LinearSolverMethod::kConjugateGradient:
      return "conjugate_gradient";
    case linear::LinearSolverMethod::kCholesky:
      return "cholesky";
    default:
      return "automatic";
  }
}

}  // namespace haptex::studies
