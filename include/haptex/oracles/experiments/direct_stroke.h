// The slow way from a surface to the two channels: heights along strokes, transformed in time.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "haptex/tactile/channels.h"
#include "haptex/tactile/height_field.h"

namespace haptex::oracles {

/// Height (m) at a place (m).
using Relief = std::function<double(const Eigen::Vector2d& place)>;

/// Between the samples of a field that continues at its opposite edge, by trigonometric
/// interpolation: the samples weighted by Dirichlet's kernel, without any transform.
class InterpolatedRelief {
 public:
  /// @throws what tactile::requireSound() throws
  explicit InterpolatedRelief(const tactile::HeightField& field);

  double operator()(const Eigen::Vector2d& place) const;
  /// m, of a period along weft and along warp.
  Eigen::Vector2d period() const;
  /// The same heights on a grid of odd numbers of samples. There no wave is its own opposite, and
  /// the variance of the samples is that of what lies between them.
  tactile::HeightField oddlySampled() const;

 private:
  tactile::HeightField field_;
};

/// Amplitudes (m) of the two channels from the height alone, of strokes that cross the field `weft`
/// times along weft and `warp` times along warp until they come back to their start: the lines of
/// their spectra are sharp. The power of a line is the mean over parallel strokes that are so many
/// that waves of the same frequency do not interfere. Exact for the waves of the field.
/// @param crossings without common divisor, not both zero @param speed m/s
/// @throws std::invalid_argument for other crossings, and what InterpolatedRelief throws
tactile::PerChannel<double> alongClosedStrokes(const tactile::HeightField& field,
                                               const Eigen::Vector2i& crossings, double speed);

/// Long straight strokes from evenly strewn starts.
struct LongStrokes {
  Eigen::Vector2d velocity;  ///< m/s
  double length;             ///< m
  double spacing;            ///< m, of samples: at most half of the shortest wave
  int strokes;
  Eigen::Vector2d starts;  ///< m: a start lies between zero and this
};

/// The same from the mean spectrum of strokes that are faded in and out by a Hann window, which
/// widens lines to a few |v|/length.
tactile::PerChannel<double> alongLongStrokes(const Relief& relief, const LongStrokes& strokes);

}  // namespace haptex::oracles
