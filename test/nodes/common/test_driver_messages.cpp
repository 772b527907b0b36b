#include <gtest/gtest.h>

#include <set>
#include <string>

#include "../exoskeleton/shipped_urdf.h"
#include "haptex/nodes/common/driver_messages.h"

namespace haptex::nodes::test_driver_messages {
namespace {

using base::Finger;
using base::kFingers;
using base::PerFinger;
using exoskeleton::FingerKinematics;
using exoskeleton::FingerMeasurement;
using exoskeleton::JointVector;

const ros::Time kStamp(1234, 5678);

FingerMeasurement measurement() {
  FingerMeasurement measured;
  measured.joint_angles << 0.1, 0.2, 0.3, 0.4;
  measured.joint_velocities << 1.1, 1.2, 1.3, 1.4;
  measured.pose =
      Eigen::Translation3d(0.01, 0.02, 0.03) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX());
  measured.velocity = {0.4, 0.5, 0.6};
  measured.force = {1.0, -2.0, 3.0};
  return measured;
}

PerFinger<FingerKinematics> kinematics() {
  return {{FingerKinematics(exoskeleton::shippedUrdf(), Finger::kIndex),
           FingerKinematics(exoskeleton::shippedUrdf(), Finger::kThumb)}};
}

template <typename Message>
void expectInHandBase(const Message& message) {
  EXPECT_EQ(message.header.stamp, kStamp);
  EXPECT_EQ(message.header.frame_id, "hand_base");
}

TEST(DriverMessages, PoseOfAFingertip) {
  const geometry_msgs::PoseStamped message = poseMessage(measurement(), kStamp);
  expectInHandBase(message);
  EXPECT_EQ(message.pose.position.x, 0.01);
  EXPECT_EQ(message.pose.position.y, 0.02);
  EXPECT_EQ(message.pose.position.z, 0.03);
  EXPECT_NEAR(message.pose.orientation.w, std::cos(0.25), 1e-15);
  EXPECT_NEAR(message.pose.orientation.x, std::sin(0.25), 1e-15);
  EXPECT_NEAR(message.pose.orientation.y, 0.0, 1e-15);
  EXPECT_NEAR(message.pose.orientation.z, 0.0, 1e-15);
}

TEST(DriverMessages, TwistOfAFingertip) {
  const geometry_msgs::TwistStamped message = twistMessage(measurement(), {0.7, 0.8, 0.9}, kStamp);
  expectInHandBase(message);
  EXPECT_EQ(message.twist.linear.x, 0.4);
  EXPECT_EQ(message.twist.linear.y, 0.5);
  EXPECT_EQ(message.twist.linear.z, 0.6);
  EXPECT_EQ(message.twist.angular.x, 0.7);
  EXPECT_EQ(message.twist.angular.y, 0.8);
  EXPECT_EQ(message.twist.angular.z, 0.9);
}

TEST(DriverMessages, ForceOnAFingertip) {
  const geometry_msgs::WrenchStamped message = wrenchMessage(measurement(), kStamp);
  expectInHandBase(message);
  EXPECT_EQ(message.wrench.force.x, 1.0);
  EXPECT_EQ(message.wrench.force.y, -2.0);
  EXPECT_EQ(message.wrench.force.z, 3.0);
  EXPECT_EQ(message.wrench.torque.x, 0.0);
  EXPECT_EQ(message.wrench.torque.y, 0.0);
  EXPECT_EQ(message.wrench.torque.z, 0.0);
}

TEST(DriverMessages, StatesOfAllJointsOfTheUrdf) {
  PerFinger<FingerMeasurement> measured{{measurement(), measurement()}};
  measured[Finger::kThumb].joint_angles *= -1.0;
  const sensor_msgs::JointState message = jointStateMessage(kinematics(), measured, kStamp);
  expectInHandBase(message);
  ASSERT_EQ(message.name.size(), 8u);
  ASSERT_EQ(message.position.size(), 8u);
  ASSERT_EQ(message.velocity.size(), 8u);
  EXPECT_TRUE(message.effort.empty());
  EXPECT_EQ(std::set<std::string>(message.name.begin(), message.name.end()).size(), 8u);
  for (const std::string& name : message.name) {
    EXPECT_NE(exoskeleton::shippedUrdf().find("<joint name=\"" + name + "\""), std::string::npos);
  }
  EXPECT_EQ(message.name[3].find("index"), 0u);
  EXPECT_EQ(message.position[3], 0.4);
  EXPECT_EQ(message.velocity[3], 1.4);
  EXPECT_EQ(message.name[4].find("thumb"), 0u);
  EXPECT_EQ(message.position[4], -0.1);
  EXPECT_EQ(message.velocity[4], 1.1);
}

TEST(DriverMessages, OperatingStateInTheWordsOfCrtk) {
  exoskeleton::OperatingState state;
  haptex::OperatingState message = operatingStateMessage(state, "", kStamp);
  expectInHandBase(message);
  EXPECT_EQ(message.state, "DISABLED");
  EXPECT_FALSE(message.is_homed);
  EXPECT_FALSE(message.is_busy);
  EXPECT_EQ(message.fault, "");
  state.mode = exoskeleton::Mode::kFault;
  state.is_homed = true;
  message = operatingStateMessage(state, "the line is gone", kStamp);
  EXPECT_EQ(message.state, "FAULT");
  EXPECT_TRUE(message.is_homed);
  EXPECT_FALSE(message.is_busy);
  EXPECT_EQ(message.fault, "the line is gone");
  state.is_homed = false;
  state.is_busy = true;
  EXPECT_TRUE(operatingStateMessage(state, "", kStamp).is_busy);
  EXPECT_FALSE(operatingStateMessage(state, "", kStamp).is_homed);
}

// The central difference is off by 1e-4^2 / 6 and less of the velocity.
constexpr double kTolerance = 1e-8;

TEST(AngularVelocity, OfAFingerThatOnlyBendsIsTheSumOfItsJoints) {
  FingerKinematics index(exoskeleton::shippedUrdf(), Finger::kIndex);
  const JointVector angles(0.0, 0.3, 0.6, 0.4);  // no abduction: all axes are y
  const JointVector velocities(0.0, 2.0, -0.5, 0.25);
  const Eigen::Vector3d exact(0.0, 2.0 - 0.5 + 0.25, 0.0);
  EXPECT_LT((angularVelocity(index, angles, velocities) - exact).norm(), kTolerance * 2.75);
}

TEST(AngularVelocity, IsTheSumOfThoseOfTheJointsEachAsFastAsItsJoint) {
  PerFinger<FingerKinematics> fingers = kinematics();
  const JointVector angles(0.1, 0.3, 0.6, 0.4);
  const JointVector velocities(-1.5, 2.0, 3.0, 2.5);
  for (const Finger finger : kFingers) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int i = 0; i < exoskeleton::kJoints; ++i) {
      const Eigen::Vector3d one =
          angularVelocity(fingers[finger], angles, velocities[i] * JointVector::Unit(i));
      EXPECT_NEAR(one.norm(), std::abs(velocities[i]), kTolerance * 10.0);
      sum += one;
    }
    const Eigen::Vector3d all = angularVelocity(fingers[finger], angles, velocities);
    EXPECT_LT((all - sum).norm(), kTolerance * 10.0);
  }
}

TEST(AngularVelocity, OfAFingerThatRestsIsZero) {
  FingerKinematics index(exoskeleton::shippedUrdf(), Finger::kIndex);
  for (const double velocity : {0.0, 1e-310, 1e-12}) {
    EXPECT_EQ(angularVelocity(index, JointVector::Constant(0.2), velocity * JointVector::Ones()),
              Eigen::Vector3d::Zero());
  }
}

TEST(AngularVelocity, OfAHardlyMovingFingerIsAsExact) {
  FingerKinematics index(exoskeleton::shippedUrdf(), Finger::kIndex);
  const JointVector angles(0.0, 0.3, 0.6, 0.4);
  const JointVector velocities(0.0, 1e-6, 0.0, 0.0);
  EXPECT_LT((angularVelocity(index, angles, velocities) - Eigen::Vector3d(0.0, 1e-6, 0.0)).norm(),
            kTolerance * 1e-6);
}

}  // namespace
}  // namespace haptex::nodes::test_driver_messages
