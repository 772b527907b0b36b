// What qualities take on this machine, and which of them fits a budget.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "haptex/scene/quality.h"
#include "haptex/simulation/simulated_cloth.h"

namespace haptex::simulation {

/// A quality on this machine.
struct Candidate {
  scene::Quality quality;
  int substeps = 1;       ///< in a cycle
  double seconds = 0.0;   ///< s, computing time of a cycle when nothing else runs; infinity: this
                          ///< quality cannot compute the cloth
  bool measured = false;  ///< here; false: seconds follow from what the study measured, or from the
                          ///< number of solves
  int cycles = 1;         ///< that are taken as one step, in real time
};

/// As few equal substeps as make none longer than the time step (both s, > 0).
int substepsOf(double cycle, double time_step);

/// A quality for a scene: by backward Euler, to the same end of its steps, where the cloth collides
/// with itself or an obstacle has mass, and the quality's method does not know that
/// (cloth::collidesWithItself(), cloth::knowsBodies()). What was measured does not hold then.
scene::Quality knownTo(const scene::Scene& scene, scene::Quality quality);

/// How the candidate takes the steps of a scene, with so many threads.
StepPlan planOf(const Candidate& candidate, int threads);

/// For a cloth that keeps its mesh: of qualities that differ in nothing but the size of the cells
/// only the one whose cells are nearest in size to these (m).
std::vector<scene::Quality> settingsAlone(const std::vector<scene::Quality>& qualities,
                                          double cell_size);

/// What a measurement of a cycle gave, and the time that it took (both s).
struct MeasuredCycle {
  double seconds = 0.0;
  double spent = 0.0;
};
using MeasureCycle = std::function<MeasuredCycle(const scene::Quality& quality, int substeps)>;

/// How much is measured: the first quality always, any other unless the measurements before have
/// spent `allowance` (s), or its cycle is expected to take more than `longest` (s).
struct CalibrationLimits {
  double allowance = 0.0;
  double longest = 0.0;
};

/// Measures qualities in their order. The time of one that is not measured is its cost in the study
/// times the ratio of the last measured one's time to its cost.
/// @param qualities at least one
/// @param cycle     s
std::vector<Candidate> calibrate(const std::vector<scene::Quality>& qualities, double cycle,
                                 const MeasureCycle& measure, const CalibrationLimits& limits);

/// The most accurate, that is the last, whose cycle takes no more than QualityController::kTarget
/// of the budget (s) under a load.
/// @returns nothing if there is none
std::optional<std::size_t> mostAccurateWithin(const std::vector<Candidate>& candidates,
                                              double budget, double load);
std::size_t cheapest(const std::vector<Candidate>& candidates);

/// Settings of cheaper qualities whose cells are others than those of the chosen one and that none
/// with its cells has, each once. They are a way down for a cloth with its cells under heavy load.
/// @param qualities in ascending order of cost; `chosen` < their number
std::vector<scene::Quality> borrowedSettings(const std::vector<scene::Quality>& qualities,
                                             std::size_t chosen);

/// What can be switched among while a cloth runs: the candidates without those that take as long as
/// a later, more accurate one, or longer, and those that cannot compute it. In ascending order of
/// time, strictly.
std::vector<Candidate> ladder(const std::vector<Candidate>& candidates);
/// The same of those with cells of one size (m), and below them others whose settings are borrowed.
/// @param borrowed measured on the cells of that size
std::vector<Candidate> ladder(const std::vector<Candidate>& candidates, double cell_size,
                              std::vector<Candidate> borrowed);

/// A quality and the ways down from it on the same cells, in ascending order of cost: half as many
/// solves in every substep, then half as many substeps, then more cycles in one step. Steps that
/// end by an error become those of backward Euler with two solves first: cut short, BDF-2 and
/// TR-BDF2 can gain energy. An explicit method, whose steps must be short, has no way down. Times
/// follow from the number of solves.
/// @param cycle   s
/// @param seconds of a cycle by the quality
/// @param most_cycles in one step: 1 or more
std::vector<Candidate> reductions(const scene::Quality& quality, double cycle, double seconds,
                                  int most_cycles);

/// For settings on one mesh, where what takes longer counts as more accurate.
void sortByTime(std::vector<Candidate>& candidates);

}  // namespace haptex::simulation
