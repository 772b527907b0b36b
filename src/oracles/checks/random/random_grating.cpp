// Gratings stroked at any speed, in any direction, with any force.
#include <cmath>

#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/checks/tactile_oracles.h"
#include "haptex/oracles/experiments/known_surfaces.h"
#include "haptex/tactile/stroke.h"

namespace haptex::oracles {

/// A wave of amplitude a is felt at f = |n.v| with its height and with the friction of its slope:
/// a G(f) sqrt(1 + (s F kappa/Z(f))^2) with kappa = 2 pi f/|v| and the skin's stiffness Z; waves
/// add up in power.
void randomGrating(const std::string&, Random& random, const Sink& sink) {
  for (int i = 0; i < 5; ++i) {
    const int columns = 30 + random.below(50), rows = 30 + random.below(50);
    const double spacing_x = random.uniform(0.5e-4, 2e-4), spacing_y = random.uniform(0.5e-4, 2e-4);
    tactile::HeightField field = flatField(columns, rows, spacing_x, spacing_y);
    tactile::Stroke stroke;
    const double speed = random.logarithmic(1e-3, 0.4), angle = random.uniform(0.0, 360.0);
    stroke.velocity = speed * direction(angle);
    stroke.normal_force = random.uniform(0.1, 2.0);
    const double friction_per_slope = random.chance(0.5) ? random.uniform(0.0, 0.5) : 0.0;
    tactile::PerChannel<double> power{};
    double amplitudes = 0.0;
    const int waves = 1 + random.below(3);
    for (int wave = 0; wave < waves; ++wave) {
      // All different: each has numbers along weft of its own.
      const int along_weft = 1 + 4 * wave + random.below(4), along_warp = random.below(25) - 12;
      const double amplitude = random.logarithmic(1e-7, 5e-5);
      addGrating(field, along_weft, along_warp, amplitude, random.uniform(0.0, 2.0 * M_PI));
      const Eigen::Vector2d per_length(along_weft / (field.columns * field.weft_spacing),
                                       along_warp / (field.rows * field.warp_spacing));
      const double frequency = std::abs(per_length.dot(stroke.velocity));
      const double skin =
          tactile::kSkinStiffness * std::hypot(1.0, frequency / tactile::kSkinCorner);
      const double by_friction =
          friction_per_slope * stroke.normal_force * 2.0 * M_PI * frequency / (speed * skin);
      for (const auto channel : {tactile::k40, tactile::k320}) {
        power[channel] += std::pow(
            amplitude * tactile::gain(channel, frequency) * std::hypot(1.0, by_friction), 2);
      }
      amplitudes += amplitude;
    }
    const tactile::SmallScale surface{tactile::kSpaceOfPeriodic(field), friction_per_slope};
    CaseName text("tactile", "grating_stroke");
    text.with("speed", speed).with("angle", angle).with("force", stroke.normal_force);
    text.with("waves", waves);
    BothChannels both(text.text());
    both.compare({std::sqrt(power[0]), std::sqrt(power[1])}, strokeAmplitudes(surface, stroke),
                 amplitudes);
    both.handTo(sink);
  }
}

}  // namespace haptex::oracles
