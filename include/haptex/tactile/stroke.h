// What a fingertip that strokes a surface feels: the spectrum along the movement and its two
// channels.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/tactile/channels.h"
#include "haptex/tactile/k_space.h"

namespace haptex::tactile {

/// How a fingertip moves over the fabric.
struct Stroke {
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< m/s, along weft and warp
  double normal_force = 0.0;                           ///< N, >= 0
};

/// The small-scale description of a surface.
struct SmallScale {
  KSpace waves;
  /// Deviation of the coefficient of friction per slope of the surface along the movement.
  double friction_per_slope = 0.0;
};

/// Tangential displacement of the skin per friction that varies with frequency f (Hz):
///   1/(k sqrt(1 + (f/f_c)^2)),
/// a spring and a damper side by side. Fingertips have about 1 N/mm, and viscosity outweighs
/// elasticity above about 100 Hz (Wiertlewski and Hayward 2012, J. Biomech. 45:1869).
constexpr double kSkinStiffness = 1000.0;  ///< N/m
constexpr double kSkinCorner = 100.0;      ///< Hz

/// Amplitudes (m) of the two channels. Every wave is felt at f = |k.v|/(2 pi) (Hz) and counts with
/// its height, and with the friction that its slope along the movement causes:
///   A_c^2 = 2 sum G_c(f)^2 power (1 + (s F kappa/|Z(f)|)^2),
/// with s = friction_per_slope, F the normal force, kappa = |k.v|/|v| and |Z| the skin's stiffness
/// above. A wave of amplitude a at the frequency of a channel so gives a there. Allocates nothing.
/// Zero for a stroke without movement, and for one that is not finite or so large that its
/// squares are not.
PerChannel<double> strokeAmplitudes(const SmallScale& surface, const Stroke& stroke);

/// A line of the temporal spectrum.
struct SpectralLine {
  double frequency;  ///< Hz
  double power;      ///< m^2
};

/// The temporal spectrum before the filters, one line per wave, by rising frequency: what
/// strokeAmplitudes() weights, for people and for checks.
std::vector<SpectralLine> strokeSpectrum(const SmallScale& surface, const Stroke& stroke);

}  // namespace haptex::tactile
