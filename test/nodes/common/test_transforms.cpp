#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "haptex/nodes/common/transforms.h"

namespace haptex::nodes::test_transforms {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Eigen::Isometry3d somePose() {
  Eigen::Isometry3d pose(Eigen::AngleAxisd(2.5, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()));
  pose.translation() = Eigen::Vector3d(0.1, -0.2, 0.3);
  return pose;
}

/// `frame` at somePose() in world, at 10 s and 11 s.
void fill(tf2_ros::Buffer& transforms, const std::string& frame) {
  geometry_msgs::TransformStamped message;
  message.header.frame_id = "world";
  message.child_frame_id = frame;
  message.transform = transformMessage(somePose());
  for (const double time : {10.0, 11.0}) {
    message.header.stamp = ros::Time(time);
    transforms.setTransform(message, "test");
  }
}

std_msgs::Header header(const std::string& frame, double stamp) {
  std_msgs::Header header;
  header.frame_id = frame;
  header.stamp = ros::Time(stamp);
  return header;
}

void expectRefused(const std_msgs::Header& header, const std::string& says) {
  tf2_ros::Buffer transforms;
  fill(transforms, "hand_base");
  try {
    transformFrom(header, "world", transforms);
    FAIL() << "took the frame '" << header.frame_id << "'";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("'" + header.frame_id + "'"), std::string::npos);
  }
}

TEST(Transforms, PosesComeBackFromTheirMessages) {
  EXPECT_TRUE(fromMessage(poseMessage(somePose())).isApprox(somePose(), 1e-14));
  EXPECT_TRUE(fromMessage(transformMessage(somePose())).isApprox(somePose(), 1e-14));
}

TEST(Transforms, RefusesPosesWithoutAPosition) {
  for (double geometry_msgs::Point::*coordinate :
       {&geometry_msgs::Point::x, &geometry_msgs::Point::y, &geometry_msgs::Point::z}) {
    geometry_msgs::Pose message = poseMessage(somePose());
    message.position.*coordinate = kNaN;
    EXPECT_THROW(fromMessage(message), std::invalid_argument);
  }
}

TEST(Transforms, RefusesQuaternionsThatAreNoRotation) {
  geometry_msgs::Pose message;  // all zero, as rostopic pub leaves it
  EXPECT_THROW(fromMessage(message), std::invalid_argument);
  message.orientation.w = kNaN;
  EXPECT_THROW(fromMessage(message), std::invalid_argument);
  message.orientation.w = 1.01;
  EXPECT_THROW(fromMessage(message), std::invalid_argument);
  message.orientation.w = 1.0001;  // printed with few digits
  EXPECT_TRUE(fromMessage(message).isApprox(Eigen::Isometry3d::Identity(), 1e-14));
}

TEST(Transforms, TakesFramesThatTfConnects) {
  tf2_ros::Buffer transforms;
  fill(transforms, "hand_base");
  for (const double stamp : {0.0, 10.5}) {
    EXPECT_TRUE(
        transformFrom(header("hand_base", stamp), "world", transforms).isApprox(somePose(), 1e-12));
  }
}

TEST(Transforms, RefusesFramesThatTfDoesNotConnect) {
  expectRefused(header("", 0.0), "name the frame");
  expectRefused(header("moon", 0.0), "tf does not connect it with 'world'");
}

TEST(Transforms, RefusesTimesThatTfDoesNotKnow) {
  expectRefused(header("hand_base", 9.0), "at the time header.stamp");
  expectRefused(header("hand_base", 12.0), "at the time header.stamp");
}

}  // namespace
}  // namespace haptex::nodes::test_transforms
