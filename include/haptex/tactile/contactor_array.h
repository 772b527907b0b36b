// The array of contactors under a fingertip: 6 x 4, 2 mm apart.
#pragma once

#include <Eigen/Core>
#include <array>

#include "haptex/tactile/channels.h"
#include "haptex/tactile/surface.h"

namespace haptex::tactile {

constexpr int kContactorRows = 4;     ///< along y of the array
constexpr int kContactorColumns = 6;  ///< along x of the array
constexpr int kContactors = kContactorRows * kContactorColumns;
/// One of the four nearest to the middle: second row, third column.
constexpr int kMiddleContactor = 8;
constexpr double kContactorSpacing = 2e-3;  ///< m

/// A value for each contactor, index 6 row + column.
template <typename T>
using PerContactor = std::array<T, kContactors>;

/// Place of a contactor in the frame of the array (m): z out of the pad, x distal, origin in the
/// middle.
inline Eigen::Vector2d contactorPlace(int contactor) {
  const int column = contactor % kContactorColumns, row = contactor / kContactorColumns;
  return kContactorSpacing *
         Eigen::Vector2d(column - 0.5 * (kContactorColumns - 1), row - 0.5 * (kContactorRows - 1));
}

/// Where the plane of the array lies on the fabric: a contactor at (x, y) of the array is at
/// origin + axes (x, y).
struct ArrayPlacement {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();    ///< m, along weft and warp
  Eigen::Matrix2d axes = Eigen::Matrix2d::Identity();  ///< columns: x and y of the array

  Eigen::Vector2d placeOf(int contactor) const { return origin + axes * contactorPlace(contactor); }
};

/// What the array can do.
struct ArrayLimits {
  double lowest_frequency = 20.0;      ///< Hz
  double highest_frequency = 400.0;    ///< Hz; a channel outside of the two stays silent
  double largest_displacement = 1e-4;  ///< m, of both channels together

  bool delivers(Channel channel) const {
    return kChannelFrequencies[channel] >= lowest_frequency &&
           kChannelFrequencies[channel] <= highest_frequency;
  }
};

/// @throws std::invalid_argument naming the limit, its value and what is allowed: finite, > 0, the
///   lowest frequency below the highest
void requireSound(const ArrayLimits& limits);

/// What the tactile renderer needs of a fingertip's contact.
struct TouchedFabric {
  Stroke stroke;
  ArrayPlacement placement;
  PerContactor<double> forces{};  ///< N, normal, under every contactor
};

/// Amplitudes of the vibration of every contactor, m.
using ArrayAmplitudes = PerContactor<PerChannel<double>>;

/// Force at which a contactor's vibration reaches half of its amplitude: a fiftieth of the 0.5 N of
/// a gentle touch. Representative.
constexpr double kHalfForce = 0.01;  ///< N

/// Amplitudes A_c of the stroke, at each contactor times the large scale at its place, times
/// F/(F + kHalfForce) for the force F under it: lifted contactors are silent. Where the two
/// channels together would go further than the array can, both are less by the same factor.
/// Channels that the array does not deliver are zero. Allocates nothing. All zero if a number is
/// not finite.
ArrayAmplitudes arrayAmplitudes(const Surface& surface, const TouchedFabric& touched,
                                const ArrayLimits& limits);

}  // namespace haptex::tactile
