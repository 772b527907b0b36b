#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "haptex/nodes/markers/hand_markers.h"

namespace haptex::nodes::test_hand_markers {
namespace {

using base::Finger;
using visualization_msgs::InteractiveMarker;
using visualization_msgs::InteractiveMarkerControl;

exoskeleton::HandPlace somePlace() {
  exoskeleton::HandPlace place;
  place.fingertips[Finger::kIndex] = {0.1, 0.02, -0.03};
  place.fingertips[Finger::kThumb] = {0.05, 0.04, -0.06};
  place.hand_base =
      Eigen::Translation3d(0.2, -0.1, 0.3) * Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY());
  return place;
}

Eigen::Vector3d position(const geometry_msgs::Pose& pose) {
  return {pose.position.x, pose.position.y, pose.position.z};
}

int countOf(const InteractiveMarker& marker, std::uint8_t mode) {
  int count = 0;
  for (const InteractiveMarkerControl& control : marker.controls) {
    count += control.interaction_mode == mode;
  }
  return count;
}

/// rviz drops markers whose quaternions have another length, and cannot tell controls of one name
/// apart.
void expectSound(const InteractiveMarker& marker) {
  std::set<std::string> names;
  for (const InteractiveMarkerControl& control : marker.controls) {
    const auto& turn = control.orientation;
    EXPECT_NEAR(std::hypot(std::hypot(turn.w, turn.x), std::hypot(turn.y, turn.z)), 1.0, 1e-12);
    names.insert(control.name);
    for (const visualization_msgs::Marker& part : control.markers) {
      EXPECT_EQ(part.header.frame_id, "") << "else it is drawn in that frame, away from the marker";
    }
  }
  EXPECT_EQ(names.size(), marker.controls.size());
}

TEST(TargetMarkers, ShowTheTargetsInTheFrameOfTheHand) {
  const exoskeleton::HandPlace place = somePlace();
  const visualization_msgs::MarkerArray markers = targetMarkers(place);
  ASSERT_EQ(markers.markers.size(), 2u);
  for (const Finger finger : base::kFingers) {
    const auto& marker = markers.markers[static_cast<std::size_t>(finger)];
    EXPECT_EQ(marker.ns, base::name(finger));
    EXPECT_EQ(marker.header.frame_id, "hand_base");
    EXPECT_EQ(position(marker.pose), place.fingertips[finger]);
    EXPECT_EQ(marker.pose.orientation.w, 1.0);
    EXPECT_GT(marker.color.a, 0.0F);
  }
}

TEST(ForceMarkers, PointFromTheSkinAlongTheForce) {
  base::PerFinger<exoskeleton::FingerMeasurement> measured;
  measured[Finger::kIndex].pose.translation() = Eigen::Vector3d(0.1, 0.0, -0.05);
  measured[Finger::kIndex].force = Eigen::Vector3d(0.0, 0.03, -0.04);  // 0.05 N
  const visualization_msgs::MarkerArray markers = forceMarkers(measured, ros::Time(3.0));
  ASSERT_EQ(markers.markers.size(), 2u);
  const auto& arrow = markers.markers[0];
  EXPECT_EQ(arrow.action, visualization_msgs::Marker::ADD);
  EXPECT_EQ(arrow.header.frame_id, "hand_base");
  EXPECT_EQ(arrow.header.stamp, ros::Time(3.0));
  ASSERT_EQ(arrow.points.size(), 2u);
  const Eigen::Vector3d tail(arrow.points[0].x, arrow.points[0].y, arrow.points[0].z);
  const Eigen::Vector3d head(arrow.points[1].x, arrow.points[1].y, arrow.points[1].z);
  EXPECT_LT((head - tail - kForceScale * measured[Finger::kIndex].force).norm(), 1e-12);
  const Eigen::Vector3d offset = tail - measured[Finger::kIndex].pose.translation();
  EXPECT_GT(offset.norm(), 0.009) << "outside of the finger";
  EXPECT_GT(offset.dot(head - tail), 0.999 * offset.norm() * (head - tail).norm());
  EXPECT_GE((head - tail).norm(), 0.0025) << "0.05 N are seen";
}

TEST(ForceMarkers, HaveNoArrowForNoForce) {
  base::PerFinger<exoskeleton::FingerMeasurement> measured;
  measured[Finger::kIndex].force = Eigen::Vector3d(0.5 * kMinForce, 0.0, 0.0);
  measured[Finger::kThumb].force.setConstant(std::numeric_limits<double>::quiet_NaN());
  for (const auto& marker : forceMarkers(measured, ros::Time(3.0)).markers) {
    EXPECT_EQ(marker.action, visualization_msgs::Marker::DELETE);
  }
}

TEST(TargetMarkers, FingertipsCanBeDraggedButNotTurned) {
  const exoskeleton::HandPlace place = somePlace();
  for (const Finger finger : base::kFingers) {
    const InteractiveMarker marker = fingertipMarker(finger, place);
    expectSound(marker);
    EXPECT_EQ(marker.name, base::name(finger));
    EXPECT_EQ(marker.header.frame_id, "hand_base");
    EXPECT_EQ(position(marker.pose), place.fingertips[finger]);
    EXPECT_EQ(countOf(marker, InteractiveMarkerControl::MOVE_AXIS), 3);
    EXPECT_EQ(countOf(marker, InteractiveMarkerControl::MOVE_PLANE), 1);
    EXPECT_EQ(countOf(marker, InteractiveMarkerControl::ROTATE_AXIS), 0);
  }
}

TEST(TargetMarkers, ThePinchHasAHandleBeforeTheFingertipsThatGoesOneWay) {
  const exoskeleton::HandPlace place = somePlace();
  const InteractiveMarker marker = pinchMarker(place);
  expectSound(marker);
  EXPECT_EQ(marker.name, kPinchMarker);
  EXPECT_EQ(position(marker.pose), pinchPlace(place.fingertips));
  EXPECT_GT(marker.pose.position.x, place.fingertips[Finger::kThumb].x());
  EXPECT_EQ(countOf(marker, InteractiveMarkerControl::MOVE_AXIS), 1);
  EXPECT_EQ(marker.controls.size(), 1u);
}

TEST(TargetMarkers, TheHandCanBeDraggedAndTurned) {
  const exoskeleton::HandPlace place = somePlace();
  const InteractiveMarker marker = handMarker(place);
  expectSound(marker);
  EXPECT_EQ(marker.name, kHandMarker);
  EXPECT_EQ(marker.header.frame_id, "world");
  EXPECT_EQ(position(marker.pose), place.hand_base.translation());
  EXPECT_NEAR(marker.pose.orientation.y, std::sin(0.35), 1e-12);
  EXPECT_EQ(countOf(marker, InteractiveMarkerControl::MOVE_AXIS), 3);
  EXPECT_EQ(countOf(marker, InteractiveMarkerControl::ROTATE_AXIS), 3);
}

TEST(StateMarker, IsATextAboveTheHandThatIsRedForAFault) {
  using exoskeleton::Mode;
  const auto marker = [](Mode mode) {
    return stateMarker("a text", mode, ros::Time(1.0)).markers.at(0);
  };
  EXPECT_EQ(marker(Mode::kFault).text, "a text");
  EXPECT_EQ(marker(Mode::kFault).ns, "state");
  EXPECT_EQ(marker(Mode::kFault).header.frame_id, "hand_base");
  EXPECT_EQ(marker(Mode::kFault).type, visualization_msgs::Marker::TEXT_VIEW_FACING);
  EXPECT_GT(marker(Mode::kFault).color.r, 2.0F * marker(Mode::kFault).color.g);
  EXPECT_GT(marker(Mode::kEnabled).color.g, 2.0F * marker(Mode::kEnabled).color.r);
}

}  // namespace
}  // namespace haptex::nodes::test_hand_markers
