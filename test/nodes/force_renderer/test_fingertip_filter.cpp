#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "haptex/nodes/force_renderer/fingertip_filter.h"

namespace haptex::nodes::test_fingertip_filter {
namespace {

using base::Time;
using namespace std::chrono_literals;

const ros::Time kNow(1000, 0);
constexpr Time kSteady = 5s;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

geometry_msgs::PoseStamped somePose(double age = 0.0) {
  geometry_msgs::PoseStamped message;
  message.header.frame_id = "hand_base";
  message.header.stamp = kNow - ros::Duration(age);
  message.pose.position.x = 0.1;
  message.pose.orientation.w = 1.0;
  return message;
}

geometry_msgs::TwistStamped someTwist(double age = 0.0) {
  geometry_msgs::TwistStamped message;
  message.header.frame_id = "hand_base";
  message.header.stamp = kNow - ros::Duration(age);
  message.twist.linear.y = 0.2;
  message.twist.angular.z = 0.3;
  return message;
}

TEST(FingertipFilter, TakesWhatTheDriverSends) {
  FingertipFilter filter;
  const auto pose = filter.receive(somePose(), kNow, kSteady);
  const auto twist = filter.receive(someTwist(), kNow, kSteady);
  ASSERT_TRUE(pose && twist);
  EXPECT_EQ(pose->translation(), Eigen::Vector3d(0.1, 0.0, 0.0));
  EXPECT_EQ(twist->velocity, Eigen::Vector3d(0.0, 0.2, 0.0));
  EXPECT_EQ(twist->angular_velocity, Eigen::Vector3d(0.0, 0.0, 0.3));
  EXPECT_EQ(filter.dropped(), 0u);
}

TEST(FingertipFilter, DropsAndCountsBadPosesAndSaysWhy) {
  using Message = geometry_msgs::PoseStamped;
  const std::vector<std::pair<std::string, std::function<void(Message&)>>> flaws = {
      {"frame_id = 'world'", [](Message& m) { m.header.frame_id = "world"; }},
      {"frame_id = ''", [](Message& m) { m.header.frame_id.clear(); }},
      {"position", [](Message& m) { m.pose.position.y = kNaN; }},
      {"position", [](Message& m) { m.pose.position.z = -kInfinity; }},
      {"10 m", [](Message& m) { m.pose.position.z = 11.0; }},
      {"quaternion", [](Message& m) { m.pose.orientation.w = 0.0; }},
      {"quaternion", [](Message& m) { m.pose.orientation.x = kNaN; }},
      {"stamp", [](Message& m) { m.header.stamp = kNow - ros::Duration(0.021); }},
      {"stamp", [](Message& m) { m.header.stamp = kNow + ros::Duration(0.021); }},
      {"stamp", [](Message& m) { m.header.stamp = ros::Time(); }},
  };
  FingertipFilter filter;
  std::uint64_t dropped = 0;
  for (const auto& [why, spoil] : flaws) {
    Message message = somePose();
    spoil(message);
    EXPECT_FALSE(filter.receive(message, kNow, kSteady)) << why;
    EXPECT_EQ(filter.dropped(), ++dropped);
    EXPECT_NE(filter.lastDrop().find(why), std::string::npos) << filter.lastDrop();
    EXPECT_EQ(filter.lastDrop().find("measured_cp: "), 0u) << filter.lastDrop();
  }
  EXPECT_TRUE(filter.receive(somePose(), kNow, kSteady)) << "a bad one does not spoil the next";
}

TEST(FingertipFilter, DropsAndCountsBadVelocities) {
  using Message = geometry_msgs::TwistStamped;
  const std::vector<std::pair<std::string, std::function<void(Message&)>>> flaws = {
      {"frame_id", [](Message& m) { m.header.frame_id = "index_tip"; }},
      {"the velocity", [](Message& m) { m.twist.linear.x = kNaN; }},
      {"the velocity", [](Message& m) { m.twist.linear.x = 101.0; }},
      {"the angular velocity", [](Message& m) { m.twist.angular.y = kInfinity; }},
      {"the angular velocity", [](Message& m) { m.twist.angular.y = -1001.0; }},
  };
  FingertipFilter filter;
  for (const auto& [why, spoil] : flaws) {
    Message message = someTwist();
    spoil(message);
    EXPECT_FALSE(filter.receive(message, kNow, kSteady)) << why;
    EXPECT_NE(filter.lastDrop().find(why), std::string::npos) << filter.lastDrop();
  }
  EXPECT_EQ(filter.dropped(), flaws.size());
}

TEST(FingertipFilter, DropsWhatIsNotLaterThanTheLast) {
  FingertipFilter filter;
  ASSERT_TRUE(filter.receive(somePose(0.005), kNow, kSteady));
  EXPECT_FALSE(filter.receive(somePose(0.005), kNow, kSteady));
  EXPECT_FALSE(filter.receive(somePose(0.010), kNow, kSteady));
  EXPECT_TRUE(filter.receive(someTwist(0.010), kNow, kSteady)) << "each kind by itself";
  EXPECT_TRUE(filter.receive(somePose(0.004), kNow, kSteady));
}

TEST(FingertipFilter, BelievesADriverThatWasStartedAnew) {
  FingertipFilter filter;
  ASSERT_TRUE(filter.receive(somePose(0.0), kNow, kSteady));
  EXPECT_FALSE(filter.receive(somePose(0.010), kNow, kSteady + 99ms));
  EXPECT_TRUE(filter.receive(somePose(0.010), kNow, kSteady + 101ms));
}

}  // namespace
}  // namespace haptex::nodes::test_fingertip_filter
