#include "haptex/exoskeleton/emulator/emulated_linkage.h"

#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "haptex/base/quoted.h"

namespace haptex::exoskeleton {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d toEigen(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Isometry3d toEigen(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  return Eigen::Translation3d(toEigen(pose.position)) * Eigen::Quaterniond(r.w, r.x, r.y, r.z);
}

// Several rigid bodies as one.
struct Lump {
  double mass = 0.0;
  Vector3d moment = Vector3d::Zero();   // kg m, mass times place
  Matrix3d inertia = Matrix3d::Zero();  // kg m^2, about the origin

  void add(double added_mass, const Vector3d& centre, const Matrix3d& inertia_about_centre) {
    mass += added_mass;
    moment += added_mass * centre;
    inertia += inertia_about_centre + atDistance(added_mass, centre);
  }
  // The parallel axis theorem.
  static Matrix3d atDistance(double mass, const Vector3d& centre) {
    return mass * (centre.squaredNorm() * Matrix3d::Identity() - centre * centre.transpose());
  }
};

// The link, with its frame at `pose`, and everything that is fixed to it.
void addRigidly(const urdf::Link& link, const Isometry3d& pose, Lump& lump) {
  if (link.inertial) {
    const urdf::Inertial& body = *link.inertial;
    Matrix3d inertia;
    inertia << body.ixx, body.ixy, body.ixz, body.ixy, body.iyy, body.iyz, body.ixz, body.iyz,
        body.izz;
    const Isometry3d centre = pose * toEigen(body.origin);
    lump.add(body.mass, centre.translation(),
             centre.linear() * inertia * centre.linear().transpose());
  }
  for (const urdf::LinkSharedPtr& child : link.child_links) {
    const urdf::Joint& joint = *child->parent_joint;
    if (joint.type != urdf::Joint::FIXED) continue;
    addRigidly(*child, pose * toEigen(joint.parent_to_joint_origin_transform), lump);
  }
}

// The joints from hand_base to the tip.
std::vector<urdf::JointConstSharedPtr> jointsToTip(const urdf::ModelInterface& model,
                                                   const std::string& finger) {
  urdf::LinkConstSharedPtr link = model.getLink(finger + "_tip");
  if (!link) throw std::invalid_argument(finger + ": the URDF has no link " + finger + "_tip");
  std::vector<urdf::JointConstSharedPtr> joints;
  while (link->name != "hand_base") {
    if (!link->parent_joint) {
      throw std::invalid_argument(finger + ": hand_base is no ancestor of " + finger + "_tip");
    }
    joints.push_back(link->parent_joint);
    link = link->getParent();
  }
  std::reverse(joints.begin(), joints.end());
  return joints;
}

}  // namespace

EmulatedLinkage::EmulatedLinkage(const std::string& urdf, Finger finger) {
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(urdf);
  if (!model) throw std::invalid_argument(std::string(name(finger)) + ": the URDF is not valid");
  std::size_t count = 0;
  Isometry3d since_joint = Isometry3d::Identity();
  for (const urdf::JointConstSharedPtr& joint : jointsToTip(*model, name(finger))) {
    since_joint = since_joint * toEigen(joint->parent_to_joint_origin_transform);
    if (joint->type == urdf::Joint::FIXED) continue;
    if (joint->type != urdf::Joint::REVOLUTE || count == bodies_.size()) {
      throw std::invalid_argument(std::string(name(finger)) + ": joint " +
                                  base::shortened(joint->name) +
                                  ": the chain must have four revolute joints");
    }
    Body& body = bodies_[count++];
    body.origin = since_joint;
    body.axis = toEigen(joint->axis).normalized();
    since_joint.setIdentity();
    Lump lump;
    addRigidly(*model->getLink(joint->child_link_name), Isometry3d::Identity(), lump);
    if (!(lump.mass > 0.0)) {
      throw std::invalid_argument(std::string(name(finger)) + ": link " +
                                  base::shortened(joint->child_link_name) + ": needs a mass > 0");
    }
    body.mass = lump.mass;
    body.centre = lump.moment / lump.mass;
    body.inertia = lump.inertia - Lump::atDistance(body.mass, body.centre);
  }
  if (count != bodies_.size()) {
    throw std::invalid_argument(std::string(name(finger)) +
                                ": the chain must have four revolute joints");
  }
  tip_in_last_body_ = since_joint;
  setAngles(JointVector::Zero());
}

void EmulatedLinkage::setAngles(const JointVector& joint_angles) {
  Isometry3d pose = Isometry3d::Identity();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    pose = pose * body.origin;
    pose.rotate(Eigen::AngleAxisd(joint_angles[static_cast<int>(i)], body.axis));
    const Matrix3d rotation = pose.linear();
    placed_[i] = {rotation * body.axis, pose.translation(), pose * body.centre,
                  rotation * body.inertia * rotation.transpose()};
  }
  tip_ = pose * tip_in_last_body_;
}

