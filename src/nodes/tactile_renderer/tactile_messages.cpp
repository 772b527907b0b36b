#include "haptex/nodes/tactile_renderer/tactile_messages.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes {
namespace {

constexpr double kMicrometres = 1e6;  // per metre

/// @param index of the element, -1 if the field is no array
void require(bool allowed, const char* field, int index, double value, const char* what,
             double largest, const char* unit) {
  if (allowed) return;
  std::ostringstream text;
  text << field;
  if (index >= 0) text << "[" << index << "]";
  text << " = " << value << ": allowed are " << what << " up to " << largest << unit;
  throw std::invalid_argument(text.str());
}

/// NaN compares false.
template <typename Array>
void requireWithin(const char* field, const Array& values, double largest, const char* unit) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    require(std::abs(values[i]) <= largest, field, static_cast<int>(i), values[i], "finite numbers",
            largest, unit);
  }
}

void requirePress(const char* field, int index, double force) {
  require(force >= 0.0 && force <= kMaxPress, field, index, force, "numbers >= 0", kMaxPress, " N");
}

void requireSound(const haptex::Contact& message) {
  requireFixedFrame(message.header);
  requireWithin("fabric_velocity", message.fabric_velocity, kFastestStroke, " m/s");
  requireWithin("fabric_position", message.fabric_position, kFarthestPlace, " m");
  requireWithin("array_origin", message.array_origin, kFarthestPlace, " m");
  requireWithin("array_x", message.array_x, kMaxStretch, "");
  requireWithin("array_y", message.array_y, kMaxStretch, "");
  requirePress("normal_force", -1, message.normal_force);
  for (int i = 0; i < tactile::kContactors; ++i) {
    requirePress("contactor_forces", i, message.contactor_forces[i]);
  }
}

template <typename Array>
Eigen::Vector2d vector(const Array& pair) {
  return {pair[0], pair[1]};
}

tactile::ArrayPlacement placement(const haptex::Contact& message) {
  tactile::ArrayPlacement placement;
  placement.origin = vector(message.array_origin);
  placement.axes << vector(message.array_x), vector(message.array_y);
  if (!placement.axes.isZero(0.0)) return placement;
  return {vector(message.fabric_position), Eigen::Matrix2d::Identity()};
}

}  // namespace

std::optional<tactile::TouchedFabric> touchedFabric(const haptex::Contact& message) {
  requireSound(message);
  if (!message.touching) return std::nullopt;
  tactile::TouchedFabric touched;
  touched.stroke = {vector(message.fabric_velocity), message.normal_force};
  touched.placement = placement(message);
  for (int i = 0; i < tactile::kContactors; ++i) touched.forces[i] = message.contactor_forces[i];
  return touched;
}

haptex::Tactile tactileMessage(base::Finger finger) {
  haptex::Tactile message;
  message.header.frame_id = arrayFrame(finger);
  for (int i = 0; i < tactile::kContactors; ++i) {
    const Eigen::Vector2d place = tactile::contactorPlace(i);
    message.places[i].x = place.x();
    message.places[i].y = place.y();
  }
  return message;
}

void fillTactile(const tactile::TouchedFabric* touched, const tactile::ArrayAmplitudes& amplitudes,
                 double step_time, const ros::Time& stamp, haptex::Tactile& message) {
  message.header.stamp = stamp;
  message.step_time = step_time;
  const tactile::Stroke stroke = touched ? touched->stroke : tactile::Stroke();
  message.velocity = {stroke.velocity.x(), stroke.velocity.y()};
  message.normal_force = stroke.normal_force;
  for (int i = 0; i < tactile::kContactors; ++i) {
    message.amplitudes_40[i] = kMicrometres * amplitudes[i][tactile::k40];
    message.amplitudes_320[i] = kMicrometres * amplitudes[i][tactile::k320];
    const Eigen::Vector2d place =
        touched ? touched->placement.placeOf(i) : Eigen::Vector2d(Eigen::Vector2d::Zero());
    message.weft[i] = place.x();
    message.warp[i] = place.y();
  }
}

}  // namespace haptex::nodes
