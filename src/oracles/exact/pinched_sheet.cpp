#include "haptex/oracles/exact/pinched_sheet.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace haptex::oracles {
namespace {

// The law is piecewise cubic with a few hundred knots that are not known here: within a part that
// contains none three points are exact, in the others they err by the jump of the second
// derivative.
constexpr int kParts = 4000;

void requirePositive(const char* name, double value) {
  if (!std::isfinite(value) || value <= 0.0) {
    std::ostringstream message;
    message << "pinch: " << name << ' ' << value << " must be finite and > 0";
    throw std::invalid_argument(message.str());
  }
}

// Integral of the pressure from depth 0 (N/m).
double integratePressure(const contact::ContactLaw& law, double depth) {
  const double half = 0.5 * depth / kParts;
  const double offset = std::sqrt(0.6) * half;
  double sum = 0.0;
  for (int i = 0; i < kParts; ++i) {
    const double middle = (2 * i + 1) * half;
    sum += 5.0 * (law.pressure(middle - offset).stress + law.pressure(middle + offset).stress) +
           8.0 * law.pressure(middle).stress;
  }
  return sum * half / 9.0;
}

}  // namespace

PinchForce pinchForce(const contact::ContactLaw& law, double radius, double distance) {
  requirePositive("radius", radius);
  requirePositive("distance", distance);
  const double reach = radius + law.halfThickness();
  const double z = 0.5 * distance;
  const double depth = reach - z;
  if (depth <= 0.0) return {0.0, 0.0, 0.0};
  const double integral = integratePressure(law, depth);
  // d force / d z = 2 pi (integral - z pressure(depth)), and z is half of the distance.
  return {2.0 * M_PI * z * integral, M_PI * (z * law.pressure(depth).stress - integral),
          M_PI * (reach * reach - z * z)};
}

}  // namespace haptex::oracles