TipJacobian EmulatedLinkage::tipJacobian() const {
  TipJacobian jacobian;
  for (int i = 0; i < kJoints; ++i) {
    jacobian.col(i) = placed_[i].axis.cross(tip_.translation() - placed_[i].joint);
  }
  return jacobian;
}

JointMatrix EmulatedLinkage::massMatrix() const {
  JointMatrix masses;
  Lump behind;
  for (int j = kJoints - 1; j >= 0; --j) {
    behind.add(bodies_[j].mass, placed_[j].centre, placed_[j].inertia);
    // Momentum of what is behind joint j, per its angular velocity, as it turns alone.
    const Vector3d& turning = placed_[j].axis;
    const Vector3d moving = placed_[j].joint.cross(turning);  // of the point at the origin
    const Vector3d linear = behind.mass * moving + turning.cross(behind.moment);
    const Vector3d angular = behind.inertia * turning + behind.moment.cross(moving);
    for (int i = 0; i <= j; ++i) {
      const Vector3d& axis = placed_[i].axis;
      masses(i, j) = masses(j, i) = axis.dot(angular) + placed_[i].joint.cross(axis).dot(linear);
    }
  }
  return masses;
}

JointVector EmulatedLinkage::biasTorques(const JointVector& velocities,
                                         const Vector3d& gravity) const {
  std::array<Vector3d, kJoints> forces, moments;
  Vector3d turning = Vector3d::Zero(), turning_change = Vector3d::Zero();  // of the body before
  Vector3d acceleration = -gravity;                                        // of the joint
  Vector3d joint = Vector3d::Zero();
  for (int i = 0; i < kJoints; ++i) {
    const Placed& body = placed_[i];
    const Vector3d arm = body.joint - joint;
    acceleration += turning_change.cross(arm) + turning.cross(turning.cross(arm));
    joint = body.joint;
    const Vector3d added = velocities[i] * body.axis;
    turning_change += turning.cross(added);
    turning += added;
    const Vector3d to_centre = body.centre - joint;
    forces[i] = bodies_[i].mass * (acceleration + turning_change.cross(to_centre) +
                                   turning.cross(turning.cross(to_centre)));
    moments[i] = body.inertia * turning_change + turning.cross(body.inertia * turning);
  }
  JointVector torques;
  Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();  // about the origin
  for (int i = kJoints - 1; i >= 0; --i) {
    force += forces[i];
    moment += moments[i] + placed_[i].centre.cross(forces[i]);
    torques[i] = placed_[i].axis.dot(moment - placed_[i].joint.cross(force));
  }
  return torques;
}

double EmulatedLinkage::potentialEnergy(const Vector3d& gravity) const {
  double energy = 0.0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    energy -= bodies_[i].mass * gravity.dot(placed_[i].centre);
  }
  return energy;
}

}  // namespace haptex::exoskeleton
