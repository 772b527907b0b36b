// How far from the truth is a sheet that falls in steps of a few solves, and at what price? The
// sheet of held_sheet.h falls and swings for half a second by backward Euler in steps of 12.5 ms.
// Some of its steps, of wool most, gain energy in a few elements, and are taken anew
// (docs/stability.md).
//
// Printed are, by fabric ("linear": 1000 N/m), linear solves asked for per step and triangles: the
// root mean square of the particles' distances from those of a reference, in the mean over the
// steps ("_error"), linear solves made per step ("_solves"), steps taken anew of all ("_anew") and
// the time of a step on two threads. The reference is TR-BDF2 in a quarter of the step and up to 40
// Newton iterations per stage, on the same mesh; "reference_error" is its distance from itself in
// twice as many steps.
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/material/fabric_file.h"
#include "held_sheet.h"
#include "tab_lines.h"

namespace {

using namespace haptex;

constexpr double kTimeStep = 0.0125;  // s
constexpr int kSteps = 40;
constexpr int kFinerReference = 4;  // steps of the reference per step
constexpr int kReferenceIterations = 40;
constexpr int kSolves[] = {1, 2, 5};
constexpr double kStiffness = 1000.0;  // N/m

using Motion = std::vector<cloth::Positions>;  // by step

struct Price {
  double seconds = 0.0;
  int solves = 0, anew = 0;
};

cloth::StepSettings settingsOf(int newton_iterations) {
  cloth::StepSettings settings;
  settings.tolerance = 1e-4;
  settings.newton_iterations = newton_iterations;
  settings.threads = 2;
  return settings;
}

Motion motionOf(const material::Fabric& fabric, int cells, const cloth::StepSettings& settings,
                int steps_per_step, Price& price) {
  bench::HeldSheet sheet(fabric, cells, settings);
  Motion motion;
  for (int step = 0; step < kSteps; ++step) {
    for (int part = 0; part < steps_per_step; ++part) {
      const cloth::StepReport report = sheet.step(kTimeStep / steps_per_step);
      price.seconds += report.total_seconds;
      price.solves += report.newton_iterations;
      price.anew += report.taken_anew;
    }
    motion.push_back(sheet.state().positions);
  }
  return motion;
}

Motion referenceOf(const material::Fabric& fabric, int cells, int steps_per_step) {
  cloth::StepSettings settings = settingsOf(kReferenceIterations);
  settings.method = cloth::IntegrationMethod::kTrBdf2;
  Price price;
  return motionOf(fabric, cells, settings, steps_per_step, price);
}

/// mm
double distanceOf(const Motion& motion, const Motion& reference) {
  double sum = 0.0;
  for (std::size_t step = 0; step < motion.size(); ++step) {
    double squares = 0.0;
    for (std::size_t i = 0; i < motion[step].size(); ++i) {
      squares += (motion[step][i] - reference[step][i]).squaredNorm();
    }
    sum += std::sqrt(squares / static_cast<double>(motion[step].size()));
  }
  return 1e3 * sum / static_cast<double>(motion.size());
}

void measure(const std::string& name, const material::Fabric& fabric,
             const std::vector<int>& meshes) {
  for (const int cells : meshes) {
    const std::string triangles = "/" + std::to_string(2 * cells * cells);
    const Motion reference = referenceOf(fabric, cells, kFinerReference);
    if (cells == meshes.front()) {
      const Motion finer = referenceOf(fabric, cells, 2 * kFinerReference);
      bench::printLine("falling/" + name + "_reference_error" + triangles,
                       distanceOf(reference, finer), "mm");
    }
    for (const int solves : kSolves) {
      Price price;
      const Motion motion = motionOf(fabric, cells, settingsOf(solves), 1, price);
      const std::string prefix = "falling/" + name + "_" + std::to_string(solves);
      bench::printLine(prefix + "_error" + triangles, distanceOf(motion, reference), "mm");
      bench::printLine(prefix + "_solves" + triangles, static_cast<double>(price.solves) / kSteps,
                       "per_step");
      bench::printLine(prefix + "_anew" + triangles, 100.0 * price.anew / kSteps, "%");
      bench::printLine(prefix + triangles, 1e3 * price.seconds / kSteps, "ms");
    }
  }
}

}  // namespace

int main() {
  try {
    const std::string fabrics = HAPTEX_CONFIG_DIRECTORY "/fabrics/";
    for (const char* name : {"wool", "worsted_gabardine", "cotton_knit"}) {
      measure(name, material::loadFabric(fabrics + name + ".yaml"), {24, 32, 40});
    }
    measure("linear",
            bench::withStiffness(material::loadFabric(fabrics + "linear.yaml"), kStiffness),
            {32, 75, 126});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_falling: %s\n", error.what());
    return 1;
  }
  return 0;
}
