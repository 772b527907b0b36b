#include "haptex/simulation/quality_calibration.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "haptex/scene/scene.h"

namespace haptex::simulation {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kUnmeasuredCycles = 4;  // in which solvers find their way
constexpr std::size_t kMaxCycles = 16;
constexpr std::size_t kMinCycles = 3;
constexpr double kEnough = 0.15;  // s of measured cycles
// The motion, m and s: about that of a person who shakes the cloth.
const Eigen::Vector3d kDisplacement(0.05, 0.0, 0.0);
constexpr double kDuration = 0.25;

double since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

std::vector<std::uint32_t> attachedParticles(const scene::Scene& scene) {
  return {scene.attached_particles.begin(), scene.attached_particles.end()};
}

double medianCycle(SimulatedCloth& simulation) {
  std::vector<double> cycles;
  double measured = 0.0;
  while (cycles.size() < kMaxCycles && (cycles.size() < kMinCycles || measured < kEnough)) {
    const Clock::time_point begin = Clock::now();
    if (!simulation.step()) return std::numeric_limits<double>::infinity();
    cycles.push_back(since(begin));
    measured += cycles.back();
  }
  const auto middle = cycles.begin() + static_cast<std::ptrdiff_t>(cycles.size() / 2);
  std::nth_element(cycles.begin(), middle, cycles.end());
  return *middle;
}

}  // namespace

MeasuredCycle measureCycle(const std::string& scene_path,
                           const std::vector<material::Fabric>& fabrics,
                           const scene::Quality& quality, int substeps) {
  const Clock::time_point begin = Clock::now();
  scene::Scene scene = scene::loadScene(scene_path, quality.cell_size);
  const std::vector<std::uint32_t> attached = attachedParticles(scene);
  Candidate candidate;
  candidate.quality = quality;
  candidate.substeps = substeps;
  const StepPlan plan = planOf(candidate, scene.step.threads);
  SimulatedCloth simulation(std::move(scene), fabrics, {plan});
  if (!attached.empty()) simulation.move(attached, kDisplacement, kDuration);
  MeasuredCycle result;
  for (int i = 0; i < kUnmeasuredCycles && simulation.step(); ++i) continue;
  result.seconds = medianCycle(simulation);
  result.spent = since(begin);
  return result;
}

}  // namespace haptex::simulation
