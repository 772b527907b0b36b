#include "haptex/proximity/cursor.h"

#include <sstream>
#include <stdexcept>
#include <utility>

namespace haptex::proximity {
namespace {

void requireRadius(double radius) {
  if (radius >= 0.0 && radius <= kMaxLength) return;  // false for NaN
  std::ostringstream message;
  message << "radius of a cursor " << radius << " m: must be from 0 to " << kMaxLength << " m";
  throw std::invalid_argument(message.str());
}

}  // namespace

void requirePlace(const Eigen::Vector3d& place, const std::string& what) {
  if (isPlace(place)) return;
  std::ostringstream message;
  message << what << " (" << place.x() << ", " << place.y() << ", " << place.z()
          << ") m: must be finite and within " << kMaxLength << " m";
  throw std::invalid_argument(message.str());
}

Cursor::Cursor(std::vector<TaperedCapsule> parts) : parts_(std::move(parts)) {
  if (parts_.empty()) throw std::invalid_argument("a cursor of spheres needs at least one sphere");
  for (const TaperedCapsule& part : parts_) {
    for (const Sphere& sphere : {part.begin, part.end}) {
      requirePlace(sphere.centre, "place of a cursor");
      requireRadius(sphere.radius);
    }
  }
}

Cursor Cursor::point(const Eigen::Vector3d& place) { return spheres({{place, 0.0}}); }

Cursor Cursor::spheres(const std::vector<Sphere>& spheres) {
  std::vector<TaperedCapsule> parts;
  parts.reserve(spheres.size());
  for (const Sphere& sphere : spheres) parts.push_back({sphere, sphere});
  return Cursor(std::move(parts));
}

Cursor Cursor::capsule(const Eigen::Vector3d& begin, const Eigen::Vector3d& end, double radius) {
  return taperedCapsule({begin, radius}, {end, radius});
}

Cursor Cursor::taperedCapsule(const Sphere& begin, const Sphere& end) {
  return Cursor(std::vector<TaperedCapsule>{{begin, end}});
}

}  // namespace haptex::proximity
