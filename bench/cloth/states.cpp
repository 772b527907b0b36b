// Has a change altered what is simulated? Where every shipped scene is after 400 steps, by every
// integrator, and with every kind of elasticity and bending that the scene can have instead of its
// own: two trees that print the same computed the same, to the last bit. Per case:
//   states/<scene>/<integrator or model>    sum over all particles of |coordinate|, in m, and
//                                           behind the unit a checksum of all bits of the state
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/material/fabric_file.h"
#include "haptex/scene/scene.h"
#include "haptex/scene/scene_fabric.h"
#include "haptex/simulation/simulated_cloth.h"

namespace {

using namespace haptex;
namespace fs = std::filesystem;

constexpr int kSteps = 400;

/// Fowler, Noll and Vo's checksum (FNV-1a) of 64 bits.
class Checksum {
 public:
  void add(double number) {
    unsigned char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    for (const unsigned char byte : bytes) sum_ = (sum_ ^ byte) * 1099511628211U;
  }
  std::uint64_t sum() const { return sum_; }

 private:
  std::uint64_t sum_ = 14695981039346656037U;
};

void printState(const std::string& name, const scene::Scene& scene,
                const std::vector<material::Fabric>& fabrics) {
  double extent = 0.0;
  Checksum checksum;
  try {
    simulation::SimulatedCloth sheet(scene, fabrics);
    for (int i = 0; i < kSteps; ++i) sheet.step();
    for (const auto* points : {&sheet.state().positions, &sheet.state().velocities}) {
      for (const Eigen::Vector3d& point : *points) {
        for (const double number : point) checksum.add(number);
        if (points == &sheet.state().positions) extent += point.cwiseAbs().sum();
      }
    }
  } catch (const std::invalid_argument&) {
    return;  // the scene cannot have it
  }
  std::printf("%s\t%.17g\tm\t%016llx\n", name.c_str(), extent,
              static_cast<unsigned long long>(checksum.sum()));
  std::fflush(stdout);
}

void printStates(const fs::path& file) {
  const std::string name = "states/" + file.stem().string() + "/";
  const scene::Scene shipped = scene::loadScene(file.string());
  const std::vector<material::Fabric> fabrics = scene::loadSceneFabrics(file.string(), shipped);
  for (const cloth::NamedIntegrationMethod& named : cloth::kIntegrationMethods) {
    scene::Scene scene = shipped;
    scene.step.method = named.method;
    printState(name + named.name, scene, fabrics);
  }
  scene::Scene springs = shipped, corotational = shipped, bends = shipped, remembers = shipped;
  scene::Scene stretches = shipped;
  springs.effects.elasticity = cloth::Elasticity::kMassSpring;
  corotational.effects.elasticity = cloth::Elasticity::kCorotational;
  bends.effects.bending = true;
  remembers.effects.bending = remembers.effects.bending_hysteresis = true;
  stretches.effects.membrane_hysteresis = true;
  printState(name + "mass_spring", springs, fabrics);
  printState(name + "corotational", corotational, fabrics);
  printState(name + "bending", bends, fabrics);
  printState(name + "bending_hysteresis", remembers, fabrics);
  printState(name + "membrane_hysteresis", stretches, fabrics);
}

}  // namespace

int main() {
  try {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(HAPTEX_CONFIG_DIRECTORY "/scenes")) {
      files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) printStates(file);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
