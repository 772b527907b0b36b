// Colours of pictures and screens: sRGB, IEC 61966-2-1.
#pragma once

#include <cmath>

namespace haptex::appearance {

/// @param linear share of light, 0 to 1, and beyond
inline double srgbOfLinear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

/// @param srgb 0 to 1
inline double linearOfSrgb(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

}  // namespace haptex::appearance
