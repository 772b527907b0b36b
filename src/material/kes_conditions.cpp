#include "haptex/material/kes_conditions.h"

#include <cmath>
#include <stdexcept>

#include "haptex/base/require.h"
#include "haptex/material/strain_measures.h"

namespace haptex::material {

double exactShearStrain(const MembraneCurves& pulled, double angle) {
  constexpr double kMostAngle = 60.0;  // degrees
  base::require(std::abs(angle) <= kMostAngle, "exactShearStrain", "angle", angle,
                "within 60 degrees either way");
  const double radians = angle * M_PI / 180.0;
  const double slack = std::cos(radians);
  // By how much the threads are longer than slack: at the height slack (1 + elongation).
  const auto borne = [&](double elongation) {
    return slack * (1.0 + elongation) * pulled.elastic.evaluate(greenStrain(elongation)).stress;
  };
  double low = 0.0, high = 1e-3;
  while (borne(high) < kKesShearTension) {
    if (high > 20.0) {
      throw std::runtime_error("the threads do not bear 10 gf/cm at any strain up to 2000 %");
    }
    low = high;
    high *= 2.0;
  }
  for (double middle = 0.5 * (low + high); middle > low && middle < high;
       middle = 0.5 * (low + high)) {
    (borne(middle) < kKesShearTension ? low : high) = middle;
  }
  return std::sin(radians) * (1.0 + high);
}

}  // namespace haptex::material
