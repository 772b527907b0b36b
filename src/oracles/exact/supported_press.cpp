#include "haptex/oracles/exact/supported_press.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "haptex/base/require.h"

namespace haptex::oracles {
namespace {

using Eigen::Vector2d;

// Twice as many of either change the force by less than 2e-4 of it.
constexpr int kRings = 150;
constexpr int kSteps = 150;

/// What the fingertip does to a place: (along the sheet, across it), in Pa.
struct Traction {
  Vector2d pressure;
  Vector2d friction;
};

/// A ring of the sheet under a fingertip that comes down.
class Ring {
 public:
  Ring(const material::Compression& fabric, const contact::ContactLaw& law, double reach,
       double radius)
      : fabric_(fabric), law_(law), reach_(reach), radius_(radius) {}

  /// Goes on to a height (m) of the centre. @return Pa, of the plate
  double descend(double height) {
    const double half = law_.halfThickness();
    double least = 0.0, most = fabric_.thickness;
    for (int i = 0; i < 60; ++i) {
      const double way = 0.5 * (least + most);
      const Traction there = tractionAt(height, way);
      const double push = -(there.pressure + there.friction).y();
      (fabric_.pressure.evaluate(way / half).stress < push ? least : most) = way;
    }
    const Traction traction = tractionAt(height, least);
    if (traction.pressure.isZero(0.0)) return 0.0;
    if (!holds_) anchor_ = offset(height, least);
    const double limit = law_.friction() * traction.pressure.norm();
    if (!holds_ || traction.friction.norm() >= limit * (1.0 - 1e-9)) {
      anchor_ = offset(height, least) + traction.friction / law_.tangentialStiffness();
    }
    holds_ = true;
    return fabric_.pressure.evaluate(least / half).stress;
  }

 private:
  Vector2d offset(double height, double way) const { return {radius_, -height - way}; }

  Traction tractionAt(double height, double way) const {
    const Vector2d from_centre = offset(height, way);
    const double distance = from_centre.norm();
    const double pressure = law_.pressure(reach_ - distance).stress;
    const Vector2d normal = from_centre / distance;
    Traction result{pressure * normal, Vector2d::Zero()};
    if (!holds_) return result;
    const Vector2d stretched = from_centre - anchor_;
    const Vector2d along = stretched - normal * normal.dot(stretched);
    const double pull = law_.tangentialStiffness() * along.norm();
    const double held = std::min(1.0, law_.friction() * pressure / std::max(pull, 1e-300));
    result.friction = -held * law_.tangentialStiffness() * along;
    return result;
  }

  const material::Compression& fabric_;
  const contact::ContactLaw& law_;
  double reach_, radius_;               // m
  bool holds_ = false;                  // has touched
  Vector2d anchor_ = Vector2d::Zero();  // m, from the centre
};

}  // namespace

double supportedPressForce(const material::Fabric& fabric, const contact::ContactLaw& law,
                           double radius, double height) {
  const double reach = radius + law.halfThickness();
  if (!(radius > 0.0) || !std::isfinite(radius)) {
    base::refuse("press: radius ", radius, " must be finite and > 0");
  }
  if (!(height > 0.0 && height <= reach)) {
    base::refuse("press: height ", height, " must be > 0 and at most ", reach);
  }
  const double widest = std::sqrt(reach * reach - height * height);
  double force = 0.0;
  for (int i = 0; i < kRings; ++i) {
    const double ring_radius = (i + 0.5) / kRings * widest;
    Ring ring(*fabric.compression, law, reach, ring_radius);
    const double touch = std::sqrt(reach * reach - ring_radius * ring_radius);
    double pressure = 0.0;
    for (int step = 1; step <= kSteps; ++step) {
      pressure = ring.descend(touch + (height - touch) * step / kSteps);
    }
    force += pressure * 2.0 * M_PI * ring_radius * widest / kRings;
  }
  return force;
}

}  // namespace haptex::oracles
