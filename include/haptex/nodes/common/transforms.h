// Poses between Eigen and messages, and transforms that messages ask for.
#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Transform.h>
#include <std_msgs/Header.h>
#include <tf2_ros/buffer.h>

#include <Eigen/Geometry>
#include <string>

namespace haptex::nodes {

/// The rotation is normalised.
Eigen::Isometry3d fromMessage(const geometry_msgs::Transform& message);

/// @throws std::invalid_argument naming what is not finite, or the quaternion if its length is not
///   1 to within 1e-3
Eigen::Isometry3d fromMessage(const geometry_msgs::Pose& message);

geometry_msgs::Transform transformMessage(const Eigen::Isometry3d& pose);
geometry_msgs::Pose poseMessage(const Eigen::Isometry3d& pose);

/// Transform from the frame of a message to `target`, at its stamp; stamp 0 takes the latest.
/// @throws std::invalid_argument naming the frame, what is wrong with it and what to do
Eigen::Isometry3d transformFrom(const std_msgs::Header& header, const std::string& target,
                                const tf2_ros::Buffer& transforms);

}  // namespace haptex::nodes
