#include <string>

#include "haptex/oracles/checks/contact_oracles.h"
#include "haptex/oracles/experiments/moved_pinch.h"

namespace haptex::oracles {
namespace {

/// N, largest in any millisecond.
struct Tolerance {
  double rate;  // Hz, of large-scale states
  double force;
};

}  // namespace

void validateMovedPinch(const material::Fabric& fabric, const Sink& sink) {
  const auto sampleAt = [&](double rate) {
    HapticLoopSettings sample = hangingSample(fabric, kes::Direction::kWarp, rate);
    sample.haptics.refinement = 1;  // as fine as the whole cloth is
    sample.haptics.surround = kCarriedSurround;
    return sample;
  };
  RefinedCloth cloth(sampleAt(80.0));
  const std::vector<MovedPinch> exact = movePinch([&](const Fingertips& fingertips) {
    cloth.step(fingertips, kMovedPinchStep);
    return feltIn(cloth);
  });
  for (const Tolerance& tolerance : {Tolerance{80.0, 0.03}, Tolerance{40.0, 0.1}}) {
    HapticLoop loop(sampleAt(tolerance.rate));
    const std::vector<MovedPinch> felt = movePinch([&](const Fingertips& fingertips) {
      loop.step(fingertips);
      return feltIn(loop);
    });
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const double error = differenceOf(felt[i], exact[i]).largest;
      sink({"contact/moved/" + exact[i].name + "/" + std::to_string(std::lround(tolerance.rate)) +
                "Hz",
            0.0, error, error, tolerance.force});
    }
  }
}

}  // namespace haptex::oracles
