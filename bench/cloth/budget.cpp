// Does a budget of computing time hold while other programs come and go, and is the error that it
// promises the one that there is? A sample of wool and one of the linear reference swing as in the
// trade-off study, over and over, in real time with a budget; every three seconds twice as many
// busy threads as there are cores begin or stop to compete. Prints the share of cycles inside the
// budget from a second after each such change on, how often the quality was changed, and the errors
// in position, force and energy against the study's reference beside what the qualities that ran
// had been measured to miss.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "haptex/base/constants.h"
#include "haptex/base/processors.h"
#include "haptex/kes/equilibrium.h"
#include "haptex/material/fabric_file.h"
#include "haptex/scene/quality_file.h"
#include "haptex/simulation/quality_choice.h"
#include "haptex/simulation/real_time_loop.h"
#include "haptex/simulation/studied_fabrics.h"
#include "haptex/studies/trade_off_study.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using Clock = std::chrono::steady_clock;
using studies::kCycle;

constexpr double kBudget = 4e-3;   // s of a cycle of 12.5 ms
constexpr double kPhase = 3.0;     // s, between two changes of the load
constexpr double kSettling = 1.0;  // s
constexpr int kPhases = 4;
constexpr int kSwingCycles = 100;  // of the study's swing

double since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Twice as many threads as cores, that compute or sleep.
class CompetingLoad {
 public:
  CompetingLoad() {
    const int count = 2 * base::processorCount();
    for (int i = 0; i < count; ++i) threads_.emplace_back([this] { work(); });
  }
  ~CompetingLoad() {
    ended_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  void set(bool busy) { busy_ = busy; }

 private:
  void work() {
    while (!ended_) {
      if (!busy_) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }

  std::atomic<bool> busy_{false};
  std::atomic<bool> ended_{false};
  std::vector<std::thread> threads_;
};

/// The sample of the study, hanging at rest.
scene::Scene swingScene(const material::Fabric& fabric, double cell_size) {
  scene::Scene scene;
  const int cells = static_cast<int>(std::lround(studies::kSampleSize / cell_size));
  scene.mesh = mesh::makeRectangle(studies::kSampleSize, studies::kSampleSize, cells, cells,
                                   mesh::Triangulation::kAlternating);
  scene.effects.viscosity = true;
  scene.effects.gravity = {0.0, 0.0, -base::kStandardGravity};
  scene.effects.bending = fabric.bending.has_value();
  scene.attached_particles = sideParticles(scene.mesh, mesh::Side::kTop);
  scene.time_step = kCycle;
  cloth::Cloth cloth(scene.mesh, fabric, scene.effects);
  for (const int particle : scene.attached_particles) {
    cloth.attach(particle, {scene.mesh.initial_positions[particle], Eigen::Vector3d::Zero(), 0, 0});
  }
  cloth::ClothState state = cloth.initialState();
  kes::Equilibrium(cloth).settle(cloth, state, 0.1);
  scene.mesh.initial_positions = state.positions;
  return scene;
}

/// Moves the bar as in the study, and starts anew when the swing is over.
void direct(simulation::SimulatedCloth& simulation, const std::vector<std::uint32_t>& bar) {
  if (simulation.steps() == kSwingCycles) simulation.reset();
  if (simulation.steps() == 0) simulation.move(bar, {0.08, 0.0, 0.0}, 32 * kCycle);
  if (simulation.steps() == 40) simulation.move(bar, {-0.16, 0.0, 0.0}, 40 * kCycle);
}

std::vector<std::uint32_t> barOf(const scene::Scene& scene) {
  return {scene.attached_particles.begin(), scene.attached_particles.end()};
}

/// The median cycle of a swing.
simulation::MeasuredCycle measureSwing(const material::Fabric& fabric,
                                       const scene::Quality& quality, int substeps) {
  const Clock::time_point begin = Clock::now();
  scene::Scene scene = swingScene(fabric, quality.cell_size);
  const std::vector<std::uint32_t> bar = barOf(scene);
  simulation::SimulatedCloth simulation(std::move(scene), fabric, {{quality.step, substeps}});
  std::vector<double> cycles;
  while (simulation.steps() < kSwingCycles) {
    direct(simulation, bar);
    const Clock::time_point step_begin = Clock::now();
    if (!simulation.step()) return {std::numeric_limits<double>::infinity(), since(begin)};
    cycles.push_back(since(step_begin));
  }
  std::nth_element(cycles.begin(), cycles.begin() + kSwingCycles / 2, cycles.end());
  return {cycles[kSwingCycles / 2], since(begin)};
}

/// Mean squared distance (m^2) of the particles from where they are to be, of those that lie where
/// the study compares.
double squaredError(const simulation::SimulatedCloth& simulation, int cells,
                    const studies::Snapshot& reference) {
  constexpr int kCompared = studies::kComparedIntervals;
  double sum = 0.0;
  int count = 0;
  for (int j = 0; j <= kCompared; ++j) {
    for (int i = 0; i <= kCompared; ++i) {
      if (i * cells % kCompared != 0 || j * cells % kCompared != 0) continue;
      const int particle = j * cells / kCompared * (cells + 1) + i * cells / kCompared;
      const Eigen::Vector3d& position = simulation.state().positions[particle];
      sum += (position - reference.positions[j * (kCompared + 1) + i]).squaredNorm();
      ++count;
    }
  }
  return sum / count;
}

Eigen::Vector3d momentumOf(const simulation::SimulatedCloth& simulation) {
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();
  const std::vector<double>& masses = simulation.cloth().masses();
  for (std::size_t i = 0; i < masses.size(); ++i) {
    momentum += masses[i] * simulation.state().velocities[i];
  }
  return momentum;
}

Eigen::Vector3d weightOf(const cloth::Cloth& cloth) {
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();
  for (double mass : cloth.masses()) weight += mass * cloth.effects().gravity;
  return weight;
}

double energyOf(const simulation::SimulatedCloth& simulation) {
  const cloth::Cloth& cloth = simulation.cloth();
  return cloth.potentialEnergy(simulation.state()) + cloth.kineticEnergy(simulation.state());
}

/// Sums of squared errors over cycles (m^2, N^2, J^2).
struct Squares {
  double position = 0.0;
  double force = 0.0;
  double energy = 0.0;
};

/// What the loop's thread notes down.
struct Record {
  int cycles = 0;
  Squares error;
  Squares expected;
  int settled[2] = {0, 0};         // cycles without and with load, settled
  int within[2] = {0, 0};          // those inside the budget
  double quality[2] = {0.0, 0.0};  // sum of their places on the ladder
  std::size_t changes = 0;
};

class BudgetRun {
 public:
  BudgetRun(const std::string& fabric, std::vector<simulation::Candidate> rungs, std::size_t first)
      : fabric_(material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/" + fabric + ".yaml")),
        rungs_(std::move(rungs)),
        first_(first),
        scene_(swingScene(fabric_, rungs_[first].quality.cell_size)),
        bar_(barOf(scene_)),
        cells_(
            static_cast<int>(std::lround(studies::kSampleSize / rungs_[first].quality.cell_size))) {
    for (const simulation::Candidate& rung : rungs_) {
      expected_.push_back(simulation::measurementsOf(rung.quality, fabric));
    }
  }

  Record run(const studies::Trajectory& reference) {
    CompetingLoad load;
    simulation::RealTimeLoop loop(
        simulation(),
        [&](const simulation::SimulatedCloth& simulation, bool) { note(simulation, reference); },
        [&](simulation::SimulatedCloth& simulation) {
          direct(simulation, bar_);
          if (simulation.steps() == 0) first_energy_ = energyOf(simulation);
          momentum_ = momentumOf(simulation);
          plan_ = simulation.plan();
          step_begin_ = Clock::now();
        });
    begin_ = Clock::now();
    loop.start();
    for (int phase = 0; phase < kPhases; ++phase) {
      load.set(phase % 2 == 1);
      std::this_thread::sleep_until(begin_ +
                                    std::chrono::duration_cast<Clock::duration>(
                                        std::chrono::duration<double>((phase + 1) * kPhase)));
      std::fprintf(stderr, "%s: %.0f of %.0f s\n", fabric_.name.c_str(), (phase + 1) * kPhase,
                   kPhases * kPhase);
    }
    load.set(false);
    loop.execute([&](simulation::SimulatedCloth& simulation) {
      record_.changes = simulation.controller()->changes();
    });
    loop.stop();
    return record_;
  }

 private:
  simulation::SimulatedCloth simulation() const {
    std::vector<simulation::StepPlan> plans;
    std::vector<double> costs;
    for (const simulation::Candidate& rung : rungs_) {
      plans.push_back(planOf(rung, 1));
      costs.push_back(rung.seconds);
    }
    simulation::SimulatedCloth simulation(scene_, fabric_, std::move(plans));
    simulation.setController(
        simulation::QualityController(std::move(costs), kBudget, kCycle, first_));
    return simulation;
  }

  void note(const simulation::SimulatedCloth& simulation, const studies::Trajectory& reference) {
    const double took = since(step_begin_);
    const double time = std::chrono::duration<double>(step_begin_ - begin_).count();
    ++record_.cycles;
    const studies::Snapshot& exact = reference.snapshots.at(simulation.steps() - 1);
    const Eigen::Vector3d force =
        (momentumOf(simulation) - momentum_) / kCycle - weightOf(simulation.cloth());
    record_.error.position += squaredError(simulation, cells_, exact);
    record_.error.force += (force - exact.force).squaredNorm();
    record_.error.energy += std::pow(energyOf(simulation) - first_energy_ - exact.energy, 2);
    for (const scene::MeasuredQuality& measured : expected_[plan_]) {
      if (measured.motion != "swing") continue;
      record_.expected.position += std::pow(measured.position_error, 2);
      record_.expected.force += std::pow(measured.force_error, 2);
      record_.expected.energy += std::pow(measured.energy_error, 2);
    }
    if (std::fmod(time, kPhase) < kSettling || time >= kPhases * kPhase) return;
    const int loaded = static_cast<int>(time / kPhase) % 2;
    ++record_.settled[loaded];
    record_.within[loaded] += took <= kBudget ? 1 : 0;
    record_.quality[loaded] += static_cast<double>(plan_);
  }

  material::Fabric fabric_;
  std::vector<simulation::Candidate> rungs_;
  std::size_t first_;
  scene::Scene scene_;
  std::vector<std::uint32_t> bar_;
  int cells_;
  std::vector<std::vector<scene::MeasuredQuality>> expected_;
  // Touched by the loop's thread.
  Record record_;
  std::size_t plan_ = 0;
  double first_energy_ = 0.0;  // J
  Eigen::Vector3d momentum_ = Eigen::Vector3d::Zero();
  Clock::time_point step_begin_, begin_;
};

void print(const std::string& fabric, const Record& record) {
  const std::string name = "budget/" + fabric + "/";
  const double settled = record.settled[0] + record.settled[1];
  bench::printLine(name + "budget", 1e3 * kBudget, "ms");
  bench::printLine(name + "within_budget", 100.0 * (record.within[0] + record.within[1]) / settled,
                   "%");
  for (const int loaded : {0, 1}) {
    const std::string which = loaded ? "with_load/" : "without_load/";
    const double cycles = record.settled[loaded];
    bench::printLine(name + which + "within_budget", 100.0 * record.within[loaded] / cycles, "%");
    bench::printLine(name + which + "mean_rung", record.quality[loaded] / cycles, "");
  }
  bench::printLine(name + "changes", static_cast<double>(record.changes), "");
  const auto print_error = [&](const std::string& of, double expected, double error, double scale,
                               const char* unit) {
    expected = std::sqrt(expected / record.cycles);
    error = std::sqrt(error / record.cycles);
    bench::printLine(name + "expected_" + of + "_error", scale * expected, unit);
    bench::printLine(name + of + "_error", scale * error, unit);
    bench::printLine(name + of + "_error_over_expected", error / expected, "");
  };
  print_error("position", record.expected.position, record.error.position, 1e3, "mm");
  print_error("force", record.expected.force, record.error.force, 1e3, "mN");
  print_error("energy", record.expected.energy, record.error.energy, 1e3, "mJ");
}

void runBench(const std::string& name) {
  const material::Fabric fabric =
      material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/" + name + ".yaml");
  const auto front = simulation::qualitiesFor(
      fabric, scene::loadQualities(HAPTEX_CONFIG_DIRECTORY "/presets/front.yaml"),
      {{name, simulation::tensileModulus(fabric)}});
  std::fprintf(stderr, "%s: calibrating\n", name.c_str());
  const auto measure = [&](const scene::Quality& quality, int substeps) {
    return measureSwing(fabric, quality, substeps);
  };
  const std::vector<simulation::Candidate> candidates =
      simulation::calibrate(front, kCycle, measure, {5.0, 4.0 * kBudget});
  const std::size_t chosen =
      mostAccurateWithin(candidates, kBudget, 1.0).value_or(cheapest(candidates));
  const double cell_size = candidates[chosen].quality.cell_size;
  std::vector<simulation::Candidate> borrowed;
  for (const scene::Quality& quality : simulation::borrowedSettings(front, chosen)) {
    scene::Quality on_cells = quality;
    on_cells.cell_size = cell_size;
    borrowed.push_back(simulation::calibrate({on_cells}, kCycle, measure, {}).front());
  }
  const std::vector<simulation::Candidate> rungs =
      simulation::ladder(candidates, cell_size, borrowed);
  std::size_t first = 0;
  for (std::size_t i = 0; i < rungs.size(); ++i) {
    if (rungs[i].quality.name == candidates[chosen].quality.name) first = i;
    bench::printLine("budget/" + name + "/cycle/" + rungs[i].quality.name, 1e3 * rungs[i].seconds,
                     "ms");
  }
  std::fprintf(stderr, "%s: reference\n", name.c_str());
  const studies::Reference reference =
      studies::computeReference({studies::Motion::kSwing, fabric}, {32, 16});
  print(name, BudgetRun(name, rungs, first).run(reference.trajectory));
}

}  // namespace

int main() {
  for (const char* fabric : {"linear", "wool"}) runBench(fabric);
}
