#include "haptex/studies/extreme_run.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "haptex/base/quantity.h"
#include "haptex/studies/extreme_cloth.h"
#include "haptex/studies/extreme_fingertips.h"
#include "haptex/studies/extreme_state.h"

namespace haptex::studies {
namespace {

using Eigen::Vector3d;

constexpr int kStuckSteps = 5;                                 // rejected one after the other
constexpr int kUnwatched = cloth::EnergyBalance::kRemembered;  // after work was done

std::optional<cloth::Air> airOf(const ExtremeCase& extreme, bool windy) {
  if (extreme.kind != ExtremeKind::kGusts) return std::nullopt;
  cloth::Air air;
  if (!windy) return air;
  RepeatableRandom random(extreme.seed + 3);
  air.wind.mean = 0.5 * extreme.magnitude * random.direction();
  for (int gust = 0; gust < 2; ++gust) {
    air.wind.gusts.push_back({extreme.magnitude * random.direction(),
                              random.logarithmic(0.1, 100.0), random.uniform(0.0, 6.0)});
  }
  return air;
}

class Run {
 public:
  Run(const ExtremeCase& extreme, int most_solved_steps)
      : extreme_(extreme),
        most_solved_steps_(most_solved_steps),
        random_(extreme.seed + 2),
        mesh_(meshOf(extreme)),
        cloth_(clothOf(extreme, mesh_, airOf(extreme, false))),
        rest_(restOf(apart(extreme, mesh_, airOf(extreme, false)))),
        state_(rest_),
        integrator_(cloth_, settingsOf(extreme)),
        intersections_(cloth_) {}

  ExtremeOutcome run() {
    disturb();
    intersections_.failsAt(state_);
    if (intersections_.isTangled()) watch_ = EnergyWatch(kUnwatchedTangled);
    for (int i = 0; i < extreme_.free_steps && !failed(); ++i) freeStep();
    if (failed() || !cloth::isImplicit(extreme_.method)) return outcome_;
    if (rejected_in_a_row_ >= kStuckSteps) {
      outcome_.failure = ExtremeFailure::kStuck;
      return outcome_;
    }
    settleAndJudge(extreme_, cloth_, rest_, most_solved_steps_, intersections_, state_, outcome_);
    return outcome_;
  }

 private:
  static cloth::StepSettings settingsOf(const ExtremeCase& extreme) {
    cloth::StepSettings settings;
    settings.method = extreme.method;
    settings.newton_iterations = extreme.newton_iterations;
    return settings;
  }

  bool failed() const { return outcome_.failure != ExtremeFailure::kNone; }

  double drawStep() { return random_.logarithmic(extreme_.shortest_step, extreme_.longest_step); }

  void disturb() {
    switch (extreme_.kind) {
      case ExtremeKind::kAttachmentJump:
      case ExtremeKind::kAttachmentSpin:
        return moveAttachments();
      case ExtremeKind::kGusts:
        return blow();
      case ExtremeKind::kFabricChange:
        return changeFabric();
      default:
        disturbState(extreme_, cloth_, random_, state_);
    }
  }

  void moveAttachments() {
    const bool spins = extreme_.kind == ExtremeKind::kAttachmentSpin;
    const std::vector<int> attached = attachedParticles(extreme_, mesh_);
    double angle = 0.0;
    for (int i = 0; i < extreme_.disturbed_steps && !failed(); ++i) {
      const double h = drawStep();
      angle += 2.0 * M_PI * extreme_.magnitude * h;
      const Eigen::Matrix3d turn(Eigen::AngleAxisd(spins ? angle : 0.0, Vector3d::UnitZ()));
      const Vector3d jump =
          spins ? Vector3d::Zero() : Vector3d(extreme_.magnitude * random_.direction());
      for (int particle : attached) {
        const Vector3d from = state_.positions[particle];
        const Vector3d to = turn * mesh_.initial_positions[particle] + jump;
        cloth_.attach(particle, {from, to - from, state_.time, spins ? h : 0.0});
      }
      step(cloth_, h);
    }
    for (int particle : attached) {
      cloth_.attach(particle, {mesh_.initial_positions[particle], Vector3d::Zero(), 0.0, 0.0});
    }
    step(cloth_, drawStep());
    watch_ = EnergyWatch(kUnwatched);
  }

