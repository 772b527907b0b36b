#include "haptex/nodes/common/transforms.h"

#include <tf2/exceptions.h>

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "haptex/base/quoted.h"
#include "haptex/nodes/common/vector_messages.h"

namespace haptex::nodes {
namespace {

constexpr double kQuaternionTolerance = 1e-3;

}  // namespace

Eigen::Isometry3d fromMessage(const geometry_msgs::Transform& message) {
  const Eigen::Quaterniond rotation(message.rotation.w, message.rotation.x, message.rotation.y,
                                    message.rotation.z);
  return Eigen::Translation3d(fromMessage(message.translation)) * rotation.normalized();
}

Eigen::Isometry3d fromMessage(const geometry_msgs::Pose& message) {
  const Eigen::Vector3d position = fromMessage(message.position);
  const Eigen::Quaterniond rotation(message.orientation.w, message.orientation.x,
                                    message.orientation.y, message.orientation.z);
  if (!position.allFinite()) {
    throw std::invalid_argument("the position is not finite: allowed are finite numbers (m)");
  }
  const double length = rotation.norm();
  if (!std::isfinite(length) || std::abs(length - 1.0) > kQuaternionTolerance) {
    std::ostringstream text;
    text << "the orientation's quaternion has the length " << length << ": allowed is 1";
    throw std::invalid_argument(text.str());
  }
  return Eigen::Translation3d(position) * rotation.normalized();
}

geometry_msgs::Transform transformMessage(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond rotation(pose.linear());
  geometry_msgs::Transform message;
  message.translation = vectorMessage(pose.translation());
  message.rotation.w = rotation.w();
  message.rotation.x = rotation.x();
  message.rotation.y = rotation.y();
  message.rotation.z = rotation.z();
  return message;
}

geometry_msgs::Pose poseMessage(const Eigen::Isometry3d& pose) {
  geometry_msgs::Pose message;
  message.position = pointMessage(pose.translation());
  message.orientation = transformMessage(pose).rotation;
  return message;
}

Eigen::Isometry3d transformFrom(const std_msgs::Header& header, const std::string& target,
                                const tf2_ros::Buffer& transforms) {
  const std::string what = "header.frame_id = " + base::quoted(header.frame_id);
  if (header.frame_id.empty()) {
    throw std::invalid_argument(what + ": name the frame of the points, '" + target +
                                "' or one that tf connects with it");
  }
  try {
    return fromMessage(transforms.lookupTransform(target, header.frame_id, header.stamp).transform);
  } catch (const tf2::ExtrapolationException& error) {
    throw std::invalid_argument(what + ": tf has no transform to '" + target +
                                "' at the time header.stamp; stamp 0 takes the latest, and a later "
                                "one can be asked for again when it is there (" +
                                base::shortened(error.what()) + ")");
  } catch (const tf2::TransformException& error) {
    throw std::invalid_argument(what + ": tf does not connect it with '" + target +
                                "'; publish that transform, or give the points in '" + target +
                                "' (" + base::shortened(error.what()) + ")");
  }
}

}  // namespace haptex::nodes
