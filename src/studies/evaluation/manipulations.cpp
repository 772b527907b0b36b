#include "haptex/studies/evaluation/manipulations.h"

#include "haptex/contact/contact_law.h"
#include "haptex/studies/evaluation/strips.h"
#include "haptex/studies/evaluation/trial.h"

namespace haptex::studies {
namespace {

using contact::Fingertips;

constexpr double kOpen = 4e-3;        // m, gap in which nothing touches
constexpr double kLowerEdge = -0.19;  // m, where a hand pinches there
constexpr double kMiddle = -0.1;      // m
constexpr double kOpening = 0.3;      // s

/// Fingertips that face each other along x at a height, with a gap between them (m).
Fingertips pinched(double height, double gap) {
  oracles::Hand hand;
  hand.middle.z() = height;
  hand.gap = gap;
  return hand.fingertips();
}

Trial hangingTrial(const material::Fabric& fabric, double height,
                   const ManipulationSettings& settings) {
  oracles::HapticLoopSettings sample = oracles::hangingSample(
      fabric, kes::Direction::kWarp, 1.0 / settings.large_scale_step, settings.cells);
  if (settings.step) sample.step = *settings.step;
  return {std::move(sample), settings.tremor, pinched(height, kOpen)};
}

DeviceRecord weigh(const material::Fabric& fabric, const ManipulationSettings& settings) {
  Trial trial = hangingTrial(fabric, kLowerEdge, settings);
  trial.moveTo(pinched(kLowerEdge, -0.75 * kOpen), 0.3);
  trial.rest(0.3);
  trial.releaseAll();
  trial.rest(4.0);
  trial.record();
  trial.rest(4.0);
  return trial.result();
}

DeviceRecord drag(const material::Fabric& fabric, const ManipulationSettings& settings) {
  constexpr double kGap = -0.4 * kOpen;
  Trial trial = hangingTrial(fabric, kMiddle, settings);
  trial.moveTo(pinched(kMiddle, kGap), 0.3);
  trial.rest(0.2);
  trial.record();
  trial.moveTo(pinched(kMiddle - 0.03, kGap), 1.5);
  return trial.result();
}

DeviceRecord pinch(const material::Fabric& fabric, const ManipulationSettings& settings) {
  constexpr double kNear = 0.5 * kOpen;
  Trial trial = hangingTrial(fabric, kMiddle, settings);
  trial.moveTo(pinched(kMiddle, kNear), 0.2);
  trial.record();
  for (int i = 0; i < 3; ++i) {
    trial.moveTo(pinched(kMiddle, -0.4 * kOpen), kPinchSeconds - kOpening);
    trial.moveTo(pinched(kMiddle, kNear), kOpening);
  }
  return trial.result();
}

template <Cut kCut>
DeviceRecord press(const material::Fabric& fabric, const ManipulationSettings& settings) {
  return pressStrip(fabric, kCut, settings);
}

template <Cut kCut>
DeviceRecord lower(const material::Fabric& fabric, const ManipulationSettings& settings) {
  return lowerStrip(fabric, kCut, settings);
}

}  // namespace

const std::vector<Manipulation>& manipulations() {
  static const std::vector<Manipulation> all = {{"weigh", weigh},
                                                {"drag", drag},
                                                {"pinch", pinch},
                                                {"press_warp", press<Cut::kWarp>},
                                                {"press_weft", press<Cut::kWeft>},
                                                {"press_bias", press<Cut::kBias>},
                                                {"lower_warp", lower<Cut::kWarp>},
                                                {"lower_weft", lower<Cut::kWeft>}};
  return all;
}

FingertipPair fingertipPair() {
  return {{{oracles::kIndexRadius, oracles::kThumbRadius}}, contact::PulpSettings().stiffness};
}

}  // namespace haptex::studies
