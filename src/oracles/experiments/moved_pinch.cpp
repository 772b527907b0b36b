#include "haptex/oracles/experiments/moved_pinch.h"

#include <algorithm>
#include <cmath>

namespace haptex::oracles {

using base::Finger;
using Eigen::Vector3d;

HapticLoopSettings carriedSample(const material::Fabric& fabric, double rate, double surround,
                                 int cells) {
  HapticLoopSettings sample = hangingSample(fabric, kes::Direction::kWarp, rate, cells);
  sample.haptics.refinement = 1;
  sample.haptics.surround = surround;
  sample.step.newton_iterations = 20;
  return sample;
}

Felt feltIn(const RefinedCloth& cloth) {
  const Vector3d index = cloth.force(Finger::kIndex);
  return {index + cloth.force(Finger::kThumb), cloth.fabricPosition(Finger::kIndex), index.x()};
}

Felt feltIn(const HapticLoop& loop) {
  const contact::FingertipContact& index = loop.layer().contacts()[Finger::kIndex];
  return {forceOnFingertips(loop.layer()), index.fabric_position, index.force.x()};
}

Hand handAtTheEdge() {
  Hand hand;
  hand.middle.z() = -0.19;
  hand.gap = 4e-3;
  return hand;
}

std::vector<MovedPinch> movePinch(const std::function<Felt(const Fingertips&)>& step) {
  Hand hand = handAtTheEdge();
  std::vector<MovedPinch> motions;
  const auto record = [&](const Fingertips& fingertips) {
    const Felt felt = step(fingertips);
    if (!motions.empty()) motions.back().felt.push_back(felt);
  };
  const auto moveBy = [&](const Vector3d& way, double opening, double seconds) {
    move(hand, way, opening, seconds, kMovedPinchStep, record);
  };
  const auto begin = [&](const char* name) { motions.push_back({name, {}}); };
  const Vector3d still = Vector3d::Zero(), way(0.05, 0.0, 0.02);
  moveBy(still, -8e-3, 0.2);
  moveBy(still, 0.0, 0.8);
  begin("held");
  moveBy(still, 0.0, 0.2);
  begin("lifted");
  moveBy(way, 0.0, 0.5);
  begin("swinging");
  moveBy(still, 0.0, 0.5);
  begin("lowered");
  moveBy(-way, 0.0, 0.5);
  moveBy({0.0, 0.0, 0.01}, 0.0, 0.3);
  begin("shaken");
  for (int i = 1; i <= 1000; ++i) {
    const double phase = 4.0 * M_PI * i * kMovedPinchStep;
    const Vector3d before = hand.middle;
    hand.middle.x() = 0.01 * std::sin(phase);
    hand.velocity = (hand.middle - before) / kMovedPinchStep;
    record(hand.fingertips());
  }
  return motions;
}

MovedPinch pullPinch(const std::function<Felt(const Fingertips&)>& step) {
  Hand hand = handAtTheEdge();
  MovedPinch pulled{"pulled", {}};
  const auto ignore = [&](const Fingertips& fingertips) { step(fingertips); };
  const auto record = [&](const Fingertips& fingertips) {
    pulled.felt.push_back(step(fingertips));
  };
  const Vector3d still = Vector3d::Zero();
  move(hand, still, -8e-3, 0.2, kMovedPinchStep, ignore);
  move(hand, still, 0.0, 0.8, kMovedPinchStep, ignore);
  move(hand, {0.0, 0.0, -0.003}, 0.0, 0.06, kMovedPinchStep, record);
  move(hand, still, 0.0, 0.1, kMovedPinchStep, record);
  return pulled;
}

ForceDifference differenceOf(const MovedPinch& motion, const MovedPinch& exact) {
  ForceDifference difference;
  double squares = 0.0;
  for (std::size_t k = 0; k < exact.felt.size(); ++k) {
    const double error = (motion.felt[k].force - exact.felt[k].force).norm();
    difference.largest = std::max(difference.largest, error);
    squares += error * error;
  }
  difference.root_mean_square = std::sqrt(squares / static_cast<double>(exact.felt.size()));
  return difference;
}

}  // namespace haptex::oracles
