#include "haptex/simulation/quality_choice.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include "haptex/simulation/quality_controller.h"

namespace haptex::simulation {
namespace {

/// What the study's machine took for a second, the geometric mean of the motions of its fabric.
double studiedCost(const scene::Quality& quality) {
  double logarithms = 0.0;
  int motions = 0;
  for (const scene::MeasuredQuality& measured : quality.measured) {
    if (!quality.fabric.empty() && measured.fabric != quality.fabric) continue;
    logarithms += std::log(measured.cost);
    ++motions;
  }
  return std::exp(logarithms / motions);
}

/// About what a step that ends by an error takes while stiff cloth moves (docs/mechanics.md).
constexpr double kSolvesToAnError = 6.0;

std::string milliseconds(double seconds) {
  std::ostringstream text;
  text << 1e3 * seconds << " ms";
  return text.str();
}

bool sameSettings(const scene::Quality& a, const scene::Quality& b) {
  return a.time_step == b.time_step && a.step.method == b.step.method &&
         a.step.solver == b.step.solver && a.step.tolerance == b.step.tolerance &&
         a.step.newton_iterations == b.step.newton_iterations &&
         a.step.newton_error == b.step.newton_error;
}

}  // namespace

int substepsOf(double cycle, double time_step) {
  constexpr double kRounding = 1e-9;
  return std::max(1, static_cast<int>(std::ceil(cycle / time_step * (1.0 - kRounding))));
}

scene::Quality knownTo(const scene::Scene& scene, scene::Quality quality) {
  const cloth::ModelledEffects& effects = scene.effects;
  const cloth::IntegrationMethod method = quality.step.method;
  const bool bodies =
      std::any_of(scene.obstacles.begin(), scene.obstacles.end(),
                  [](const mesh::Obstacle& obstacle) { return obstacle.body.has_value(); });
  if ((!effects.self_collision || cloth::collidesWithItself(method, effects.contacts)) &&
      (!bodies || cloth::knowsBodies(method))) {
    return quality;
  }
  quality.step.method = cloth::IntegrationMethod::kBackwardEuler;
  quality.name += std::string(", ") + nameOf(quality.step.method);
  quality.measured.clear();
  return quality;
}

StepPlan planOf(const Candidate& candidate, int threads) {
  StepPlan plan{candidate.quality.step, candidate.substeps, candidate.cycles};
  plan.step.threads = threads;
  return plan;
}

std::vector<scene::Quality> settingsAlone(const std::vector<scene::Quality>& qualities,
                                          double cell_size) {
  const auto distance = [&](const scene::Quality& quality) {
    return std::abs(std::log(quality.cell_size / cell_size));
  };
  std::vector<scene::Quality> alone;
  for (const scene::Quality& quality : qualities) {
    const auto same = std::find_if(alone.begin(), alone.end(), [&](const scene::Quality& other) {
      return sameSettings(quality, other);
    });
    if (same == alone.end()) {
      alone.push_back(quality);
    } else if (distance(quality) < distance(*same)) {
      *same = quality;
    }
  }
  return alone;
}

std::vector<Candidate> calibrate(const std::vector<scene::Quality>& qualities, double cycle,
                                 const MeasureCycle& measure, const CalibrationLimits& limits) {
  std::vector<Candidate> candidates;
  double spent = 0.0;
  double ratio = 0.0;  // s of a cycle per cost in the study, 0: nothing has been measured
  for (const scene::Quality& quality : qualities) {
    Candidate candidate;
    candidate.quality = quality;
    candidate.substeps = substepsOf(cycle, quality.time_step);
    const double cost = studiedCost(quality);
    candidate.measured =
        ratio == 0.0 || (spent < limits.allowance && ratio * cost <= limits.longest);
    if (candidate.measured) {
      const MeasuredCycle measured = measure(quality, candidate.substeps);
      candidate.seconds = measured.seconds;
      spent += measured.spent;
      if (std::isfinite(measured.seconds)) ratio = measured.seconds / cost;
    } else {
      candidate.seconds = ratio * cost;
    }
    candidates.push_back(std::move(candidate));
  }
  return candidates;
}

std::optional<std::size_t> mostAccurateWithin(const std::vector<Candidate>& candidates,
                                              double budget, double load) {
  for (std::size_t i = candidates.size(); i-- > 0;) {
    if (load * candidates[i].seconds <= QualityController::kTarget * budget) return i;
  }
  return std::nullopt;
}

std::size_t cheapest(const std::vector<Candidate>& candidates) {
  const auto less = [](const Candidate& a, const Candidate& b) { return a.seconds < b.seconds; };
  return static_cast<std::size_t>(std::min_element(candidates.begin(), candidates.end(), less) -
                                  candidates.begin());
}

std::vector<scene::Quality> borrowedSettings(const std::vector<scene::Quality>& qualities,
                                             std::size_t chosen) {
  const double cell_size = qualities[chosen].cell_size;
  std::vector<scene::Quality> cheaper(qualities.begin(),
                                      qualities.begin() + static_cast<std::ptrdiff_t>(chosen));
  std::vector<scene::Quality> borrowed;
  for (const scene::Quality& quality : settingsAlone(cheaper, cell_size)) {
    const bool known =
        std::any_of(qualities.begin(), qualities.end(), [&](const scene::Quality& other) {
          return other.cell_size == cell_size && sameSettings(quality, other);
        });
    if (!known) borrowed.push_back(quality);
  }
  return borrowed;
}

std::vector<Candidate> ladder(const std::vector<Candidate>& candidates) {
  std::vector<Candidate> rungs;
  for (auto candidate = candidates.rbegin(); candidate != candidates.rend(); ++candidate) {
    if (!std::isfinite(candidate->seconds)) continue;
    if (!rungs.empty() && candidate->seconds >= rungs.back().seconds) continue;
    rungs.push_back(*candidate);
  }
  std::reverse(rungs.begin(), rungs.end());
  return rungs;
}

std::vector<Candidate> ladder(const std::vector<Candidate>& candidates, double cell_size,
                              std::vector<Candidate> borrowed) {
  sortByTime(borrowed);
  for (const Candidate& candidate : candidates) {
    if (candidate.quality.cell_size == cell_size) borrowed.push_back(candidate);
  }
  return ladder(borrowed);
}

std::vector<Candidate> reductions(const scene::Quality& quality, double cycle, double seconds,
                                  int most_cycles) {
  Candidate next;
  next.quality = quality;
  next.substeps = substepsOf(cycle, quality.time_step);
  next.seconds = seconds;
  next.measured = true;
  std::vector<Candidate> rungs = {next};
  const auto solves = [](const Candidate& candidate) {
    const cloth::StepSettings& step = candidate.quality.step;
    const double of_step = step.newton_error > 0.0 ? kSolvesToAnError : step.newton_iterations;
    return of_step * candidate.substeps / candidate.cycles;
  };
  next.quality.measured.clear();
  next.measured = false;
  while (cloth::isImplicit(quality.step.method)) {
    int& iterations = next.quality.step.newton_iterations;
    if (next.quality.step.newton_error > 0.0) {
      next.quality.step.method = cloth::IntegrationMethod::kBackwardEuler;
      next.quality.step.newton_error = 0.0;
      iterations = std::min(iterations, 2);
    } else if (iterations > 1) {
      iterations /= 2;
    } else if (next.substeps > 1) {
      next.substeps /= 2;
    } else if (next.cycles < most_cycles) {
      ++next.cycles;
    } else {
      break;
    }
    next.quality.time_step = next.cycles * cycle / next.substeps;
    next.quality.name =
        quality.name + ", " + nameOf(next.quality.step.method) + ", " + std::to_string(iterations) +
        (iterations == 1 ? " solve in " : " solves in ") + milliseconds(next.quality.time_step);
    next.seconds = seconds * solves(next) / solves(rungs.front());
    rungs.push_back(next);
  }
  std::reverse(rungs.begin(), rungs.end());
  return rungs;
}

void sortByTime(std::vector<Candidate>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.seconds < b.seconds; });
}

}  // namespace haptex::simulation
