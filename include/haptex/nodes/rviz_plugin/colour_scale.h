// Which colour a quantity of the cloth has, and the legend that tells it.
#pragma once

#include <string>
#include <vector>

namespace haptex::nodes {

/// What the colours of a cloth tell.
enum class ColourBy {
  kStrain,        ///< largest principal Green-Lagrange strain, no unit
  kStress,        ///< largest principal elastic membrane stress, N/m
  kContactForce,  ///< force of the fingertips on a particle, N
  kFabric,        ///< which of the cloth's fabrics
  kPanel,         ///< which part that no triangle joins with another
  kLook,          ///< how it reflects light
};

/// A number beside a colour bar.
struct ScaleTick {
  double fraction;  ///< along the bar, 0 at its first colour, 1 at its last
  std::string label;
};

/// A logarithmic scale of values, whose colours are those of viridis.
struct ColourScale {
  std::string title;      ///< with the unit
  double full;            ///< the value with the last colour, > 0
  int decades;            ///< that the colours span, > 0
  double factor = 1.0;    ///< what a value is shown by: 100 for per cent
  std::string unit = "";  ///< behind every number

  /// 0 to 1; 0 for what is not > 0 and for NaN.
  double fraction(double value) const;
  /// One for every decade, from the first colour on.
  std::vector<ScaleTick> ticks() const;
};

/// With the full scale that shows the shipped samples well: strain 1 %, stress 100 N/m, force
/// 0.1 N. @throws std::invalid_argument for fabric, panel and look, which have no scale
ColourScale scaleOf(ColourBy quantity);

}  // namespace haptex::nodes
