// device_records CONFIG_DIRECTORY OUT_DIRECTORY SEED QUALITY FABRIC...: what a device measures
// while a hand judges fabrics (studies/evaluation/manipulations.h); the hand trembles by the seed,
// the large-scale cloth is computed by the preset QUALITY for the fabric, or "finest", as in the
// oracles of contact. For scripts/evaluate. OUT_DIRECTORY/FABRIC_MANIPULATION_SEED.f32: per
// millisecond 13 floats: time (s), positions of index and thumb (m), forces on them (N). On
// standard output, separated by tabs: "fingertips", their radii (m) and the stiffness of their
// pulps (Pa/m); "strip", what is cut, its length and width (m); "pinch", the time of each (s);
// "stroke", a fabric with a surface and the intensity (m) that the contactors give it at 20 mm/s
// under 0.5 N; "done", a fabric.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/material/fabric_file.h"
#include "haptex/oracles/experiments/contact_scenes.h"
#include "haptex/oracles/experiments/standard_stroke.h"
#include "haptex/scene/quality_file.h"
#include "haptex/simulation/studied_fabrics.h"
#include "haptex/studies/evaluation/manipulations.h"

namespace {

using namespace haptex;

void write(const std::string& path, const studies::DeviceRecord& record) {
  std::ofstream file(path, std::ios::binary);
  for (const studies::DeviceSample& sample : record) {
    const auto put = [&](double number) {
      const float value = static_cast<float>(number);
      file.write(reinterpret_cast<const char*>(&value), sizeof value);
    };
    put(sample.time);
    for (const base::Finger finger : base::kFingers) {
      for (const double component : sample.positions[finger]) put(component);
    }
    for (const base::Finger finger : base::kFingers) {
      for (const double component : sample.forces[finger]) put(component);
    }
  }
  if (!file.flush()) throw std::runtime_error(path + ": cannot be written");
}

void say(const char* name, const studies::Strip& strip) {
  std::printf("strip\t%s\t%.9g\t%.9g\n", name, strip.length, strip.width);
}

studies::ManipulationSettings settingsOf(const std::string& config, const std::string& quality,
                                         const material::Fabric& fabric) {
  studies::ManipulationSettings settings;
  if (quality == "finest") return settings;
  const auto qualities = scene::loadQualities(config + "/presets/" + quality + ".yaml");
  std::vector<simulation::StudiedFabric> studied;
  for (const std::string& name : simulation::studiedFabricNames(qualities)) {
    studied.push_back({name, simulation::tensileModulus(
                                 material::loadFabric(config + "/fabrics/" + name + ".yaml"))});
  }
  const scene::Quality chosen = simulation::qualitiesFor(fabric, qualities, studied).at(0);
  settings.cells = static_cast<int>(std::ceil(oracles::kSampleSide / chosen.cell_size - 1e-9));
  settings.large_scale_step = chosen.time_step;
  settings.step = chosen.step;
  return settings;
}

void run(int argc, char** argv) {
  if (argc < 6) {
    throw std::invalid_argument(
        "usage: device_records CONFIG OUT_DIRECTORY SEED QUALITY FABRIC...");
  }
  const std::string config = argv[1], quality = argv[4];
  const studies::FingertipPair pair = studies::fingertipPair();
  std::printf("fingertips\t%.9g\t%.9g\t%.9g\n", pair.radii[base::Finger::kIndex],
              pair.radii[base::Finger::kThumb], pair.pulp_stiffness);
  std::printf("pinch\t%.9g\n", studies::kPinchSeconds);
  say("pressed", studies::kPressed);
  say("biased", studies::kBiased);
  say("overhang", studies::kOverhang);
  for (const oracles::RenderedFabric& fabric : oracles::renderFabrics(argv[1])) {
    std::printf("stroke\t%s\t%.9g\n", fabric.name.c_str(), fabric.stroke.perceived_intensity);
  }
  for (int i = 5; i < argc; ++i) {
    const std::string name = argv[i];
    const material::Fabric fabric = material::loadFabric(config + "/fabrics/" + name + ".yaml");
    studies::ManipulationSettings settings = settingsOf(config, quality, fabric);
    settings.tremor = std::strtoull(argv[3], nullptr, 10);
    for (const studies::Manipulation& manipulation : studies::manipulations()) {
      write(std::string(argv[2]) + "/" + name + "_" + manipulation.name + "_" + argv[3] + ".f32",
            manipulation.run(fabric, settings));
    }
    std::printf("done\t%s\n", name.c_str());
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "device_records: %s\n", error.what());
    return 1;
  }
  return 0;
}
