#include <cmath>

#include "haptex/oracles/checks/contact_oracles.h"
#include "haptex/oracles/experiments/contact_scenes.h"

namespace haptex::oracles {
namespace {

using base::Finger;
using Eigen::Vector3d;

constexpr double kWeightTolerance = 0.01;
constexpr double kBarTolerance = 0.005;
constexpr double kReferenceTolerance = 0.02;
constexpr double kSettledTolerance = 1e-3;

constexpr double kPinchHeight = -0.19;  // m: 10 mm above the lower edge
constexpr double kOpen = 4e-3;          // m, gap in which nothing touches

/// The bar lets go; the sample falls over, swings, and hangs from the fingertips when it rests.
void validateWeight(const material::Fabric& fabric, double rate, const Sink& sink) {
  constexpr double kShortest = 5.0, kLongest = 30.0, kMean = 0.5;  // s
  // At rest: neither ripple nor creep, without looking at the weight, for longer than it takes to
  // turn round in a swing.
  constexpr double kStillRipple = 1e-3;  // N, RMS
  constexpr double kStillCreep = 2e-5;   // N, of the mean from one interval to the next
  constexpr int kStillIntervals = 3;
  const HapticLoopSettings sample = hangingSample(fabric, kes::Direction::kWarp, rate);
  HapticLoop loop(sample);
  Hand hand;
  hand.middle.z() = kPinchHeight;
  hand.gap = kOpen;
  const auto step = [&](const Fingertips& fingertips) { loop.step(fingertips); };
  move(hand, kStill, -2.0 * kOpen, 0.2, 1e-3, step);
  move(hand, kStill, 0.0, 0.3, 1e-3, step);
  loop.releaseAll();
  double mean = 0.0, ripple = 0.0;
  int still = 0;  // intervals in a row
  while (still < kStillIntervals && loop.time() < kLongest) {
    double sum = 0.0, squares = 0.0;
    int count = 0;
    move(hand, kStill, 0.0, kMean, 1e-3, [&](const Fingertips& fingertips) {
      loop.step(fingertips);
      const double force = -forceOnFingertips(loop.layer()).z();
      sum += force;
      squares += force * force;
      ++count;
    });
    const double creep = std::abs(sum / count - mean);
    mean = sum / count;
    ripple = std::sqrt(std::max(0.0, squares / count - mean * mean));
    const bool rests = loop.time() > kShortest && ripple < kStillRipple && creep < kStillCreep;
    still = rests ? still + 1 : 0;
  }
  const std::string name = std::to_string(std::lround(rate)) + "Hz";
  sink(base::relativeTo(weight(sample), "contact/weight/" + name, weight(sample), mean,
                        kWeightTolerance));
  sink({"contact/weight/ripple_N/" + name, 0.0, ripple, ripple, 0.01});
}

/// Forces on the fingertips (N) at each extension of the refined cloth, quasi-static.
std::vector<double> referenceForces(const HapticLoopSettings& sample, Hand hand, double closing,
                                    const std::vector<double>& extensions, const std::string& name,
                                    const Sink& sink) {
  RefinedCloth cloth(sample);
  const auto step = [&](double h) {
    return [&cloth, h](const Fingertips& fingertips) { cloth.step(fingertips, h); };
  };
  const auto force = [&] {
    return cloth.force(Finger::kIndex).z() + cloth.force(Finger::kThumb).z();
  };
  move(hand, kStill, 0.0, 1.0, 0.25, step(0.25));
  // Friction remembers the way: up to the touch at once, from there on as finely as it may be.
  const double free_way = hand.gap - 2.0 * contact::ContactLaw(sample.fabric).halfThickness();
  move(hand, kStill, -free_way, 0.25, 0.25, step(0.25));
  move(hand, kStill, free_way - closing, 0.4, 0.01, step(0.01));
  move(hand, kStill, 0.0, 0.5, 0.25, step(0.25));
  std::vector<double> forces;
  base::Quantity settled{"contact/stretch/" + name + "/reference_settled", 0.0, 0.0, 0.0,
                         kSettledTolerance};
  constexpr int kMaxSteps = 60;
  double reached = 0.0;
  for (double extension : extensions) {
    move(hand, {0.0, 0.0, reached - extension}, 0.0, 0.4, 0.08, step(0.08));
    reached = extension;
    double before = 0.0;
    for (int i = 0; i < kMaxSteps; ++i) {
      before = force();
      cloth.step(hand.fingertips(), 0.25);
      if (std::abs(force() - before) < 0.1 * kSettledTolerance * std::abs(force())) break;
    }
    forces.push_back(force());
    settled.measured = settled.error =
        base::largerOrNaN(settled.error, std::abs(force() - before) / force());
  }
  sink(settled);
  return forces;
}

// Friction and folds remember how the cloth was pinched and pulled, in steps of 1 ms here and in
// few long ones in the reference: some 2 mN at every extension. The first extensions, whose force
// is below 0.12 N, are therefore on the way only.
// @param first, further m, of the extensions @param skipped how many are on the way
void validateStretch(const material::Fabric& fabric, kes::Direction direction, double first,
                     double further, std::size_t skipped, const Sink& sink) {
  const std::string name = nameOf(direction);
  const HapticLoopSettings sample = hangingSample(fabric, direction, 80.0);
  constexpr double kClosing = 8e-3;  // m: a pinch of about 1 N, which holds 0.4 N
  std::vector<double> extensions;
  for (std::size_t i = 0; i < skipped + 5; ++i) extensions.push_back(first + i * further);
  Hand hand;
  hand.middle.z() = kPinchHeight;
  hand.gap = kOpen;
  const std::vector<double> reference =
      referenceForces(sample, hand, kClosing, extensions, name, sink);

  HapticLoop loop(sample);
  const auto step = [&](const Fingertips& fingertips) { loop.step(fingertips); };
  move(hand, kStill, 0.0, 0.6, 1e-3, step);  // until it hangs still
  move(hand, kStill, -kClosing, 0.4, 1e-3, step);
  double reached = 0.0;
  for (std::size_t i = 0; i < extensions.size(); ++i) {
    move(hand, {0.0, 0.0, reached - extensions[i]}, 0.0, 0.2, 1e-3, step);
    reached = extensions[i];
    move(hand, kStill, 0.0, 1.0, 1e-3, step);
    if (i < skipped) continue;
    const double force = forceOnFingertips(loop.layer()).z();
    const double bar = loop.attachmentForce().z() - weight(sample);
    const std::string line =
        "contact/stretch/" + name + "/" + std::to_string(std::lround(1e6 * extensions[i])) + "um";
    sink(base::relativeTo(bar, line + "/bar", bar, force, kBarTolerance));
    sink(base::relativeTo(reference[i], line + "/reference", reference[i], force,
                          kReferenceTolerance));
    const bool slips = loop.layer().contacts()[Finger::kIndex].slipping ||
                       loop.layer().contacts()[Finger::kThumb].slipping;
    sink({line + "/slips", 0.0, slips ? 1.0 : 0.0, slips ? 1.0 : 0.0, 0.0});
  }
}

}  // namespace

void validateContactEquilibrium(const material::Fabric& fabric, const Sink& sink) {
  for (double rate : {25.0, 50.0, 80.0}) validateWeight(fabric, rate, sink);
  validateStretch(fabric, kes::Direction::kWarp, 2e-4, 1e-4, 1, sink);
  validateStretch(fabric, kes::Direction::kWeft, 6e-4, 3e-4, 2, sink);
}

}  // namespace haptex::oracles
