// What do time step and Newton iterations buy when a stiff fabric swings? The linearised step moves
// every particle along its tangent, so a piece that turns by an angle a per step is stretched by
// a^2 / 2; in wool, whose warp strains by 1e-5 under its weight, that is the largest error of all.
// Prints for the scene wool_sample, whose bar is moved by 80 mm to either side: the largest mean
// elongation along warp, and the computing time per simulated second. And of samples that are let
// go from 0.5 and 0.14 rad, in steps that end by their error: the energy left after a second,
// linear solves and computing time per step, the order of the positions.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/material/fabric_file.h"
#include "haptex/oracles/experiments/sample_swing.h"
#include "haptex/scene/scene.h"
#include "tab_lines.h"

namespace {

using namespace haptex;

struct Outcome {
  double elongation = 0.0;  // largest over time
  double load = 0.0;        // computing time over simulated time
};

class Swing {
 public:
  Swing(const scene::Scene& scene, double time_step)
      : cloth_(scene.mesh, material::loadFabric(scene.fabric_path), scene.effects),
        state_(cloth_.initialState()),
        integrator_(cloth_, scene.step),
        bar_(scene.attached_particles),
        time_step_(time_step) {
    moveBar(0.0, 0.0);
  }

  Outcome run() {
    advance(0.5);
    moveBar(0.08, 0.4);
    advance(0.5);
    moveBar(-0.16, 0.5);
    advance(0.6);
    moveBar(0.08, 0.4);
    advance(0.6);
    return {elongation_, computing_seconds_ / state_.time};
  }

 private:
  void moveBar(double displacement, double duration) {
    for (int particle : bar_) {
      cloth_.attach(particle,
                    {state_.positions[particle], {displacement, 0.0, 0.0}, state_.time, duration});
    }
  }

  void advance(double duration) {
    const double end = state_.time + duration - 0.5 * time_step_;
    while (state_.time < end) {
      computing_seconds_ += integrator_.step(cloth_, state_, time_step_).total_seconds;
      elongation_ = std::max(elongation_, meanElongation());
    }
  }

  /// Mean over the area of |V| - 1, the elongation along warp.
  double meanElongation() const {
    double sum = 0.0, area = 0.0;
    for (const cloth::MembraneElement& element : elements_) {
      const double strain = cloth::greenStrain(element, state_.positions)[1];
      sum += element.area * (std::sqrt(1.0 + 2.0 * strain) - 1.0);
      area += element.area;
    }
    return sum / area;
  }

  cloth::Cloth cloth_;
  std::vector<cloth::MembraneElement> elements_ = cloth::restElements(cloth_.mesh());
  cloth::ClothState state_;
  cloth::Integrator integrator_;
  std::vector<int> bar_;
  double time_step_;
  double elongation_ = 0.0;
  double computing_seconds_ = 0.0;
};

void printSwing(double milliseconds, int solves) {
  scene::Scene scene = scene::loadScene(HAPTEX_CONFIG_DIRECTORY "/scenes/wool_sample.yaml");
  scene.step.newton_iterations = solves;
  const Outcome outcome = Swing(scene, 1e-3 * milliseconds).run();
  std::string step = std::to_string(milliseconds);
  step.erase(step.find_last_not_of('0') + 1);
  if (step.back() == '.') step.pop_back();
  const std::string name = "swing/h" + step + "ms_" + std::to_string(solves) + "_solves";
  const std::string triangles = "/" + std::to_string(scene.mesh.triangles.size());
  bench::printLine(name + "_elongation" + triangles, 100.0 * outcome.elongation, "%");
  bench::printLine(name + "_load" + triangles, outcome.load, "s/s");
}

cloth::StepSettings settingsOf(cloth::IntegrationMethod method) {
  cloth::StepSettings settings;
  settings.method = method;
  settings.newton_iterations = 30;
  settings.newton_error = 1e-3;
  return settings;
}

void printSample(const material::Fabric& fabric, const char* angle) {
  constexpr int kCells = 32, kCoarse = 16;
  constexpr double kCycle = 0.0125;  // s
  constexpr int kCycles = 80;        // a second
  const oracles::SampleSwing sample(fabric, kCells, std::stod(angle));
  const oracles::SampleSwing coarse(fabric, kCoarse, std::stod(angle));
  for (const cloth::IntegrationMethod method :
       {cloth::IntegrationMethod::kBackwardEuler, cloth::IntegrationMethod::kBdf2,
        cloth::IntegrationMethod::kTrBdf2}) {
    const std::string name = "swing/" + fabric.name + "_" + angle + "rad_" + nameOf(method);
    const std::string triangles = "/" + std::to_string(sample.cloth().mesh().triangles.size());
    for (int parts : {1, 2, 4, 10}) {
      const oracles::SampleSwing::Motion motion =
          sample.swing(settingsOf(method), kCycles * kCycle, kCycles * parts);
      const std::string of = name + "_h" + std::to_string(12.5 / parts).substr(0, 5) + "ms";
      bench::printLine(of + "_kept" + triangles, 100.0 * motion.kept, "%");
      bench::printLine(of + "_solves" + triangles, motion.solves, "per step");
      bench::printLine(of + "_step" + triangles, 1e3 * motion.seconds, "ms");
    }
    bench::printLine(name + "_order/" + std::to_string(coarse.cloth().mesh().triangles.size()),
                     orderOfSwing(coarse, settingsOf(method), 0.25), "1");
  }
}

}  // namespace

int main() {
  for (int solves : {1, 2, 3, 20}) printSwing(12.5, solves);
  for (double milliseconds : {5.0, 2.5, 1.0}) printSwing(milliseconds, 1);
  printSwing(1.0, 5);
  for (const char* fabric : {"wool", "linear"}) {
    const material::Fabric of =
        material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/" + std::string(fabric) + ".yaml");
    for (const char* angle : {"0.5", "0.14"}) printSample(of, angle);
  }
}