  void blow() {
    const cloth::Cloth windy = clothOf(extreme_, mesh_, airOf(extreme_, true));
    for (int i = 0; i < extreme_.disturbed_steps && !failed(); ++i) step(windy, drawStep());
    watch_ = EnergyWatch(kUnwatched);
  }

  void changeFabric() {
    ExtremeCase other = extreme_;
    const double factor = extreme_.magnitude;
    other.weft = std::clamp(other.weft * factor, 1e-3, 1e7);
    other.warp = std::clamp(other.warp * factor, 1e-3, 1e7);
    other.shear = std::clamp(other.shear * factor, 1e-5, 1e7);
    other.density = random_.logarithmic(1e-3, 10.0);
    cloth_.setFabric(fabricOf(other));
    for (int i = 0; i < extreme_.disturbed_steps && !failed(); ++i) freeStep();
    cloth_.setFabric(fabricOf(extreme_));
    watch_ = EnergyWatch(kUnwatched);
  }

  /// @return J, what pulling tangles apart has added
  double step(const cloth::Cloth& cloth, double h) {
    const cloth::StepReport report = integrator_.step(cloth, state_, h);
    const bool accepted = report.accepted;
    ++outcome_.steps;
    outcome_.rejected += !accepted;
    rejected_in_a_row_ = accepted ? 0 : rejected_in_a_row_ + 1;
    if (!isFinite(state_)) {
      outcome_.failure = ExtremeFailure::kNotFinite;
    } else if (intersections_.failsAt(state_)) {
      outcome_.failure = ExtremeFailure::kIntersects;
    }
    return report.tangle.energy;
  }

  /// In which nothing does work on the cloth.
  void freeStep() {
    const cloth::ClothState before = state_;
    watch_.begin(cloth_, before);
    const double pulling = step(cloth_, drawStep());
    if (!failed() && cloth::isImplicit(extreme_.method)) {
      outcome_.growth =
          base::largerOrNaN(outcome_.growth, watch_.growth(cloth_, before, state_, pulling));
      if (!(outcome_.growth <= kRoundingGrowth)) outcome_.failure = ExtremeFailure::kEnergyGrew;
    }
  }

  const ExtremeCase& extreme_;
  int most_solved_steps_;
  RepeatableRandom random_;
  mesh::ClothMesh mesh_;
  cloth::Cloth cloth_;
  cloth::ClothState rest_;
  cloth::ClothState state_;
  cloth::Integrator integrator_;
  IntersectionWatch intersections_;
  ExtremeOutcome outcome_;
  EnergyWatch watch_{0};
  int rejected_in_a_row_ = 0;
};

}  // namespace

const char* nameOf(ExtremeFailure failure) {
  switch (failure) {
    case ExtremeFailure::kThrew:
      return "threw";
    case ExtremeFailure::kNotFinite:
      return "not_finite";
    case ExtremeFailure::kStuck:
      return "stuck";
    case ExtremeFailure::kEnergyGrew:
      return "energy_grew";
    case ExtremeFailure::kIntersects:
      return "intersects";
    case ExtremeFailure::kNoReturn:
      return "no_return";
    case ExtremeFailure::kNone:
      break;
  }
  return "none";
}

ExtremeOutcome runExtremeCase(const ExtremeCase& extreme, int most_solved_steps) {
  try {
    if (extreme.kind == ExtremeKind::kFingertips) return runTouchedCase(extreme, most_solved_steps);
    return Run(extreme, most_solved_steps).run();
  } catch (const std::exception& error) {
    ExtremeOutcome outcome;
    outcome.failure = ExtremeFailure::kThrew;
    outcome.message = error.what();
    return outcome;
  }
}

}  // namespace haptex::studies
