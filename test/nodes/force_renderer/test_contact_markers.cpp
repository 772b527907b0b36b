#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "haptex/nodes/force_renderer/contact_markers.h"

namespace haptex::nodes::test_contact_markers {
namespace {

using base::Finger;
using visualization_msgs::Marker;

const ros::Time kStamp(1234, 5678);

const Marker& find(const visualization_msgs::MarkerArray& markers, const std::string& name,
                   int id = 0) {
  for (const Marker& marker : markers.markers) {
    if (marker.ns == name && marker.id == id) return marker;
  }
  throw std::invalid_argument("no marker " + name);
}

/// The index touches with 2 N, of which half is rendered, on a patch of one triangle.
simulation::ContactPicture touch() {
  simulation::ContactPicture picture;
  contact::FingertipContact& index = picture.contacts[Finger::kIndex];
  index.touching = true;
  index.force = {0.0, 0.0, 2.0};
  index.position = {0.1, 0.2, 0.3};
  index.points.push_back({{0.1, 0.2, 0.29}, -Eigen::Vector3d::UnitZ(), 0.05, {0.0, 0.0, 0.0}});
  picture.gains[Finger::kIndex] = 0.5;
  picture.positions = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  picture.triangles = {{0, 1, 2}};
  picture.contact_forces = {0.1, 0.001, 0.0};
  return picture;
}

TEST(ContactMarkers, ShowARenderedForceAsAnArrowFromTheSkin) {
  ContactMarkers markers;
  const auto shown = markers.update(touch(), LoopRates(), kStamp);
  const Marker& arrow = find(shown, "contact_force", 0);
  EXPECT_EQ(arrow.action, Marker::ADD);
  EXPECT_EQ(arrow.header.frame_id, "world");
  EXPECT_EQ(arrow.header.stamp, kStamp);
  ASSERT_EQ(arrow.points.size(), 2u);
  EXPECT_GT(arrow.points[0].z, 0.3 + 0.009) << "it would begin within the thumb";
  EXPECT_NEAR(arrow.points[1].z - arrow.points[0].z, arrowLength(1.0), 1e-12);
  EXPECT_EQ(find(shown, "contact_force", 1).action, Marker::DELETE);
}

TEST(ContactMarkers, AForceOfAHundredthNewtonIsSeenAndFiveNewtonFitTheView) {
  EXPECT_GT(arrowLength(0.01), 0.008);
  EXPECT_LT(arrowLength(5.0), 0.1);
  EXPECT_GT(arrowLength(5.0), arrowLength(1.0));
  ContactMarkers markers;
  simulation::ContactPicture picture = touch();
  picture.contacts[Finger::kIndex].force = {0.02, 0.0, 0.0};  // half of it is rendered
  EXPECT_EQ(find(markers.update(picture, LoopRates(), kStamp), "contact_force").action,
            Marker::ADD);
}

TEST(ContactMarkers, ShowThePatchInTheColoursOfTheContactForceOnBothSides) {
  ContactMarkers markers;
  const Marker& patch = find(markers.update(touch(), LoopRates(), kStamp), "patch");
  ASSERT_EQ(patch.points.size(), 6u);
  ASSERT_EQ(patch.colors.size(), 6u);
  EXPECT_LT(patch.points[0].z, 0.0);
  EXPECT_GT(patch.points[3].z, 0.0);
  EXPECT_EQ(contactForceFraction(0.1), 1.0);
  EXPECT_NEAR(contactForceFraction(0.001), 1.0 / 3.0, 1e-12);
  EXPECT_EQ(contactForceFraction(0.0), 0.0);
  EXPECT_GT(patch.colors[0].r, 2.0 * patch.colors[2].r) << "yellow against violet";
}

TEST(ContactMarkers, DeleteWhatThereIsNothingOf) {
  ContactMarkers markers;
  markers.update(touch(), LoopRates(), kStamp);
  const auto shown = markers.update(simulation::ContactPicture(), LoopRates(), kStamp);
  for (const std::string name : {"contact_points", "contact_force", "patch"}) {
    EXPECT_EQ(find(shown, name).action, Marker::DELETE) << name;
  }
  EXPECT_EQ(find(shown, "rates").action, Marker::ADD);
}

TEST(ContactMarkers, NameTheRateOfEveryLoopAndTheForceOfEveryFinger) {
  LoopRates rates{999.7, 80.2, 160.0, std::nan("")};
  const std::string text = rateText(rates, {{0.0589, 1.5}}, {{"", "cloth/heartbeat: nothing"}});
  for (const std::string part :
       {"force loop 1000 Hz", "cloth 80 Hz", "proximity 160 Hz", "exoskeleton ...",
        "index 0.059 N\n", "thumb 1.500 N (no force: cloth/heartbeat: nothing)"}) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace haptex::nodes::test_contact_markers
