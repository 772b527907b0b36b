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
//   <rate>/error_rms   its root mean square
// Per `surround`, and per rate for the errors:
//   error              the largest of all motions but the slide
//   tick               processor time of a millisecond with patches refined twice at 80 Hz, without
//                      those with a step of the cloth or the exchange of a patch
// Patches are refined once, not twice as shipped, because the whole cloth is as fine: then
// all takes some minutes. In one layer what is lifted and lowered makes the same forces to 5 %.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "haptex/exoskeleton/control/minimum_jerk.h"
#include "haptex/material/fabric_file.h"
#include "haptex/oracles/experiments/contact_scenes.h"
#include "haptex/oracles/experiments/moved_pinch.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using contact::Fingertips;
using Eigen::Vector2d;
using Eigen::Vector3d;
using oracles::Felt;
using oracles::MovedPinch;

constexpr double kStep = oracles::kMovedPinchStep;
constexpr double kPinched = 0.3;  // N, that does not hold the edge

/// @param gap  m, between the fingertips; none: closes until they pinch with kPinched
/// @param step as above
template <typename Step>
MovedPinch slide(std::optional<double>& gap, const Step& step) {
  oracles::Hand hand = oracles::handAtTheEdge();
  MovedPinch motion{"slide", {}};
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

std::string nameOf(const MovedPinch& motion, const char* quantity, double rate = 0.0) {
  const std::string of_rate = rate > 0.0 ? std::to_string(std::lround(rate)) + "Hz/" : "";
  return std::string("carry/") + motion.name + "/" + of_rate + quantity;
}

void printLargest(const MovedPinch& motion, double rate = 0.0) {
  double most = 0.0;
  for (const Felt& felt : motion.felt) most = std::max(most, felt.force.norm());
  bench::printLine(nameOf(motion, "force", rate), most, "N");
}

void printWay(const MovedPinch& motion, double rate = 0.0) {
  const Vector2d way = motion.felt.back().place - motion.felt.front().place;
  bench::printLine(nameOf(motion, "weft", rate), 1e3 * way.x(), "mm");
  bench::printLine(nameOf(motion, "warp", rate), 1e3 * way.y(), "mm");
}

void printError(const MovedPinch& motion, const MovedPinch& exact, double rate) {
  const oracles::ForceDifference error = oracles::differenceOf(motion, exact);
  bench::printLine(nameOf(motion, "error", rate), error.largest, "N");
  bench::printLine(nameOf(motion, "error_rms", rate), error.root_mean_square, "N");
}

/// s, mean over the motions of movePinch().
double timeOfTick(const oracles::HapticLoopSettings& sample) {
  oracles::HapticLoop loop(sample);
  const long period = std::lround(sample.large_scale_step / kStep);
  double sum = 0.0;
  long ticks = 0, counted = 0;
  oracles::movePinch([&](const Fingertips& fingertips) {
    const double begin = bench::processorSeconds();
    loop.step(fingertips);
    const double seconds = bench::processorSeconds() - begin;
    if (++ticks > 300 && ticks % period > 2) {
      sum += seconds;
      ++counted;
    }
    return oracles::feltIn(loop);
  });
  return sum / static_cast<double>(counted);
}

/// @param sample_at settings of a rate (Hz), refined once
/// @param exact     of movePinch(), and maybe more
template <typename SampleAt>
void printSurround(double surround, const SampleAt& sample_at,
                   const std::vector<MovedPinch>& exact) {
  const std::string of = "carry/surround/" + std::to_string(std::lround(1e3 * surround)) + "mm/";
  for (const double rate : {80.0, 40.0, 25.0}) {
    oracles::HapticLoopSettings sample = sample_at(rate);
    sample.haptics.surround = surround;
    oracles::HapticLoop loop(sample);
    const std::vector<MovedPinch> felt = oracles::movePinch([&](const Fingertips& fingertips) {
      loop.step(fingertips);
      return oracles::feltIn(loop);
    });
    double most = 0.0;
    for (std::size_t i = 0; i < felt.size(); ++i) {
      most = std::max(most, oracles::differenceOf(felt[i], exact[i]).largest);
    }
    bench::printLine(of + std::to_string(std::lround(rate)) + "Hz/error", most, "N");
  }
  oracles::HapticLoopSettings shipped = sample_at(80.0);
  shipped.haptics.surround = surround;
  shipped.haptics.refinement = 2;
  bench::printLine(of + "tick", 1e6 * timeOfTick(shipped), "us");
}

}  // namespace

/// carry [FABRIC [CELLS]]: of wool, 32 x 32, if nothing else is asked for.
int main(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "wool";
  const int cells = argc > 2 ? std::atoi(argv[2]) : 32;
  const material::Fabric fabric =
      material::loadFabric(std::string(HAPTEX_CONFIG_DIRECTORY) + "/fabrics/" + name + ".yaml");
  const auto sample = [&](double rate) {
    return oracles::carriedSample(fabric, rate, oracles::kCarriedSurround, cells);
  };
  std::vector<MovedPinch> exact;
  std::optional<double> gap;
  for (const bool slides : {false, true}) {
    oracles::RefinedCloth cloth(sample(80.0));
    const auto step = [&](const Fingertips& fingertips) {
      cloth.step(fingertips, kStep);
      return oracles::feltIn(cloth);
    };
    if (slides) {
      exact.push_back(slide(gap, step));
    } else {
      exact = oracles::movePinch(step);
    }
  }
  for (const MovedPinch& motion : exact) printLargest(motion);
  printWay(exact.back());
  for (const double rate : {80.0, 40.0, 25.0}) {
    std::vector<MovedPinch> felt;
    for (const bool slides : {false, true}) {
      oracles::HapticLoop loop(sample(rate));
      const auto step = [&](const Fingertips& fingertips) {
        loop.step(fingertips);
        return oracles::feltIn(loop);
      };
      if (slides) {
        felt.push_back(slide(gap, step));
      } else {
        felt = oracles::movePinch(step);
      }
    }
    for (std::size_t i = 0; i < exact.size(); ++i) {
      printLargest(felt[i], rate);
      printError(felt[i], exact[i], rate);
    }
    printWay(felt.back(), rate);
  }
  for (const double surround : {0.0, 0.02, 0.03, 0.04, 0.06})
    printSurround(surround, sample, exact);
  return 0;
}
