#include "haptex/contact/fingertip.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace haptex::contact {
namespace {

constexpr double kMaxRadius = 0.1;                // m
constexpr double kMaxQuaternionDeviation = 1e-3;  // of the norm from 1

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream message;
  message << "fingertip: ";
  (message << ... << parts);
  throw std::invalid_argument(message.str());
}

bool isUnit(const Eigen::Quaterniond& orientation) {  // false for NaN too
  return std::abs(orientation.norm() - 1.0) <= kMaxQuaternionDeviation;
}

bool isInRange(double radius) { return radius > 0.0 && radius <= kMaxRadius; }

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
  if (!isUnit(fingertip.orientation)) {
    refuse("orientation has the norm ", fingertip.orientation.norm(), ", it must be 1 to ",
           kMaxQuaternionDeviation);
  }
  if (!isInRange(fingertip.radius)) {
    refuse("radius ", fingertip.radius, " must be > 0 and <= ", kMaxRadius, " m");
  }
}

bool isSound(const Fingertip& fingertip) {
  return fingertip.position.allFinite() && fingertip.velocity.allFinite() &&
         fingertip.angular_velocity.allFinite() && isUnit(fingertip.orientation) &&
         isInRange(fingertip.radius);
}

}  // namespace haptex::contact
