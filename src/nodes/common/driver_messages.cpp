#include "haptex/nodes/common/driver_messages.h"

#include <Eigen/Geometry>

#include "haptex/nodes/common/transforms.h"
#include "haptex/nodes/common/vector_messages.h"
#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes {
namespace {

using exoskeleton::FingerMeasurement;
using exoskeleton::JointVector;

std_msgs::Header header(const ros::Time& stamp) {
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = handFrame();
  return header;
}

}  // namespace

geometry_msgs::PoseStamped poseMessage(const FingerMeasurement& measured, const ros::Time& stamp) {
  geometry_msgs::PoseStamped message;
  message.header = header(stamp);
  message.pose = poseMessage(measured.pose);
  return message;
}

geometry_msgs::TwistStamped twistMessage(const FingerMeasurement& measured,
                                         const Eigen::Vector3d& angular_velocity,
                                         const ros::Time& stamp) {
  geometry_msgs::TwistStamped message;
  message.header = header(stamp);
  message.twist.linear = vectorMessage(measured.velocity);
  message.twist.angular = vectorMessage(angular_velocity);
  return message;
}

geometry_msgs::WrenchStamped wrenchMessage(const FingerMeasurement& measured,
                                           const ros::Time& stamp) {
  geometry_msgs::WrenchStamped message;
  message.header = header(stamp);
  message.wrench.force = vectorMessage(measured.force);
  return message;
}

sensor_msgs::JointState jointStateMessage(
    const base::PerFinger<exoskeleton::FingerKinematics>& kinematics,
    const base::PerFinger<FingerMeasurement>& measured, const ros::Time& stamp) {
  sensor_msgs::JointState message;
  message.header = header(stamp);
  for (const base::Finger finger : base::kFingers) {
    const auto& names = kinematics[finger].jointNames();
    const FingerMeasurement& of = measured[finger];
    message.name.insert(message.name.end(), names.begin(), names.end());
    message.position.insert(message.position.end(), of.joint_angles.begin(), of.joint_angles.end());
    message.velocity.insert(message.velocity.end(), of.joint_velocities.begin(),
                            of.joint_velocities.end());
  }
  return message;
}

void fillFingertips(base::PerFinger<exoskeleton::FingerKinematics>& kinematics,
                    const base::PerFinger<FingerMeasurement>& measured, const ros::Time& stamp,
                    haptex::Fingertips& message) {
  message.header.stamp = stamp;
  if (message.header.frame_id != handFrame()) message.header.frame_id = handFrame();
  for (const base::Finger finger : base::kFingers) {
    const FingerMeasurement& of = measured[finger];
    const auto i = static_cast<std::size_t>(finger);
    message.poses[i] = poseMessage(of.pose);
    message.twists[i].linear = vectorMessage(of.velocity);
    message.twists[i].angular =
        vectorMessage(angularVelocity(kinematics[finger], of.joint_angles, of.joint_velocities));
  }
}

haptex::OperatingState operatingStateMessage(const exoskeleton::OperatingState& state,
                                             const std::string& fault, const ros::Time& stamp) {
  haptex::OperatingState message;
  message.header = header(stamp);
  message.state = exoskeleton::name(state.mode);
  message.is_homed = state.is_homed;
  message.is_busy = state.is_busy;
  message.fault = fault;
  return message;
}

Eigen::Vector3d angularVelocity(exoskeleton::FingerKinematics& kinematics,
                                const JointVector& joint_angles,
                                const JointVector& joint_velocities) {
  // Central difference of the orientation. Its error grows with the square of the step's angle
  // (rad, sum over the joints) and its rounding with one over it: at 1e-4 both are about 1e-9 of
  // the velocity or below 1e-11 rad/s.
  constexpr double kAngle = 1e-4;
  const double speed = joint_velocities.cwiseAbs().sum();
  constexpr double kRest = 1e-9;  // rad/s; a filter's velocity comes to rest without ever being 0
  if (!(speed > kRest)) return Eigen::Vector3d::Zero();
  const double step = kAngle / speed;
  const Eigen::Matrix3d before =
      kinematics.fingertip(joint_angles - step * joint_velocities).linear();
  const Eigen::Matrix3d after =
      kinematics.fingertip(joint_angles + step * joint_velocities).linear();
  const Eigen::Matrix3d turn = after * before.transpose();
  // Of a small turn the skew-symmetric part is axis times angle, to the third power of the angle.
  const Eigen::Vector3d axis(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0),
                             turn(1, 0) - turn(0, 1));
  return 0.5 * axis / (2.0 * step);
}

}  // namespace haptex::nodes
