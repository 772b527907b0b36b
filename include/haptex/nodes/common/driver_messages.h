// Conversions from what the exoskeleton's driver measured to messages.
#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <haptex/Fingertips.h>
#include <haptex/OperatingState.h>
#include <ros/time.h>
#include <sensor_msgs/JointState.h>

#include <Eigen/Core>
#include <string>

#include "haptex/base/finger.h"
#include "haptex/exoskeleton/control/device_controller.h"
#include "haptex/exoskeleton/control/finger_kinematics.h"

namespace haptex::nodes {

/// Pose of <finger>_tip (m).
geometry_msgs::PoseStamped poseMessage(const exoskeleton::FingerMeasurement& measured,
                                       const ros::Time& stamp);

/// Velocity of <finger>_tip (m/s, rad/s), by the axes of hand_base.
geometry_msgs::TwistStamped twistMessage(const exoskeleton::FingerMeasurement& measured,
                                         const Eigen::Vector3d& angular_velocity,
                                         const ros::Time& stamp);

/// Force by the device on the person's fingertip (N) at <finger>_tip, by the axes of hand_base. The
/// sensor has three components: the torque is zero.
geometry_msgs::WrenchStamped wrenchMessage(const exoskeleton::FingerMeasurement& measured,
                                           const ros::Time& stamp);

/// All joints of both fingers (rad, rad/s), coupled ones too, from the palm to the tip. No effort.
sensor_msgs::JointState jointStateMessage(
    const base::PerFinger<exoskeleton::FingerKinematics>& kinematics,
    const base::PerFinger<exoskeleton::FingerMeasurement>& measured, const ros::Time& stamp);

haptex::OperatingState operatingStateMessage(const exoskeleton::OperatingState& state,
                                             const std::string& fault, const ros::Time& stamp);

/// Poses and velocities of both fingertips. Allocates nothing if the frame is set already.
void fillFingertips(base::PerFinger<exoskeleton::FingerKinematics>& kinematics,
                    const base::PerFinger<exoskeleton::FingerMeasurement>& measured,
                    const ros::Time& stamp, haptex::Fingertips& message);

/// Angular velocity of <finger>_tip (rad/s) by the axes of hand_base.
Eigen::Vector3d angularVelocity(exoskeleton::FingerKinematics& kinematics,
                                const exoskeleton::JointVector& joint_angles,
                                const exoskeleton::JointVector& joint_velocities);

}  // namespace haptex::nodes
