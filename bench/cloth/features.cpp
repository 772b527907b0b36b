// What does each thing that a scene may list cost, and does what is not listed cost nothing? A
// sheet of 2048 triangles that is shaken, with nothing listed, is the base; then one thing after
// the other is listed alone. Per feature:
//   <name>/ratio           computing time of a step over the base's of the same minute
//   <name>/noise           by how much three of four turns of the base take longer than the
//   shortest <name>/step            computing time of a step <name>/memory          that cloth,
//   state and integrator hold more than the base <name>/unlisted_ratio, unlisted_memory
//                          the same with all that fabric and scene can say about the feature, but
//                          not listed: 1 and 0
// Then what is beside the steps of the cloth: sleep, patches, tactile arrays, messages.
#include <cstdio>
#include <string>
#include <vector>

#include "haptex/material/fabric_file.h"
#include "haptex/nodes/cloth_simulation/cloth_markers.h"
#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/simulation/simulated_cloth.h"
#include "haptex/simulation/touch_cost.h"
#include "haptex/studies/feature_scenes.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using simulation::StepCost;
using simulation::SteppedScene;
using studies::Feature;
using studies::FeatureScene;

constexpr int kCells = 32;
constexpr int kRounds = 9;
constexpr int kSteps = 32;  // the way to one side
constexpr int kRepetitions = 500;

void print(const std::string& name, double value, const char* unit) {
  bench::printLine("features/" + name, value, unit);
}

template <typename Make>
double heldBytes(const Make& make) {
  const std::size_t before = simulation::allocatedBytes();
  const auto made = make();
  return static_cast<double>(simulation::allocatedBytes() - before);
}

/// Of the scene without what its fabric says.
double memoryOf(const FeatureScene& scene) {
  return heldBytes([&] { return scene.stepped(); }) - heldBytes([&] { return scene.fabric; });
}

StepCost costOf(const FeatureScene& scene, const FeatureScene& base) {
  SteppedScene stepped = scene.stepped(), base_stepped = base.stepped();
  return simulation::compareSteps(stepped, base_stepped, kRounds, kSteps);
}

void printFeature(const Feature& feature, const FeatureScene& bare, double bare_memory) {
  FeatureScene described = bare;
  feature.describe(described);
  FeatureScene listed = described;
  feature.list(listed);
  const StepCost cost = costOf(listed, bare);
  const StepCost unlisted = costOf(described, bare);
  print(feature.name + "/ratio", cost.ratio, "1");
  print(feature.name + "/noise", cost.noise, "1");
  print(feature.name + "/step", 1e3 * cost.seconds, "ms");
  print(feature.name + "/memory", 1e-3 * (memoryOf(listed) - bare_memory), "kB");
  print(feature.name + "/unlisted_ratio", unlisted.ratio, "1");
  print(feature.name + "/unlisted_memory", 1e-3 * (memoryOf(described) - bare_memory), "kB");
}

template <typename Work>
double microseconds(const Work& work) {
  work();
  const double begin = simulation::threadSeconds();
  for (int i = 0; i < kRepetitions; ++i) work();
  return 1e6 * (simulation::threadSeconds() - begin) / kRepetitions;
}

void printIntegrators(const FeatureScene& bare) {
  for (const cloth::NamedIntegrationMethod& named : cloth::kIntegrationMethods) {
    if (!cloth::isImplicit(named.method)) continue;
    FeatureScene scene = bare;
    scene.scene.step.method = named.method;
    const StepCost cost = costOf(scene, bare);
    print(std::string("integrator_") + named.name + "/ratio", cost.ratio, "1");
    print(std::string("integrator_") + named.name + "/noise", cost.noise, "1");
  }
}

/// The shipped sample, which is touched.
void printBesideTheSteps() {
  const std::string path = HAPTEX_CONFIG_DIRECTORY "/scenes/wool_sample.yaml";
  const scene::Scene scene = scene::loadScene(path);
  const material::Fabric wool = material::loadFabric(scene.fabric_path);
  simulation::SimulatedCloth simulation(scene, wool);
  while (!simulation.asleep()) simulation.step();
  print("sleep/simulated_time_until", simulation.state().time, "s");
  print("sleep/step", microseconds([&] { simulation.step(); }), "us");

  const simulation::TouchCost touch = simulation::measureTouch(
      scene.mesh, {wool}, scene.effects, contact::loadHapticSettings(path), kRepetitions);
  print("patch/far_particles", static_cast<double>(touch.far_particles), "1");
  print("patch/far_millisecond", 1e6 * touch.far_seconds, "us");
  print("patch/near_particles", static_cast<double>(touch.near_particles), "1");
  print("patch/near_millisecond", 1e6 * touch.near_seconds, "us");
  print("tactile/25_milliseconds", 1e6 * simulation::measureTactile(wool, kRepetitions), "us");

  const ros::Time stamp(1.0);
  std::vector<Eigen::Vector3d> forces;
  haptex::ClothState message;
  const auto fill = [&] {
    simulation.cloth().computeForces(simulation.state(), forces);
    nodes::fillStateMessage(simulation, stamp, forces, message);
  };
  print("cloth_state/message", microseconds(fill), "us");
  const auto restamp = [&] { nodes::restampStateMessage(simulation, stamp, message); };
  print("cloth_state/message_asleep", microseconds(restamp), "us");
  nodes::ClothMarkers markers(scene.mesh, 0.01);
  print("cloth_markers/message", microseconds([&] { markers.update(simulation, stamp); }), "us");
}

}  // namespace

int main() {
  const FeatureScene bare = studies::bareScene(
      material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml"), kCells);
  memoryOf(bare);  // the heap gets used to it
  const double bare_memory = memoryOf(bare);
  const StepCost base = costOf(bare, bare);
  print("bare/step", 1e3 * base.seconds, "ms");
  print("bare/ratio", base.ratio, "1");
  print("bare/noise", base.noise, "1");
  print("bare/memory", 1e-3 * bare_memory, "kB");
  for (const Feature& feature : studies::features()) {
    std::fprintf(stderr, "features: %s\n", feature.name.c_str());
    printFeature(feature, bare, bare_memory);
  }
  std::fprintf(stderr, "features: integrators\n");
  printIntegrators(bare);
  std::fprintf(stderr, "features: beside the steps\n");
  printBesideTheSteps();
  return 0;
}
