// Places and vectors as messages.
#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Vector3.h>

#include <Eigen/Core>

namespace haptex::nodes {

/// @tparam Message with x, y and z
template <typename Message>
void fillVector(const Eigen::Vector3d& vector, Message& message) {
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
}

inline geometry_msgs::Point pointMessage(const Eigen::Vector3d& point) {
  geometry_msgs::Point message;
  fillVector(point, message);
  return message;
}

inline geometry_msgs::Vector3 vectorMessage(const Eigen::Vector3d& vector) {
  geometry_msgs::Vector3 message;
  fillVector(vector, message);
  return message;
}

}  // namespace haptex::nodes
