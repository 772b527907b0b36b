// How much stiffer do coarse meshes make cloth whose threads hardly stretch, with triangles and
// with cells? Prints the torque (mN.m) of a strip of wool, 50 x 200 mm, whose ends are held at the
// distance of its length and turned against each other by 90 degrees; by how much less than the
// elastica a cantilever drops whose threads lie at 30 degrees to it, mean and largest of five
// irregular meshes; how far places of wool that hangs obliquely to its threads, and its energies,
// are apart when its cells are cut in three ways; and the processor time of a step of 12.5 ms of a
// hanging sheet that bends, relative to triangles.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "haptex/base/constants.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/material/fabric_file.h"
#include "haptex/oracles/exact/elastica.h"
#include "haptex/oracles/experiments/hung_square.h"
#include "haptex/oracles/experiments/strip_statics.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using cloth::Elasticity;
using Eigen::Vector3d;

constexpr std::array<std::pair<Elasticity, const char*>, 2> kElements = {
    {{Elasticity::kGreenLagrange, "green_lagrange"}, {Elasticity::kBilinear, "bilinear"}}};

void printTwist(const material::Fabric& wool) {
  for (const auto& [elasticity, name] : kElements) {
    for (const auto& [triangulation, cut] :
         {std::pair(mesh::Triangulation::kOneWay, "one_way"),
          std::pair(mesh::Triangulation::kAlternating, "alternating")}) {
      for (int cells : {16, 32, 64}) {
        bench::printLine(
            std::string("locking/twist/") + name + "/" + cut + "/" + std::to_string(cells),
            1e3 * oracles::simulatedTwistTorque(wool, elasticity, triangulation, cells, 0.5 * M_PI),
            "mN.m");
      }
    }
  }
}

void printOblique() {
  constexpr double kGamma = 10.0;
  const double exact = oracles::exactDropOverReach(kGamma);
  struct Threads {
    const char* name;
    double modulus, warp_over_weft;
  };
  // As those of 16 kN/m and 300 N/m to a rigidity of 6.6e-6 N.m and a length of 0.2 m; and as
  // those of wool, 366 and 16448 N/m.
  for (const auto& [threads, modulus, warp_over_weft] :
       {Threads{"stiff", 9.7e4, 1.0}, Threads{"soft", 1.8e3, 1.0}, Threads{"wool", 2.2e3, 45.0}}) {
    for (const auto& [elasticity, name] : kElements) {
      for (int cells : {16, 32}) {
        double sum = 0.0, largest = 0.0;
        for (unsigned seed = 1; seed <= 5; ++seed) {
          oracles::Cantilever cantilever{kGamma, oracles::StripMesh::kIrregular};
          cantilever.cells = cells;
          cantilever.across = 1.0;
          cantilever.grain = M_PI / 6.0;
          cantilever.seed = seed;
          cantilever.elasticity = elasticity;
          cantilever.modulus = modulus;
          cantilever.warp_over_weft = warp_over_weft;
          const double less = 1.0 - oracles::simulatedDropOverReach(cantilever) / exact;
          sum += less;
          largest = std::max(largest, std::abs(less));
        }
        const std::string of =
            std::string("/") + threads + "/" + name + "/" + std::to_string(cells);
        bench::printLine("locking/oblique_mean" + of, 100.0 * sum / 5.0, "%");
        bench::printLine("locking/oblique_largest" + of, 100.0 * largest, "%");
      }
    }
  }
}

void printCuts(const material::Fabric& wool) {
  for (const auto& [elasticity, name] : kElements) {
    const oracles::CutDifference difference = oracles::differenceOfCuts(wool, elasticity, 32);
    bench::printLine(std::string("locking/cuts_apart/") + name, 1e3 * difference.apart, "mm");
    bench::printLine(std::string("locking/cuts_energy/") + name, 100.0 * difference.energy, "%");
  }
}

/// s of processor time, which others on the machine disturb less; mean of the steps of a second.
double secondsOfStep(const material::Fabric& fabric, Elasticity elasticity, int cells) {
  cloth::ModelledEffects effects;
  effects.elasticity = elasticity;
  effects.bending = effects.viscosity = true;
  effects.gravity = {0.0, 0.0, -base::kStandardGravity};
  cloth::Cloth cloth(mesh::makeRectangle(0.2, 0.2, cells, cells, mesh::Triangulation::kAlternating),
                     fabric, effects);
  cloth::ClothState state = cloth.initialState();
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {  // leans by 0.3 rad
    state.positions[i].x() = std::sin(0.3) * state.positions[i].z();
    state.positions[i].z() *= std::cos(0.3);
  }
  for (int particle : sideParticles(cloth.mesh(), mesh::Side::kTop)) {
    cloth::AttachmentPath path;
    path.start = state.positions[particle];
    cloth.attach(particle, path);
  }
  cloth::StepSettings settings;
  settings.newton_iterations = 2;
  cloth::Integrator integrator(cloth, settings);
  constexpr int kSteps = 80;
  const double begin = bench::processorSeconds();
  for (int i = 0; i < kSteps; ++i) integrator.step(cloth, state, 0.0125);
  return (bench::processorSeconds() - begin) / kSteps;
}

/// Of three runs of each, in turn, the shortest.
void printCost(const material::Fabric& wool) {
  for (int cells : {32, 64}) {
    std::array<double, 2> shortest = {HUGE_VAL, HUGE_VAL};
    for (int run = 0; run < 3; ++run) {
      for (std::size_t e = 0; e < kElements.size(); ++e) {
        shortest[e] = std::min(shortest[e], secondsOfStep(wool, kElements[e].first, cells));
      }
    }
    const std::string of = "/" + std::to_string(2 * cells * cells);
    bench::printLine("locking/step/green_lagrange" + of, 1e3 * shortest[0], "ms");
    bench::printLine("locking/step/bilinear" + of, 1e3 * shortest[1], "ms");
    bench::printLine("locking/step_ratio" + of, shortest[1] / shortest[0], "1");
  }
}

}  // namespace

int main() {
  const material::Fabric wool = material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml");
  printCost(wool);
  printOblique();
  printCuts(wool);
  printTwist(wool);
}
