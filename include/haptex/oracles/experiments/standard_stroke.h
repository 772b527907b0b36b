// How strong and of which colour a fabric feels in a standard stroke.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "haptex/tactile/contactor_array.h"

namespace haptex::oracles {

/// The finger moves for a second and presses with 0.5 N, alike on all contactors.
constexpr double kStandardSpeed = 0.02;  ///< m/s
constexpr double kStandardForce = 0.5;   ///< N

/// What all contactors do in strokes along weft, along warp and along both diagonals:
/// means over contactors, steps and strokes.
struct RenderedStroke {
  tactile::PerChannel<double> amplitudes{};  ///< m
  double intensity = 0.0;  ///< m: of the root of the sum of both amplitudes' squares
  /// m: of the larger amplitude and half of the smaller, as people add up the two channels (Hollins
  /// and Roy 1996, Somatosens. Mot. Res. 13:273).
  double perceived_intensity = 0.0;

  /// Of the 320 Hz amplitude to that of 40 Hz: the larger, the finer it feels.
  double ratio() const { return amplitudes[tactile::k320] / amplitudes[tactile::k40]; }
};

/// How a finger strays from its even way along the fabric.
struct Sway {
  Eigen::Vector2d displacement = Eigen::Vector2d::Zero();  ///< m
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();      ///< m/s
};

/// With an array that gives every displacement.
/// @param speed m/s
/// @param sway at a time (s); the strokes follow each other. None: not at all
RenderedStroke renderStrokes(const tactile::Surface& surface, double speed = kStandardSpeed,
                             const std::function<Sway(double)>& sway = nullptr);

constexpr double kYarnSpeed = 0.16;  ///< m/s

/// A fabric as it feels.
struct RenderedFabric {
  std::string name;
  double roughness;  ///< m, SMD
  RenderedStroke stroke;
};

/// All fabrics in config_directory/fabrics that have a surface, by rising SMD.
/// @throws what loadFabric() and buildSurface() throw
std::vector<RenderedFabric> renderFabrics(const std::string& config_directory);

/// Fabrics of the five weaves, alike in yarns, irregularity, SMD and MMD, by the name of the weave,
/// stroked so fast that their yarns of 0.5 mm are felt at 320 Hz and the repeats of the weave
/// below.
/// @param config_directory where all that has nothing to do with the surface comes from
/// @throws what loadFabric() throws
std::vector<RenderedFabric> renderWeaves(const std::string& config_directory);

/// Spearman's rank correlation; equal values share their mean rank.
/// @throws std::invalid_argument unless both have the same number of values, at least 2, none of
///   them NaN and not all of either equal
double rankCorrelation(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace haptex::oracles
