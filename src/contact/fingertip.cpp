#include "haptex/contact/fingertip.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace haptex::contact {
namespace {

constexpr double kLargestRadius = 0.1;                // m
constexpr double kLargestQuaternionDeviation = 1e-3;  // of the norm from 1

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream message;
  message << "fingertip: ";
  (message << ... << parts);
  throw std::invalid_argument(message.str());
}

void requireFinite(const char* name, const Eigen::Vector3d& vector) {
  if (!vector.allFinite()) refuse(name, " (", vector.transpose(), ") must be finite");
}

}  // namespace

Fingertip predict(const Fingertip& fingertip, double seconds) {
  Fingertip predicted = fingertip;
  predicted.position += seconds * fingertip.velocity;
  const double speed = fingertip.angular_velocity.norm();
  if (speed > 0.0) {
    const Eigen::AngleAxisd turn(speed * seconds, fingertip.angular_velocity / speed);
    predicted.orientation = (turn * fingertip.orientation).normalized();
  }
  return predicted;
}

void requireSound(const Fingertip& fingertip) {
  requireFinite("position", fingertip.position);
  requireFinite("velocity", fingertip.velocity);
  requireFinite("angular velocity", fingertip.angular_velocity);
  const double norm = fingertip.orientation.norm();
  if (!(std::abs(norm - 1.0) <= kLargestQuaternionDeviation)) {  // NaN too
    refuse("orientation has the norm ", norm, ", it must be 1 to ", kLargestQuaternionDeviation);
  }
  if (!std::isfinite(fingertip.radius) || fingertip.radius <= 0.0 ||
      fingertip.radius > kLargestRadius) {
    refuse("radius ", fingertip.radius, " must be > 0 and <= ", kLargestRadius, " m");
  }
}

}  // namespace haptex::contact
