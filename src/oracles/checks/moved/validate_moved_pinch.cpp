#include <string>

#include "haptex/oracles/checks/contact_oracles.h"
#include "haptex/oracles/experiments/moved_pinch.h"

namespace haptex::oracles {
namespace {

/// N, largest difference in any millisecond.
struct Tolerance {
  const char* name;
  double surround;  // m
  double rate;      // Hz, of large-scale states
  double force;
};

// As scenes have it if they do not ask for more, and with the cloth around the pinch in the patch.
constexpr Tolerance kTolerances[] = {{"moved", 0.0, 80.0, 0.2},
                                     {"moved", 0.0, 40.0, 0.25},
                                     {"moved_surround", kCarriedSurround, 80.0, 0.03},
                                     {"moved_surround", kCarriedSurround, 40.0, 0.1}};

}  // namespace

void validateMovedPinch(const material::Fabric& fabric, const Sink& sink) {
  const auto sampleAt = [&](double rate, double surround) {
    HapticLoopSettings sample = hangingSample(fabric, kes::Direction::kWarp, rate);
    sample.haptics.refinement = 1;  // as fine as the whole cloth is
    sample.haptics.surround = surround;
    return sample;
  };
  RefinedCloth cloth(sampleAt(80.0, 0.0));
  const std::vector<MovedPinch> exact = movePinch([&](const Fingertips& fingertips) {
    cloth.step(fingertips, kMovedPinchStep);
    return feltIn(cloth);
  });
  for (const Tolerance& tolerance : kTolerances) {
    HapticLoop loop(sampleAt(tolerance.rate, tolerance.surround));
    const std::vector<MovedPinch> felt = movePinch([&](const Fingertips& fingertips) {
      loop.step(fingertips);
      return feltIn(loop);
    });
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const double error = differenceOf(felt[i], exact[i]).largest;
      sink({std::string("contact/") + tolerance.name + "/" + exact[i].name + "/" +
                std::to_string(std::lround(tolerance.rate)) + "Hz",
            0.0, error, error, tolerance.force});
    }
  }
}

}  // namespace haptex::oracles
