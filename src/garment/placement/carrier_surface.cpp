#include "haptex/garment/placement/carrier_surface.h"

#include <Eigen/Geometry>
#include <cmath>

namespace haptex::garment {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct ConeAngle {
  double sine, cosine;  // of the half angle
};

ConeAngle coneAngle(const CarrierSurface& surface) {
  const double cosine = 1.0 / std::hypot(1.0, surface.slope);
  return {surface.slope * cosine, cosine};
}

}  // namespace

Vector3d lay(const CarrierSurface& surface, const PlaceOnSurface& place, const Vector2d& offset) {
  const auto [sine, cosine] = coneAngle(surface);
  const double x = offset.x(), y = offset.y();
  const double middle = surface.radiusAt(place.height);
  const double straight = middle - sine * y;
  const double radius = std::hypot(straight, sine * x);
  const double turn = sine == 0.0 ? x / middle : std::atan2(sine * x, straight) / sine;
  const double climb = (2.0 * middle * y - sine * offset.squaredNorm()) / (middle + radius);
  const double angle = place.angle + turn;
  const Vector3d left = surface.up.cross(surface.front);
  return surface.origin + (place.height + cosine * climb) * surface.up +
         radius * (std::cos(angle) * surface.front + std::sin(angle) * left);
}

double lengthOnSurface(const CarrierSurface& surface, const Vector3d& a, const Vector3d& b) {
  const auto [sine, cosine] = coneAngle(surface);
  const auto across = [&](const Vector3d& point) {
    const Vector3d offset = point - surface.origin;
    return Vector3d(offset - offset.dot(surface.up) * surface.up);
  };
  const Vector3d from = across(a), to = across(b);
  const double turn = std::atan2(surface.up.dot(from.cross(to)), from.dot(to));
  const double climb = (b - a).dot(surface.up) / cosine;
  // In the sector around the apex: (rho_1 - rho_2)^2 + 4 rho_1 rho_2 sin^2(sigma turn / 2).
  const double half = sine == 0.0 ? 0.5 * turn : std::sin(0.5 * sine * turn) / sine;
  return std::sqrt(climb * climb + 4.0 * from.norm() * to.norm() * half * half);
}

}  // namespace haptex::garment
