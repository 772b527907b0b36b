// k-space against the slow, direct way: the spectra of heights along strokes.
#include <algorithm>
#include <cmath>

#include "haptex/base/workload.h"
#include "haptex/oracles/checks/tactile_oracles.h"
#include "haptex/oracles/experiments/direct_stroke.h"
#include "haptex/oracles/experiments/known_surfaces.h"
#include "haptex/tactile/weave_relief.h"

namespace haptex::oracles {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;
using tactile::HeightField;
using tactile::PerChannel;

constexpr double kSpeed = 0.06;  // m/s: both channels have their share

/// Five periodic surfaces by strokes whose spectra are sharp, and by a long one in a direction
/// that never comes back.
void validatePeriodicSurfaces(const Sink& sink) {
  using material::WeaveKind;
  const auto woven = [](WeaveKind kind) { return tactile::weaveRelief(evenWeave(kind, 0.15)); };
  const std::pair<const char*, HeightField> surfaces[] = {{"plain", woven(WeaveKind::kPlain)},
                                                          {"twill", woven(WeaveKind::kTwill31)},
                                                          {"satin", woven(WeaveKind::kSatin5)},
                                                          {"rib", woven(WeaveKind::kRib2)},
                                                          {"noise", whiteNoise(48, 45)}};
  for (const auto& [name, sampled] : surfaces) {
    if (base::kSanitized && name != std::string("rib")) continue;
    const InterpolatedRelief relief(sampled);
    const HeightField field = relief.oddlySampled();
    const tactile::SmallScale surface{tactile::kSpaceOfPeriodic(field), 0.0};
    for (const Vector2i& crossings : {Vector2i(1, 0), Vector2i(0, 1), Vector2i(-1, 2)}) {
      const Vector2d way = crossings.cast<double>().cwiseProduct(relief.period());
      const PerChannel<double> exact = alongClosedStrokes(field, crossings, kSpeed);
      BothChannels quantities(std::string("tactile/direct/") + name + "/" +
                              std::to_string(crossings.x()) + "_" + std::to_string(crossings.y()));
      quantities.compare(exact,
                         strokeAmplitudes(surface, {kSpeed * way.normalized(), kStandardForce}));
      quantities.handTo(sink);
    }
    LongStrokes strokes;
    strokes.velocity = kSpeed * direction(27.3);
    strokes.length = 0.1;
    strokes.spacing = 0.5 * std::min(field.weft_spacing, field.warp_spacing);
    strokes.strokes = 32;
    strokes.starts = relief.period();
    const PerChannel<double> exact = alongLongStrokes(relief, strokes);
    BothChannels quantities(std::string("tactile/direct/") + name + "/long", 0.01);
    quantities.compare(exact, strokeAmplitudes(surface, {strokes.velocity, kStandardForce}));
    quantities.handTo(sink);
  }
}

/// A piece of a surface that goes on: eight waves that fit no piece.
void validatePiece(const Sink& sink) {
  const Relief relief = [](const Vector2d& place) {
    double height = 0.0;
    for (int i = 0; i < 8; ++i) {
      const double length = 3e-4 * std::pow(1.27, i);  // m, up to 1.6 mm
      height += 3e-6 * std::cos(2.0 * M_PI / length * direction(47.0 * i).dot(place) + i);
    }
    return height;
  };
  HeightField piece = flatField(128, 128);
  for (int row = 0; row < 128; ++row) {
    for (int column = 0; column < 128; ++column) {
      piece.heights[128 * row + column] = relief(1e-4 * Vector2d(column, row));
    }
  }
  const tactile::SmallScale surface{tactile::kSpaceOfPiece(piece), 0.0};
  BothChannels worst("tactile/direct/piece/long", 0.01);
  for (int degrees = 0; degrees < 180; degrees += base::unlessSanitized(20, 90)) {
    const LongStrokes strokes{kStandardSpeed * direction(degrees), 0.1, 1e-4, 100, {0.1, 0.1}};
    const PerChannel<double> exact = alongLongStrokes(relief, strokes);
    worst.compare(exact, strokeAmplitudes(surface, {strokes.velocity, kStandardForce}));
  }
  worst.handTo(sink);
}

}  // namespace

void validateTactileDirectly(const Sink& sink) {
  validatePeriodicSurfaces(sink);
  validatePiece(sink);
}

}  // namespace haptex::oracles
