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

std::string nameOf(const std::string& motion, double rate) {
  return "contact/" + motion + "/" + std::to_string(std::lround(rate)) + "Hz";
}

/// As scenes have it: what a hand feels that pulls taut fabric at once, by friction.
void validatePulledPinch(const material::Fabric& fabric, const Sink& sink) {
  RefinedCloth cloth(carriedSample(fabric, 80.0, 0.0));
  const MovedPinch exact = pullPinch([&](const Fingertips& fingertips) {
    cloth.step(fingertips, kMovedPinchStep);
    return feltIn(cloth);
  });
  for (const Tolerance& tolerance : {Tolerance{80.0, 0.05}, Tolerance{40.0, 0.1}}) {
    HapticLoop loop(carriedSample(fabric, tolerance.rate, 0.0));
    const MovedPinch felt = pullPinch([&](const Fingertips& fingertips) {
      loop.step(fingertips);
      return feltIn(loop);
    });
    const double error = differenceOf(felt, exact).largest;
    sink({nameOf(exact.name, tolerance.rate), 0.0, error, error, tolerance.force});
  }
}

}  // namespace

void validateMovedPinch(const material::Fabric& fabric, const Sink& sink) {
  validatePulledPinch(fabric, sink);
  RefinedCloth cloth(carriedSample(fabric, 80.0, kCarriedSurround));
  const std::vector<MovedPinch> exact = movePinch([&](const Fingertips& fingertips) {
    cloth.step(fingertips, kMovedPinchStep);
    return feltIn(cloth);
  });
  for (const Tolerance& tolerance : {Tolerance{80.0, 0.03}, Tolerance{40.0, 0.1}}) {
    HapticLoop loop(carriedSample(fabric, tolerance.rate, kCarriedSurround));
    const std::vector<MovedPinch> felt = movePinch([&](const Fingertips& fingertips) {
      loop.step(fingertips);
      return feltIn(loop);
    });
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const double error = differenceOf(felt[i], exact[i]).largest;
      sink({nameOf("moved/" + exact[i].name, tolerance.rate), 0.0, error, error, tolerance.force});
    }
  }
}

}  // namespace haptex::oracles
