#include "haptex/exoskeleton/control/finger_kinematics.h"

#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/SVD>
#include <cmath>
#include <kdl/chain.hpp>
#include <kdl/chaindynparam.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <kdl/jacobian.hpp>
#include <kdl/jntarray.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "haptex/base/quoted.h"

namespace haptex::exoskeleton {
namespace {

using JointPointer = urdf::JointConstSharedPtr;

/// What a URDF says of a finger.
struct Description {
  KDL::Chain chain;
  std::array<std::string, kJoints> names;
  JointVector lower, upper;
  double multiplier = 0.0;  // of the mimic of the last joint
  double offset = 0.0;      // rad
};

[[noreturn]] void refuse(Finger finger, const std::string& what) {
  throw std::invalid_argument("exoskeleton, " + std::string(name(finger)) + ": " + what);
}

KDL::Vector toKdl(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

KDL::Frame toKdl(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  return {KDL::Rotation::Quaternion(r.x, r.y, r.z, r.w), toKdl(pose.position)};
}

urdf::ModelInterfaceSharedPtr parse(const std::string& urdf, Finger finger) {
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(urdf);
  // Revolute joints without limits and numbers that are not finite end here, too.
  if (!model) refuse(finger, "urdfdom cannot read the URDF; its reason is on standard error");
  return model;
}

/// Joints between hand_base and the tip, from the base on.
std::vector<JointPointer> jointsToTip(const urdf::ModelInterface& model, Finger finger) {
  const std::string tip = std::string(name(finger)) + "_tip";
  if (!model.getLink("hand_base")) refuse(finger, "the URDF has no link hand_base");
  if (!model.getLink(tip)) refuse(finger, "the URDF has no link " + tip);
  std::vector<JointPointer> joints;
  for (auto link = model.getLink(tip); link->name != "hand_base"; link = link->getParent()) {
    if (!link->getParent()) refuse(finger, tip + " does not descend from hand_base");
    joints.insert(joints.begin(), link->parent_joint);
  }
  return joints;
}

void requireLimits(const urdf::Joint& joint, Finger finger) {
  const double lower = joint.limits->lower, upper = joint.limits->upper;
  if (lower >= upper) {
    refuse(finger, "limits of " + base::shortened(joint.name) + " are " + std::to_string(lower) +
                       " to " + std::to_string(upper) + " rad, must increase");
  }
}

void requireMimic(const urdf::Joint& last, const urdf::Joint& before, Finger finger) {
  if (!last.mimic || last.mimic->joint_name != before.name) {
    refuse(finger, base::shortened(last.name) + " does not mimic " + base::shortened(before.name));
  }
}

/// Mass and its centre of a link, whose frame is at `pose`, and of everything that is fixed to it.
KDL::RigidBodyInertia weightOf(const urdf::Link& link, const KDL::Frame& pose, Finger finger) {
  KDL::RigidBodyInertia weight;
  if (link.inertial) {
    if (!(link.inertial->mass >= 0.0)) {
      refuse(finger, "the mass of " + base::shortened(link.name) + " is " +
                         std::to_string(link.inertial->mass) + " kg, must be at least 0");
    }
    weight = KDL::RigidBodyInertia(link.inertial->mass, pose * toKdl(link.inertial->origin).p);
  }
  for (const urdf::LinkSharedPtr& child : link.child_links) {
    const urdf::Joint& joint = *child->parent_joint;
    if (joint.type != urdf::Joint::FIXED) continue;
    weight =
        weight + weightOf(*child, pose * toKdl(joint.parent_to_joint_origin_transform), finger);
  }
  return weight;
}

/// Segment that turns about the joint's axis where the joint is and ends in its child's frame.
KDL::Segment turningSegment(const urdf::Joint& joint, const urdf::Link& child, Finger finger) {
  const KDL::Frame origin = toKdl(joint.parent_to_joint_origin_transform);
  const KDL::Vector axis = toKdl(joint.axis);
  if (axis.Norm() < 1e-9)
    refuse(finger, "the axis of " + base::shortened(joint.name) + " has no direction");
  return KDL::Segment(KDL::Joint(origin.p, origin.M * axis, KDL::Joint::RotAxis), origin,
                      weightOf(child, KDL::Frame::Identity(), finger));
}

void appendJoint(Description& made, const urdf::Joint& joint, const urdf::Link& child, int& turning,
                 Finger finger) {
  if (joint.type == urdf::Joint::FIXED) {
    made.chain.addSegment(
        KDL::Segment(KDL::Joint(KDL::Joint::None), toKdl(joint.parent_to_joint_origin_transform)));
    return;
  }
  if (joint.type != urdf::Joint::REVOLUTE) {
    refuse(finger, base::shortened(joint.name) + " must be revolute or fixed");
  }
  requireLimits(joint, finger);
  if (turning < kJoints) {
    made.chain.addSegment(turningSegment(joint, child, finger));
    made.names[turning] = joint.name;
    made.lower[turning] = joint.limits->lower;
    made.upper[turning] = joint.limits->upper;
  }
  ++turning;
}

Description describe(const std::string& urdf, Finger finger) {
  const urdf::ModelInterfaceSharedPtr model = parse(urdf, finger);
  Description made;
  int turning = 0;
  for (const JointPointer& joint : jointsToTip(*model, finger)) {
    appendJoint(made, *joint, *model->getLink(joint->child_link_name), turning, finger);
  }
  if (turning != kJoints) {
    refuse(finger, "the chain has " + std::to_string(turning) + " revolute joints, must be " +
                       std::to_string(kJoints));
  }
  const auto last = model->getJoint(made.names[kJoints - 1]);
  requireMimic(*last, *model->getJoint(made.names[kJoints - 2]), finger);
  made.multiplier = last->mimic->multiplier;
  made.offset = last->mimic->offset;
  return made;
}

}  // namespace

struct FingerKinematics::Chain {
  explicit Chain(Description from_urdf)
      : description(std::move(from_urdf)),
        to_tip(description.chain),
        to_jacobian(description.chain),
        weights{{{description.chain, {1.0, 0.0, 0.0}},
                 {description.chain, {0.0, 1.0, 0.0}},
                 {description.chain, {0.0, 0.0, 1.0}}}},
        angles(kJoints),
        torques(kJoints),
        jacobian(kJoints) {}

