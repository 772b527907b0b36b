// How long does a cushion take to swell, to drop onto a table and to come to rest?
#pragma once

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "haptex/cloth/forces/stuffing/stuffing.h"
#include "haptex/proximity/intersections.h"
#include "haptex/scene/scene.h"
#include "haptex/scene/scene_fabric.h"
#include "haptex/simulation/simulated_cloth.h"
#include "tab_lines.h"

namespace haptex::bench {

/// Prints garment/cushion/s_per_s, to_rest (simulated until its fastest particle has been slower
/// than 5 mm/s for 0.5 s; inf: not within 10 s), intersections, the pairs of triangles of all
/// states, and pressure at the end.
inline void measureCushion() {
  constexpr double kMostTime = 10.0, kSlow = 5e-3, kRestTime = 0.5;  // s, m/s, s
  const std::string path = HAPTEX_CONFIG_DIRECTORY "/scenes/cushion.yaml";
  const scene::Scene scene = scene::loadScene(path);
  simulation::SimulatedCloth cloth(scene, scene::loadSceneFabrics(path, scene));
  double seconds = 0.0, time = 0.0, fast_at = 0.0;
  std::size_t intersections = 0;
  while (time < kMostTime && time - fast_at < kRestTime) {
    time += scene.time_step;
    const double begin = processorSeconds();
    if (!cloth.step()) throw std::runtime_error("a step of the cushion was rejected");
    seconds += processorSeconds() - begin;
    double fastest = 0.0;
    for (const auto& velocity : cloth.state().velocities) {
      fastest = std::max(fastest, velocity.norm());
    }
    if (fastest > kSlow) fast_at = time;
    intersections +=
        proximity::intersectingTriangles(cloth.state().positions, cloth.cloth().mesh().triangles)
            .size();
  }
  const bool at_rest = time - fast_at >= kRestTime;
  const double volume =
      cloth::enclosedVolume(cloth.cloth().mesh().triangles, cloth.state().positions);
  printLine("garment/cushion/s_per_s", seconds / time, "s/s");
  printLine("garment/cushion/to_rest", at_rest ? fast_at : std::numeric_limits<double>::infinity(),
            "s");
  printLine("garment/cushion/intersections", static_cast<double>(intersections), "1");
  printLine("garment/cushion/pressure", cloth::pressureOf(*scene.effects.stuffing, volume).pressure,
            "Pa");
}

}  // namespace haptex::bench
