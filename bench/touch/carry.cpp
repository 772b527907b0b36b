// What the cloth that is carried makes the hand feel: both fingers pinch the lower edge of the
// hanging wool sample through the two layers, and through the whole cloth in one layer with the
// resolution of the patch, stepped with the patch's millisecond. Then they carry it sideways and up
// by 54 mm in half a second, and back, and shake it twice a second by 10 mm to either side. Per
// motion:
//   force              largest of both fingers' forces together, in one layer
//   <rate>/force       the same in two layers with so many large-scale states a second
//   <rate>/error       largest difference from one layer, in any millisecond
// Patches are refined once, not twice as shipped, because the whole cloth is as fine: then
// all takes half a minute. In one layer what is lifted and lowered makes the same forces to 5 %.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "haptex/material/fabric_file.h"
#include "haptex/oracles/experiments/contact_scenes.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using contact::Fingertips;
using Eigen::Vector3d;

constexpr double kStep = 1e-3;  // s

struct Motion {
  const char* name;
  std::vector<Vector3d> forces;  // on both fingertips together, N, of every millisecond
};

/// @param step takes fingertips and returns the force on both of them (N)
template <typename Step>
std::vector<Motion> carry(const Step& step) {
  oracles::Hand hand;
  hand.middle.z() = -0.19;
  hand.gap = 4e-3;
  std::vector<Motion> motions;
  const auto record = [&](const Fingertips& fingertips) {
    const Vector3d force = step(fingertips);
    if (!motions.empty()) motions.back().forces.push_back(force);
  };
  const auto begin = [&](const char* name) { motions.push_back({name, {}}); };
  const Vector3d still = Vector3d::Zero(), way(0.05, 0.0, 0.02);
  oracles::move(hand, still, -8e-3, 0.2, kStep, record);
  oracles::move(hand, still, 0.0, 0.8, kStep, record);
  begin("held");
  oracles::move(hand, still, 0.0, 0.2, kStep, record);
  begin("lifted");
  oracles::move(hand, way, 0.0, 0.5, kStep, record);
  begin("swinging");
  oracles::move(hand, still, 0.0, 0.5, kStep, record);
  begin("lowered");
  oracles::move(hand, -way, 0.0, 0.5, kStep, record);
  oracles::move(hand, {0.0, 0.0, 0.01}, 0.0, 0.3, kStep, record);
  begin("shaken");
  for (int i = 1; i <= 1000; ++i) {
    const double phase = 4.0 * M_PI * i * kStep;
    const Vector3d before = hand.middle;
    hand.middle.x() = 0.01 * std::sin(phase);
    hand.velocity = (hand.middle - before) / kStep;
    record(hand.fingertips());
  }
  return motions;
}

double largest(const std::vector<Vector3d>& forces) {
  double most = 0.0;
  for (const Vector3d& force : forces) most = std::max(most, force.norm());
  return most;
}

}  // namespace

int main() {
  const material::Fabric fabric =
      material::loadFabric(std::string(HAPTEX_CONFIG_DIRECTORY) + "/fabrics/wool.yaml");
  const auto sample = [&](double rate) {
    oracles::HapticLoopSettings settings =
        oracles::hangingSample(fabric, kes::Direction::kWarp, rate);
    settings.haptics.refinement = 1;
    return settings;
  };
  oracles::RefinedCloth cloth(sample(80.0));
  const std::vector<Motion> exact = carry([&](const Fingertips& fingertips) {
    cloth.step(fingertips, kStep);
    return Vector3d(cloth.force(base::Finger::kIndex) + cloth.force(base::Finger::kThumb));
  });
  for (const Motion& motion : exact) {
    bench::printLine(std::string("carry/") + motion.name + "/force", largest(motion.forces), "N");
  }
  for (const double rate : {80.0, 40.0, 25.0}) {
    oracles::HapticLoop loop(sample(rate));
    const std::vector<Motion> felt = carry([&](const Fingertips& fingertips) {
      loop.step(fingertips);
      return oracles::forceOnFingertips(loop.layer());
    });
    for (std::size_t i = 0; i < exact.size(); ++i) {
      double error = 0.0;
      for (std::size_t k = 0; k < exact[i].forces.size(); ++k) {
        error = std::max(error, (felt[i].forces[k] - exact[i].forces[k]).norm());
      }
      const std::string prefix =
          std::string("carry/") + exact[i].name + "/" + std::to_string(std::lround(rate)) + "Hz/";
      bench::printLine(prefix + "force", largest(felt[i].forces), "N");
      bench::printLine(prefix + "error", error, "N");
    }
  }
  return 0;
}
