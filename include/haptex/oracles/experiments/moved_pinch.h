// A pinch that carries the hanging sample, and what the hand feels of it.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "haptex/oracles/experiments/contact_scenes.h"

namespace haptex::oracles {

constexpr double kMovedPinchStep = 1e-3;   ///< s, between two records
constexpr double kCarriedSurround = 0.06;  ///< m, of patches that carry cloth: HapticSettings

/// hangingSample() along the warp, with patches refined once, as fine as RefinedCloth is of it. Its
/// large-scale steps are solved to the end: taut cloth that suddenly slackens buckles, and what
/// few Newton iterations leave open there is felt as much as what this experiment is about
/// (docs/contact.md, What is carried).
/// @param rate     Hz, of large-scale states
/// @param surround m, of patches: HapticSettings
HapticLoopSettings carriedSample(const material::Fabric& fabric, double rate, double surround,
                                 int cells = kSampleCells);

/// After a millisecond.
struct Felt {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< N, on both fingertips together
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< m, of the index finger, (weft, warp)
  double normal_force = 0.0;                        ///< N, on the index finger
};

Felt feltIn(const RefinedCloth& cloth);
Felt feltIn(const HapticLoop& loop);

struct MovedPinch {
  std::string name;
  std::vector<Felt> felt;  ///< of every millisecond
};

/// The fingers with an open gap at the lower edge of hangingSample() along the warp.
Hand handAtTheEdge();

/// They pinch and rest, are "held" for 0.2 s, "lifted" evenly by 50 mm across the sheet and 20 mm
/// up in 0.5 s, rest for as long while the cloth is "swinging", are "lowered" likewise, come up by
/// 10 mm, and are "shaken" for a second, twice a second by 10 mm to either side across the sheet.
/// The hand starts and stops within a millisecond.
/// @param step takes fingertips for kMovedPinchStep and returns what they feel
std::vector<MovedPinch> movePinch(const std::function<Felt(const Fingertips&)>& step);

/// They pinch and rest as above, and the sheet is "pulled" down at once, by 3 mm at 50 mm/s; then
/// they rest for 0.1 s.
MovedPinch pullPinch(const std::function<Felt(const Fingertips&)>& step);

/// N: of the difference of forces over all milliseconds.
struct ForceDifference {
  double largest = 0.0;
  double root_mean_square = 0.0;
};

/// @param motion, exact of as many milliseconds, at least one
ForceDifference differenceOf(const MovedPinch& motion, const MovedPinch& exact);

}  // namespace haptex::oracles
