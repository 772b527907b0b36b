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

inline Eigen::Vector3d fromMessage(const geometry_msgs::Point& point) {
  return {point.x, point.y, point.z};
}

inline Eigen::Vector3d fromMessage(const geometry_msgs::Vector3& vector) {
  return {vector.x, vector.y, vector.z};
}

}  // namespace haptex::nodes
