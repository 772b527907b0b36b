// The oracles of the tactile room; here gratings, their sums, and symmetries.
#include <array>
#include <cmath>
#include <vector>

#include "haptex/oracles/checks/tactile_oracles.h"
#include "haptex/oracles/experiments/known_surfaces.h"
#include "haptex/tactile/stroke.h"
#include "haptex/tactile/weave_relief.h"

namespace haptex::oracles {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;
using tactile::HeightField;
using tactile::PerChannel;
using tactile::Stroke;

/// Sinusoidal gratings over all speeds and angles: what is felt lies at |v| cos(angle)/L, and goes
/// through the filters.
void validateGratings(const Sink& sink) {
  constexpr double kAmplitude = 5e-6;  // m
  for (const Vector2i& numbers : {Vector2i(8, 0), Vector2i(0, 5), Vector2i(3, 7)}) {
    HeightField field = flatField(40, 36);
    addGrating(field, numbers.x(), numbers.y(), kAmplitude);
    const tactile::SmallScale surface{tactile::kSpaceOfPeriodic(field), 0.0};
    const Vector2d per_length(numbers.x() / 4e-3, numbers.y() / 3.6e-3);  // 1/m
    const std::string name =
        "tactile/grating/" + std::to_string(std::lround(1e6 / per_length.norm())) + "um";
    BothChannels worst(name);
    base::Quantity elsewhere{name + "/power_off_v_over_L", 0.0, 0.0, -1.0, kTactileRounding};
    for (int mm = 1; mm <= 300; ++mm) {
      for (int degrees = 0; degrees <= 180; degrees += 3) {
        const Stroke stroke{1e-3 * mm * direction(degrees), kStandardForce};
        const double frequency = std::abs(per_length.dot(stroke.velocity));
        worst.compare({kAmplitude * tactile::gain(tactile::k40, frequency),
                       kAmplitude * tactile::gain(tactile::k320, frequency)},
                      strokeAmplitudes(surface, stroke), kAmplitude);
      }
      const Stroke along{1e-3 * mm * per_length.normalized(), kStandardForce};
      double off = 0.0;
      for (const tactile::SpectralLine& line : strokeSpectrum(surface, along)) {
        const double at = 1e-3 * mm * per_length.norm();
        if (std::abs(line.frequency - at) > 1e-9 * at) off += line.power;
      }
      base::keepWorse(elsewhere, base::relativeTo(0.5 * kAmplitude * kAmplitude, elsewhere.name,
                                                  0.0, off, kTactileRounding));
    }
    sink(elsewhere);
    worst.handTo(sink);
  }
}

/// The same grating at three angles, 5^2 = 3^2 + 4^2, so that all fit one field; and its strokes.
void validateTurn(const Sink& sink) {
  constexpr double kAmplitude = 5e-6;  // m
  BothChannels worst("tactile/turned_grating_is_turned_stroke");
  HeightField unturned = flatField(32, 32);
  addGrating(unturned, 5, 0, kAmplitude);
  const tactile::SmallScale first{tactile::kSpaceOfPeriodic(unturned), 0.2};
  for (const Vector2i& numbers : {Vector2i(3, 4), Vector2i(4, 3), Vector2i(-3, 4)}) {
    HeightField field = flatField(32, 32);
    addGrating(field, numbers.x(), numbers.y(), kAmplitude, 1.0);
    const tactile::SmallScale turned{tactile::kSpaceOfPeriodic(field), 0.2};
    Eigen::Matrix2d turn;
    turn << 0.2 * numbers.x(), -0.2 * numbers.y(), 0.2 * numbers.y(), 0.2 * numbers.x();
    for (int degrees = 0; degrees <= 180; degrees += 3) {
      const Vector2d velocity = 0.02 * direction(degrees);
      worst.compare(strokeAmplitudes(first, {velocity, kStandardForce}),
                    strokeAmplitudes(turned, {turn * velocity, kStandardForce}), kAmplitude);
    }
  }
  worst.handTo(sink);
}

void validateSum(const Sink& sink) {
  BothChannels worst("tactile/two_gratings_add_in_power");
  HeightField a = flatField(32, 30), b = a, both = a;
  addGrating(a, 6, 1, 4e-6);
  addGrating(both, 6, 1, 4e-6);
  addGrating(b, -2, 4, 3e-6, 2.0);
  addGrating(both, -2, 4, 3e-6, 2.0);
  for (int degrees = 0; degrees <= 180; degrees += 3) {
    const Stroke stroke{0.05 * direction(degrees), kStandardForce};
    const auto felt = [&](const HeightField& field) {
      return strokeAmplitudes({tactile::kSpaceOfPeriodic(field), 0.2}, stroke);
    };
    const PerChannel<double> of_a = felt(a), of_b = felt(b);
    worst.compare({std::hypot(of_a[0], of_b[0]), std::hypot(of_a[1], of_b[1])}, felt(both), 5e-6);
  }
  worst.handTo(sink);
}

void validateParseval(const Sink& sink) {
  for (const auto& [columns, rows] : {std::pair(128, 128), {60, 45}, {101, 97}}) {
    const HeightField field = whiteNoise(columns, rows);
    sink(base::relativeTo(
        variance(field), "tactile/parseval/" + std::to_string(columns) + "x" + std::to_string(rows),
        variance(field), tactile::kSpaceOfPeriodic(field).totalPower(), kTactileRounding));
  }
}

void validateSymmetries(const Sink& sink) {
  BothChannels reversal("tactile/reversal");
  BothChannels turn("tactile/plain_weave_by_90_degrees");
  BothChannels rest("tactile/speed_zero_m", 0.0);
  const tactile::SmallScale noise{tactile::kSpaceOfPeriodic(whiteNoise(64, 60)), 0.2};
  const tactile::SmallScale plain{
      tactile::kSpaceOfPeriodic(tactile::weaveRelief(evenWeave(material::WeaveKind::kPlain, 0.0))),
      0.2};
  for (int degrees = 0; degrees < 180; degrees += 3) {
    const Vector2d velocity = 0.02 * direction(degrees);
    const PerChannel<double> there = strokeAmplitudes(noise, {velocity, kStandardForce});
    reversal.compare(there, strokeAmplitudes(noise, {-velocity, kStandardForce}));
    const PerChannel<double> first = strokeAmplitudes(plain, {velocity, kStandardForce});
    turn.compare(first,
                 strokeAmplitudes(plain, {Vector2d(-velocity.y(), velocity.x()), kStandardForce}));
  }
  rest.compare({}, strokeAmplitudes(noise, {Vector2d::Zero(), kStandardForce}), 1.0);
  reversal.handTo(sink);
  turn.handTo(sink);
  rest.handTo(sink);
}

}  // namespace

void validateTactile(const std::string& config_directory, const Sink& sink) {
  validateGratings(sink);
  validateTurn(sink);
  validateSum(sink);
  validateParseval(sink);
  validateSymmetries(sink);
  validateTactileDirectly(sink);
  validateTactileFabrics(config_directory, sink);
}

}  // namespace haptex::oracles
