// Poses of the links of a URDF by composing its transforms, without KDL.
#pragma once

#include <urdf_model/model.h>

#include <Eigen/Geometry>
#include <map>
#include <string>

namespace haptex::exoskeleton {

/// By name (rad). Joints that mimic another one follow it; those not named are at zero.
using JointAngles = std::map<std::string, double>;

inline Eigen::Isometry3d toEigen(const urdf::Pose& pose) {
  double roll, pitch, yaw;
  pose.rotation.getRPY(roll, pitch, yaw);
  return Eigen::Translation3d(pose.position.x, pose.position.y, pose.position.z) *
         Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
}

inline double angle(const urdf::Joint& joint, const JointAngles& angles) {
  const auto own = angles.find(joint.name);
  if (own != angles.end()) return own->second;
  if (!joint.mimic) return 0.0;
  const auto mimicked = angles.find(joint.mimic->joint_name);
  const double before = mimicked == angles.end() ? 0.0 : mimicked->second;
  return joint.mimic->multiplier * before + joint.mimic->offset;
}

/// Pose of a link in the root of the URDF (m).
inline Eigen::Isometry3d pose(const urdf::ModelInterface& model, const std::string& name,
                              const JointAngles& angles) {
  Eigen::Isometry3d made = Eigen::Isometry3d::Identity();
  for (auto link = model.getLink(name); link->parent_joint; link = link->getParent()) {
    const urdf::Joint& joint = *link->parent_joint;
    Eigen::Isometry3d step = toEigen(joint.parent_to_joint_origin_transform);
    if (joint.type != urdf::Joint::FIXED) {
      step = step * Eigen::AngleAxisd(angle(joint, angles),
                                      Eigen::Vector3d(joint.axis.x, joint.axis.y, joint.axis.z));
    }
    made = step * made;
  }
  return made;
}

}  // namespace haptex::exoskeleton
