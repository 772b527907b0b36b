// The heavy elastica: a strip that is clamped level at one end and bends under its own weight.
#pragma once

namespace haptex::oracles {

constexpr double kLargestGamma = 1000.0;  ///< up to which exactDropOverReach() is asked for

/// Drop of the tip over its horizontal distance from the clamp, of the elastica
///   theta'' = -gamma (1 - s) cos(theta), theta(0) = theta'(1) = 0,
/// with the slope theta (rad) at the arc length s (of the whole) from the clamp and gamma =
/// w g L^3 / B (no unit), the weight w g per area (N/m^2), the length L (m) and the bending
/// rigidity B (N.m). Solved by collocation at Chebyshev points (Trefethen 2000, Spectral Methods in
/// MATLAB, chapters 6 and 14) to 1e-10 of the result: shooting is not up to it, because from the
/// clamp as from the tip neighbouring solutions part as exp(2/3 sqrt(gamma)), which is 1e9 at 1000.
/// @param gamma > 0, <= kLargestGamma
/// @throws std::invalid_argument naming a gamma out of this range
double exactDropOverReach(double gamma);

}  // namespace haptex::oracles