  /// d fingertip / d driven joints (m/rad), the last joint following the one before it.
  Eigen::Matrix3d drivenJacobian(const JointVector& joint_angles) {
    angles.data = joint_angles;
    to_jacobian.JntToJac(angles, jacobian);
    Eigen::Matrix3d driven = jacobian.data.topLeftCorner<3, kMotors>();
    driven.col(kMotors - 1) += description.multiplier * jacobian.data.block<3, 1>(0, kJoints - 1);
    return driven;
  }

  Description description;
  KDL::ChainFkSolverPos_recursive to_tip;
  KDL::ChainJntToJacSolver to_jacobian;
  // The torques are linear in gravity, which KDL takes in its constructor only: one per axis.
  std::array<KDL::ChainDynParam, 3> weights;
  KDL::JntArray angles, torques;
  KDL::Jacobian jacobian;
};

FingerKinematics::FingerKinematics(const std::string& urdf, Finger finger)
    : chain_(std::make_unique<Chain>(describe(urdf, finger))) {}
FingerKinematics::~FingerKinematics() = default;
FingerKinematics::FingerKinematics(FingerKinematics&&) noexcept = default;
FingerKinematics& FingerKinematics::operator=(FingerKinematics&&) noexcept = default;

const std::array<std::string, kJoints>& FingerKinematics::jointNames() const {
  return chain_->description.names;
}
const JointVector& FingerKinematics::lowerLimits() const { return chain_->description.lower; }
const JointVector& FingerKinematics::upperLimits() const { return chain_->description.upper; }

JointVector FingerKinematics::jointAngles(const MotorVector& motor_angles) const {
  JointVector angles;
  angles.head<kMotors>() = motor_angles / kReduction;
  angles[kJoints - 1] =
      chain_->description.multiplier * angles[kMotors - 1] + chain_->description.offset;
  return angles;
}

MotorVector FingerKinematics::motorAngles(const JointVector& joint_angles) const {
  return kReduction * joint_angles.head<kMotors>();
}

Eigen::Isometry3d FingerKinematics::fingertip(const JointVector& joint_angles) {
  chain_->angles.data = joint_angles;
  KDL::Frame tip;
  chain_->to_tip.JntToCart(chain_->angles, tip);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    pose.translation()[row] = tip.p(row);
    for (int column = 0; column < 3; ++column) pose.linear()(row, column) = tip.M(row, column);
  }
  return pose;
}

Eigen::Matrix3d FingerKinematics::motorJacobian(const JointVector& joint_angles) {
  return chain_->drivenJacobian(joint_angles) / kReduction;
}

Eigen::Matrix3d FingerKinematics::motorWeight(const JointVector& joint_angles) {
  Chain& chain = *chain_;
  chain.angles.data = joint_angles;
  Eigen::Matrix3d weight;
  for (int axis = 0; axis < 3; ++axis) {
    chain.weights[static_cast<std::size_t>(axis)].JntToGravity(chain.angles, chain.torques);
    weight.col(axis) = chain.torques.data.head<kMotors>();
    weight(kMotors - 1, axis) += chain.description.multiplier * chain.torques(kJoints - 1);
  }
  return weight / kReduction;
}

Configuration FingerKinematics::configuration(const JointVector& joint_angles) {
  Configuration found;
  for (int i = kJoints - 1; i >= 0; --i) {
    // Not (angle < lower || angle > upper): an angle that is not a number is outside, too.
    const bool inside = joint_angles[i] >= lowerLimits()[i] && joint_angles[i] <= upperLimits()[i];
    if (!inside) found.outside = i;
  }
  found.within_limits = found.outside == -1;
  const Eigen::Matrix3d driven = chain_->drivenJacobian(joint_angles);
  found.smallest_singular_value =
      driven.allFinite() ? Eigen::JacobiSVD<Eigen::Matrix3d>(driven).singularValues()[2] : 0.0;
  found.singular = found.smallest_singular_value < kSingular;
  return found;
}

}  // namespace haptex::exoskeleton
