// What does the error that a step may have cost, and what does it buy? A sample of wool of 16 x 16
// cells, turned by half a radian about its held edge, swings for half a second, as in the loop that
// ships: in steps of one length, and in such as miss at most an error. Prints how far the frames
// (12.5 ms) are from those of steps of 0.125 ms, the largest RMS over the particles, how many steps
// were taken and how many of them repeated, and the computing time per simulated second.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "haptex/base/constants.h"
#include "haptex/material/fabric_file.h"
#include "haptex/oracles/checks/cloth_oracles.h"
#include "haptex/simulation/simulated_cloth.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using cloth::IntegrationMethod;

constexpr double kFrame = 0.0125;  // s
constexpr int kFrames = 40;
constexpr int kReferenceSteps = 100;  // per frame

scene::Scene swing(IntegrationMethod method) {
  constexpr double kAngle = 0.5;
  scene::Scene scene;
  scene.mesh = mesh::makeRectangle(0.2, 0.2, 16, 16, mesh::Triangulation::kAlternating);
  scene.attached_particles = mesh::sideParticles(scene.mesh, mesh::Side::kTop);
  for (Eigen::Vector3d& place : scene.mesh.initial_positions) {
    place = {-place.z() * std::sin(kAngle), place.y(), place.z() * std::cos(kAngle)};
  }
  scene.effects.gravity = {0.0, 0.0, -base::kStandardGravity};
  scene.effects.bending = true;
  scene.effects.viscosity = true;
  scene.time_step = kFrame;
  scene.step.method = method;
  scene.step.newton_iterations = 10;
  scene.step.newton_error = 1e-3;
  return scene;
}

struct Motion {
  std::vector<std::vector<Eigen::Vector3d>> frames;
  int steps = 0, repeated = 0;
  double seconds = 0.0;  // of computing
};

Motion run(const material::Fabric& fabric, const scene::Scene& scene) {
  simulation::SimulatedCloth simulation(scene, fabric);
  const auto per_frame = std::lround(kFrame / scene.time_step);
  Motion motion;
  for (int frame = 0; frame < kFrames; ++frame) {
    for (long i = 0; i < per_frame; ++i) {
      if (!simulation.step()) return {};
      motion.seconds += simulation.lastReport().total_seconds;
      const simulation::AdaptiveReport& report = simulation.lastAdaptiveReport();
      motion.steps += scene.adaptive_steps ? report.substeps : 1;
      motion.repeated += report.repeated;
    }
    motion.frames.push_back(simulation.state().positions);
  }
  return motion;
}

double largestDeviation(const Motion& motion, const Motion& reference) {
  double largest = motion.frames.empty() ? NAN : 0.0;
  for (std::size_t k = 0; k < motion.frames.size(); ++k) {
    double squared = 0.0;
    for (std::size_t i = 0; i < motion.frames[k].size(); ++i) {
      squared += (motion.frames[k][i] - reference.frames[k][i]).squaredNorm();
    }
    largest = std::max(largest, std::sqrt(squared / motion.frames[k].size()));
  }
  return largest;
}

void print(const std::string& name, const Motion& motion, const Motion& reference) {
  bench::printLine("adaptive/" + name + "/deviation", 1e3 * largestDeviation(motion, reference),
                   "mm");
  bench::printLine("adaptive/" + name + "/steps", motion.steps, "1");
  bench::printLine("adaptive/" + name + "/repeated", motion.repeated, "1");
  bench::printLine("adaptive/" + name + "/load", motion.seconds / (kFrames * kFrame), "s/s");
}

}  // namespace

int main() {
  const material::Fabric wool = material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml");
  scene::Scene fine = swing(IntegrationMethod::kTrBdf2);
  fine.time_step = kFrame / kReferenceSteps;
  const Motion reference = run(wool, fine);
  for (const IntegrationMethod method :
       {IntegrationMethod::kBackwardEuler, IntegrationMethod::kBdf2, IntegrationMethod::kTrBdf2}) {
    scene::Scene scene = swing(method);
    for (const int parts : {1, 2, 4, 8}) {
      scene.time_step = kFrame / parts;
      print(std::string(nameOf(method)) + "/h" + oracles::numbered(1e3 * scene.time_step) + "ms",
            run(wool, scene), reference);
    }
    scene.time_step = kFrame;
    for (const double error : {1e-4, 3e-5, 1e-5}) {
      scene.adaptive_steps = cloth::AdaptiveSteps{1e-4, kFrame, error};
      print(std::string(nameOf(method)) + "/error" + oracles::numbered(1e3 * error) + "mm",
            run(wool, scene), reference);
    }
  }
}
