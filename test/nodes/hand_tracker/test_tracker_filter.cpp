#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "haptex/nodes/common/transforms.h"
#include "haptex/nodes/hand_tracker/tracker_filter.h"

namespace haptex::nodes::test_tracker_filter {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

const ros::Time kNow(1000.0);
const double kNan = std::numeric_limits<double>::quiet_NaN();

/// Of the body at a place (m) in a frame, `age` (s) before kNow.
geometry_msgs::PoseStamped pose(const Vector3d& place, double age = 0.0,
                                const std::string& frame = "world") {
  geometry_msgs::PoseStamped message;
  message.header.frame_id = frame;
  message.header.stamp = kNow - ros::Duration(age);
  message.pose = poseMessage(Isometry3d(Eigen::Translation3d(place)));
  return message;
}

class TrackerFilterTest : public testing::Test {
 protected:
  TrackerFilterTest() {
    geometry_msgs::TransformStamped camera;
    camera.header.frame_id = "world";
    camera.child_frame_id = "camera";
    camera.transform = transformMessage(
        Isometry3d(Eigen::Translation3d(0.0, 0.0, 1.0) * AngleAxisd(M_PI, Vector3d::UnitX())));
    transforms.setTransform(camera, "test", true);
  }

  Isometry3d take(const geometry_msgs::PoseStamped& message) {
    return filter.receive(message, transforms, kNow);
  }

  void refuses(const geometry_msgs::PoseStamped& message, const std::string& why) {
    try {
      take(message);
      FAIL() << "taken, although " << why;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  }

  tf2_ros::Buffer transforms;
  TrackerFilter filter{Isometry3d::Identity()};
};

TEST_F(TrackerFilterTest, GivesTheHandBaseInWorldOfABodyInAnotherFrame) {
  filter = TrackerFilter(parseMounting("0.01 0.02 0.03 0 0 0"));
  // The camera looks down from 1 m: its y and z axes are turned round.
  const Vector3d hand = take(pose({0.1, 0.2, 0.3}, 0.0, "camera")).translation();
  EXPECT_TRUE(hand.isApprox(Vector3d(0.11, -0.22, 0.67), 1e-12)) << hand.transpose();
}

TEST_F(TrackerFilterTest, MountingsTurnAsStaticTransformPublisherDoes) {
  const Isometry3d mounting = parseMounting("0 0 0 1.5707963267948966 0 0.5");
  EXPECT_TRUE((mounting.linear() * Vector3d::UnitX()).isApprox(Vector3d::UnitY(), 1e-12));
  EXPECT_TRUE(mounting.linear().isApprox(
      AngleAxisd(M_PI / 2.0, Vector3d::UnitZ()) * AngleAxisd(0.5, Vector3d::UnitX()).matrix(),
      1e-12));
}

TEST(ParseMounting, RefusesWhatIsNotSixFiniteNumbers) {
  for (const char* text : {"", "0 0 0 0 0", "0 0 0 0 0 0 0", "0 0 0 0 0 x", "0 0 0 nan 0 0",
                           "0 0 0 inf 0 0", "11 0 0 0 0 0"}) {
    EXPECT_THROW(parseMounting(text), std::invalid_argument) << text;
  }
}

TEST_F(TrackerFilterTest, RefusesWhatIsNoPose) {
  refuses(pose({kNan, 0.0, 0.0}), "the position is not finite");
  geometry_msgs::PoseStamped message = pose({0.0, 0.0, 0.0});
  message.pose.orientation.w = 0.9;
  refuses(message, "quaternion has the length 0.9");
  message.pose.orientation.w = kNan;
  refuses(message, "quaternion");
  refuses(pose({0.0, 0.0, 11.0}), "allowed are coordinates up to 10 m");
}

TEST_F(TrackerFilterTest, RefusesFramesThatTfDoesNotKnow) {
  refuses(pose({0.0, 0.0, 0.0}, 0.0, "moon"), "header.frame_id = 'moon'");
  refuses(pose({0.0, 0.0, 0.0}, 0.0, ""), "header.frame_id = ''");
}

TEST_F(TrackerFilterTest, RefusesStampsThatAreOldOrInTheFuture) {
  take(pose({0.0, 0.0, 0.0}, 0.099));
  refuses(pose({0.0, 0.0, 0.0}, 0.101), "header.stamp is 101 ms before the clock here");
  refuses(pose({0.0, 0.0, 0.0}, -0.021), "allowed are -20 to 100 ms");
  geometry_msgs::PoseStamped message = pose({0.0, 0.0, 0.0});
  message.header.stamp = ros::Time();
  refuses(message, "header.stamp");
}

TEST_F(TrackerFilterTest, RefusesStampsThatAreNotLaterThanTheLast) {
  take(pose({0.0, 0.0, 0.0}, 0.01));
  refuses(pose({0.0, 0.0, 0.0}, 0.01), "not later");
  refuses(pose({0.0, 0.0, 0.0}, 0.02), "not later");
  take(pose({0.0, 0.0, 0.0}, 0.0));
}

TEST_F(TrackerFilterTest, RefusesJumpsUntilTheHandMayHaveMovedThere) {
  take(pose({0.0, 0.0, 0.0}, 0.1));
  refuses(pose({0.3, 0.0, 0.0}, 0.09), "as if it moved at 30 m/s");
  geometry_msgs::PoseStamped turned = pose({0.0, 0.0, 0.0}, 0.08);
  turned.pose = poseMessage(Isometry3d(AngleAxisd(1.0, Vector3d::UnitX())));
  refuses(turned, "50 rad/s");
  take(pose({0.3, 0.0, 0.0}, 0.0));  // 0.1 s later it may be there
}

TEST_F(TrackerFilterTest, AfterASilenceThePoseIsTakenWhereverItIs) {
  filter.receive(pose({0.0, 0.0, 0.0}, 0.3), transforms, kNow - ros::Duration(0.3));
  EXPECT_NEAR(take(pose({5.0, 0.0, 0.0})).translation().x(), 5.0, 1e-12);
}

}  // namespace
}  // namespace haptex::nodes::test_tracker_filter
