#include "haptex/oracles/exact/flat_contact.h"

#include <algorithm>
#include <cmath>

#include "haptex/base/require.h"

namespace haptex::oracles {

using Eigen::Vector3d;

FlatSheet::FlatSheet(double half_side, int cells) {
  const double side = 2.0 * half_side / cells;
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) {
      positions.emplace_back(0.0, i * side - half_side, j * side - half_side);
      areas.push_back(side * side);
    }
  }
  velocities.assign(positions.size(), Vector3d::Zero());
}

double exactDrag(const contact::ContactLaw& law, double radius, double depth, double displacement) {
  constexpr int kParts = 20000;  // the midpoint rule errs by about 1 / kParts^2
  const double reach = radius + law.halfThickness();
  base::require(std::isfinite(radius) && radius > 0.0, "exactDrag", "radius", radius,
                "finite and > 0 m");
  base::require(depth >= 0.0 && depth <= reach, "exactDrag", "depth", depth,
                ">= 0 and <= " + base::shortNumber(reach) + " m");
  base::require(displacement >= 0.0, "exactDrag", "displacement", displacement, ">= 0 m");
  const double stick = law.tangentialStiffness() * displacement;
  double sum = 0.0;
  for (int i = 0; i < kParts; ++i) {
    const double here = depth * (i + 0.5) / kParts;
    sum += (reach - here) * std::min(stick, law.friction() * law.pressure(here).stress);
  }
  return 2.0 * M_PI * sum * depth / kParts;
}

}  // namespace haptex::oracles
