// What the cloth that is carried makes the hand feel: both fingers pinch the lower edge of the
// hanging wool sample through the two layers, and through the whole cloth in one layer with the
// resolution of the patch, stepped with the patch's millisecond. Then they carry it sideways and up
// by 54 mm in half a second, and back, and shake it twice a second by 10 mm to either side. At last
// they let it go, pinch it with 0.3 N, which is too little to hold it, and slide along weft by 25
// mm in two seconds, as scripts/demo does. Per motion:
//   force              largest of both fingers' forces together, in one layer
//   weft, warp         how far the fingers have come along the fabric, likewise
//   <rate>/force, ...  the same in two layers with so many large-scale states a second
//   <rate>/error       largest difference of the force from one layer, in any millisecond
// Patches are refined once, not twice as shipped, because the whole cloth is as fine: then
// all takes a minute or two. In one layer what is lifted and lowered makes the same forces to 5 %.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "haptex/exoskeleton/control/minimum_jerk.h"
#include "haptex/material/fabric_file.h"
#include "haptex/oracles/experiments/contact_scenes.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using contact::Fingertips;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kStep = 1e-3;    // s
constexpr double kPinched = 0.3;  // N, that does not hold the edge

/// After a millisecond.
struct Felt {
  Vector3d force = Vector3d::Zero();  // N, on both fingertips together
  Vector2d place = Vector2d::Zero();  // m, of the index finger on the fabric (weft, warp)
  double normal_force = 0.0;          // N, on the index finger
};

struct Motion {
  const char* name;
  std::vector<Felt> felt;  // of every millisecond
};

oracles::Hand handAtTheEdge() {
  oracles::Hand hand;
  hand.middle.z() = -0.19;
  hand.gap = 4e-3;
  return hand;
}

/// @param step takes fingertips and returns what they feel
template <typename Step>
std::vector<Motion> carry(const Step& step) {
  oracles::Hand hand = handAtTheEdge();
  std::vector<Motion> motions;
  const auto record = [&](const Fingertips& fingertips) {
    const Felt felt = step(fingertips);
    if (!motions.empty()) motions.back().felt.push_back(felt);
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

/// @param gap  m, between the fingertips; none: closes until they pinch with kPinched
/// @param step as above
template <typename Step>
Motion slide(std::optional<double>& gap, const Step& step) {
  oracles::Hand hand = handAtTheEdge();
  Motion motion{"slide", {}};
  const Vector3d still = Vector3d::Zero(), begin = hand.middle;
  bool pinched = false;
  const auto close = [&](const Fingertips& fingertips) {
    pinched = step(fingertips).normal_force >= kPinched;
  };
  while (gap ? hand.gap > *gap : !pinched) oracles::move(hand, still, -2e-5, kStep, kStep, close);
  gap = hand.gap;
  oracles::move(hand, still, 0.0, 0.5, kStep, close);
  for (int i = 1; i <= 2000; ++i) {
    const Vector3d before = hand.middle;
    hand.middle.y() = begin.y() + 0.025 * exoskeleton::minimumJerk(i / 2000.0);
    hand.velocity = (hand.middle - before) / kStep;
    motion.felt.push_back(step(hand.fingertips()));
  }
  return motion;
}

std::string nameOf(const Motion& motion, const char* quantity, double rate = 0.0) {
  const std::string of_rate = rate > 0.0 ? std::to_string(std::lround(rate)) + "Hz/" : "";
  return std::string("carry/") + motion.name + "/" + of_rate + quantity;
}

void printLargest(const Motion& motion, double rate = 0.0) {
  double most = 0.0;
  for (const Felt& felt : motion.felt) most = std::max(most, felt.force.norm());
  bench::printLine(nameOf(motion, "force", rate), most, "N");
}

void printWay(const Motion& motion, double rate = 0.0) {
  const Vector2d way = motion.felt.back().place - motion.felt.front().place;
  bench::printLine(nameOf(motion, "weft", rate), 1e3 * way.x(), "mm");
  bench::printLine(nameOf(motion, "warp", rate), 1e3 * way.y(), "mm");
}

void printError(const Motion& motion, const Motion& exact, double rate) {
  double error = 0.0;
  for (std::size_t k = 0; k < exact.felt.size(); ++k) {
    error = std::max(error, (motion.felt[k].force - exact.felt[k].force).norm());
  }
  bench::printLine(nameOf(motion, "error", rate), error, "N");
}

Felt feltIn(const oracles::RefinedCloth& cloth) {
  const Vector3d index = cloth.force(base::Finger::kIndex);
  return {index + cloth.force(base::Finger::kThumb), cloth.fabricPosition(base::Finger::kIndex),
          index.x()};
}

Felt feltIn(const oracles::HapticLoop& loop) {
  const contact::FingertipContact& index = loop.layer().contacts()[base::Finger::kIndex];
  return {oracles::forceOnFingertips(loop.layer()), index.fabric_position, index.force.x()};
}

}  // namespace

/// carry [FABRIC [CELLS]]: of wool, 32 x 32, if nothing else is asked for.
int main(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "wool";
  const int cells = argc > 2 ? std::atoi(argv[2]) : 32;
  const material::Fabric fabric =
      material::loadFabric(std::string(HAPTEX_CONFIG_DIRECTORY) + "/fabrics/" + name + ".yaml");
  const auto sample = [&](double rate) {
    oracles::HapticLoopSettings settings =
        oracles::hangingSample(fabric, kes::Direction::kWarp, rate, cells);
    settings.haptics.refinement = 1;
    return settings;
  };
  std::vector<Motion> exact;
  std::optional<double> gap;
  for (const bool slides : {false, true}) {
    oracles::RefinedCloth cloth(sample(80.0));
    const auto step = [&](const Fingertips& fingertips) {
      cloth.step(fingertips, kStep);
      return feltIn(cloth);
    };
    if (slides) {
      exact.push_back(slide(gap, step));
    } else {
      exact = carry(step);
    }
  }
  for (const Motion& motion : exact) printLargest(motion);
  printWay(exact.back());
  for (const double rate : {80.0, 40.0, 25.0}) {
    std::vector<Motion> felt;
    for (const bool slides : {false, true}) {
      oracles::HapticLoop loop(sample(rate));
      const auto step = [&](const Fingertips& fingertips) {
        loop.step(fingertips);
        return feltIn(loop);
      };
      if (slides) {
        felt.push_back(slide(gap, step));
      } else {
        felt = carry(step);
      }
    }
    for (std::size_t i = 0; i < exact.size(); ++i) {
      printLargest(felt[i], rate);
      printError(felt[i], exact[i], rate);
    }
    printWay(felt.back(), rate);
  }
  return 0;
}
