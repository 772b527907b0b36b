#include "haptex/studies/extreme_shrink.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "haptex/studies/extreme_run.h"

namespace haptex::studies {
namespace {

using Change = std::function<void(ExtremeCase&)>;

Change setTo(double ExtremeCase::*field, double value) {
  return [=](ExtremeCase& extreme) { extreme.*field = value; };
}

Change setTo(int ExtremeCase::*field, int value) {
  return [=](ExtremeCase& extreme) { extreme.*field = value; };
}

/// Half of the way to a value, rounded towards it.
Change approach(int ExtremeCase::*field, int value) {
  return [=](ExtremeCase& extreme) { extreme.*field = value + (extreme.*field - value) / 2; };
}

Change decrease(int ExtremeCase::*field, int least) {
  return [=](ExtremeCase& extreme) { extreme.*field -= extreme.*field > least; };
}

/// To the next power of ten in the direction of a value: fewer digits, milder.
Change approachDecade(double ExtremeCase::*field, double value) {
  return [=](ExtremeCase& extreme) {
    const double decades = std::log10(extreme.*field / value);
    if (decades == 0.0) return;
    const double step = std::ceil(std::abs(decades)) - 1.0;
    extreme.*field = value * std::pow(10.0, std::copysign(step, decades));
  };
}

/// The strong ones first.
std::vector<Change> changes() {
  std::vector<Change> result = {
      [](ExtremeCase& e) { e.self_collision = false; },
      setTo(&ExtremeCase::bending, 0.0),
      setTo(&ExtremeCase::viscosity, 0.0),
      setTo(&ExtremeCase::stiffening, 1.0),
      setTo(&ExtremeCase::irregularity, 0.0),
      setTo(&ExtremeCase::needle, 1.0),
      setTo(&ExtremeCase::newton_iterations, 1),
      [](ExtremeCase& e) { e.method = cloth::IntegrationMethod::kBackwardEuler; },
      [](ExtremeCase& e) { e.taut = false; },
      [](ExtremeCase& e) { e.warp = e.weft; },
      [](ExtremeCase& e) { e.shear = 0.5 * e.weft; },
      [](ExtremeCase& e) { e.shortest_step = e.longest_step; },
  };
  for (int ExtremeCase::*cells : {&ExtremeCase::cells_u, &ExtremeCase::cells_v}) {
    result.push_back(approach(cells, 1));
    result.push_back(decrease(cells, 1));
  }
  for (int ExtremeCase::*steps : {&ExtremeCase::disturbed_steps, &ExtremeCase::free_steps}) {
    result.push_back(approach(steps, 1));
    result.push_back(decrease(steps, 1));
  }
  const ExtremeCase plain;
  for (double ExtremeCase::*number :
       {&ExtremeCase::weft, &ExtremeCase::warp, &ExtremeCase::shear, &ExtremeCase::density,
        &ExtremeCase::cell, &ExtremeCase::strain, &ExtremeCase::longest_step,
        &ExtremeCase::shortest_step, &ExtremeCase::magnitude}) {
    result.push_back(setTo(number, plain.*number));
    result.push_back(approachDecade(number, plain.*number));
  }
  return result;
}

}  // namespace

ExtremeCase shrinkExtremeCase(const ExtremeCase& extreme,
                              const std::function<bool(const ExtremeCase&)>& fails) {
  constexpr int kMaxTries = 300;  // a case that comes back late may take a second
  ExtremeCase smallest = extreme;
  int tries = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (const Change& change : changes()) {
      ExtremeCase candidate = smallest;
      change(candidate);
      if (toText(candidate) == toText(smallest)) continue;
      if (candidate.shear > std::min(candidate.weft, candidate.warp)) continue;  // is never drawn
      if (++tries > kMaxTries) return smallest;
      if (!fails(candidate)) continue;
      smallest = candidate;
      changed = true;
    }
  }
  return smallest;
}

ExtremeCase shrinkFailure(const ExtremeCase& extreme, const ExtremeOutcome& outcome) {
  constexpr int kMaxRuns = 100;
  int runs = 0;
  int left = kMostSolvedSteps;  // for all of them
  return shrinkExtremeCase(extreme, [&](const ExtremeCase& candidate) {
    if (++runs > kMaxRuns || left <= 0) return false;
    const int most = std::min(left, 2 * outcome.settling_steps);
    const ExtremeOutcome its = runExtremeCase(candidate, most);
    left -= its.settling_steps;
    // One that was cut short might return later.
    const bool is_open = its.failure == ExtremeFailure::kNoReturn && most < kMostSolvedSteps &&
                         its.settling_steps >= most;
    return its.failure == outcome.failure && !is_open;
  });
}

}  // namespace haptex::studies
