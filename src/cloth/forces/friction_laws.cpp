#include "haptex/cloth/forces/friction_laws.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptex::cloth {
namespace {

constexpr double kDegree = M_PI / 180.0;
// U.V of threads that are not stretched, at the angles of KES.
const double kSmallShear = std::sin(0.5 * kDegree);
const double kLargeShear = std::sin(5.0 * kDegree);

}  // namespace

ThreadFriction::ThreadFriction(material::StrainStressCurve curve, double resilience)
    : curve_(std::move(curve)), share_(share(resilience)) {}

ThreadFriction::Work ThreadFriction::workAt(double strain) const {
  const double energy = curve_.energy(strain);
  // Work below 0 is that of a curve that pushes when it is stretched.
  const bool slack = strain <= 0.0 || energy < 0.0;
  return {energy, slack, slack ? kLeastWork : kLeastWork + energy};
}

FrictionResponse ThreadFriction::respond(double strain, double remembered) const {
  const Work work = workAt(strain);
  const double beyond = work.counted - remembered, most = kYieldShare * remembered;
  FrictionResponse response;
  double force, tangent, secant;  // by the work, which friction resists as a block on a spring
  if (std::abs(beyond) > most) {
    force = std::copysign(share_, beyond);
    tangent = 0.0;
    secant = share_ / std::abs(beyond);
    response.energy = share_ * (std::abs(beyond) - 0.5 * most);
  } else {  // NaN stays NaN, and the step is refused
    tangent = secant = share_ / most;
    force = secant * beyond;
    response.energy = 0.5 * force * beyond;
  }
  const auto [stress, slope] = curve_.evaluate(strain);
  if (work.slack) {
    response.stress = share_ * stress;
    response.tangent = share_ * slope;
    response.secant = std::max(0.0, response.tangent);
    response.energy += share_ * work.energy;
    return response;
  }
  response.stress = force * stress;
  response.tangent = force * slope + tangent * stress * stress;
  response.secant = secant * stress * stress;
  return response;
}

double ThreadFriction::forgotten(double strain) const {
  return workAt(strain).counted / (1.0 + kYieldShare);
}

double ThreadFriction::follow(double strain, double remembered) const {
  const double now = workAt(strain).counted;
  return std::clamp(remembered, now / (1.0 + kYieldShare), now / (1.0 - kYieldShare));
}

ShearFriction::ShearFriction(const material::ShearHysteresis& hysteresis)
    : small_(0.5 * hysteresis.at_half_degree),
      large_(0.5 * hysteresis.at_five_degrees),
      slope_((large_ - small_) / (kLargeShear - kSmallShear)) {}

ShearFriction::Yield ShearFriction::yieldAt(double strain) const {
  const double size = std::abs(strain);
  // What y is above small_ on the slope, from kSmallShear to kLargeShear, and its integrals.
  const double up = size - kSmallShear, width = kLargeShear - kSmallShear;
  double above = 0.0, energy = 0.0, moment = 0.0, slope = 0.0;
  if (!(size <= kSmallShear)) {  // NaN, too
    const double x = up > width ? width : up;
    above = slope_ * x;
    energy = 0.5 * slope_ * x * x + above * (up - x);
    moment = slope_ * x * x * (0.5 * kSmallShear + x / 3.0) +
             0.5 * above * (size * size - (kSmallShear + x) * (kSmallShear + x));
    slope = up > width ? 0.0 : slope_;
  }
  return {small_ + above, strain < 0.0 ? -slope : slope,
          std::copysign(small_ * size + energy, strain), 0.5 * small_ * size * size + moment};
}

FrictionResponse ShearFriction::respond(double strain, double remembered) const {
  const double beyond = strain - remembered;
  const Yield at = yieldAt(strain), plastic = yieldAt(remembered);
  // The energy of the spring from the plastic strain to another one.
  const auto stored = [&](const Yield& to) {
    return (to.moment - plastic.moment - remembered * (to.energy - plastic.energy)) / kYieldStrain;
  };
  if (std::abs(beyond) > kYieldStrain) {
    const double side = std::copysign(1.0, beyond);
    const Yield yielded = yieldAt(remembered + side * kYieldStrain);
    return {side * at.stress, side * at.slope, at.stress / std::abs(beyond),
            stored(yielded) + side * (at.energy - yielded.energy)};
  }
  const double part = beyond / kYieldStrain;  // NaN stays NaN, and the step is refused
  return {at.stress * part, at.stress / kYieldStrain + at.slope * part, at.stress / kYieldStrain,
          stored(at)};
}

double ShearFriction::follow(double strain, double remembered) const {
  return std::clamp(remembered, strain - kYieldStrain, strain + kYieldStrain);
}

}  // namespace haptex::cloth
