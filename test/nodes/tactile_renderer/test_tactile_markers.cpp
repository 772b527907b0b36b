#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "haptex/nodes/markers/colour_map.h"
#include "haptex/nodes/markers/marker_shapes.h"
#include "haptex/nodes/tactile_renderer/tactile_markers.h"
#include "haptex/nodes/tactile_renderer/tactile_messages.h"
#include "haptex/tactile/contactor_array.h"

namespace haptex::nodes::test_tactile_markers {
namespace {

using base::Finger;
using base::PerFinger;
using visualization_msgs::Marker;

const ros::Time kStamp(1234, 5678);

const Marker& find(const visualization_msgs::MarkerArray& markers, const std::string& name,
                   int id) {
  for (const Marker& marker : markers.markers) {
    if (marker.ns == name && marker.id == id) return marker;
  }
  throw std::invalid_argument("no marker " + name);
}

/// Contactor 5, the most distal of the first row, of the thumb vibrates.
PerFinger<haptex::Tactile> vibration() {
  PerFinger<haptex::Tactile> tactile{
      {tactileMessage(Finger::kIndex), tactileMessage(Finger::kThumb)}};
  tactile[Finger::kThumb].amplitudes_40[5] = kFullAmplitude[tactile::k40];
  tactile[Finger::kThumb].amplitudes_320[5] = 0.1 * kFullAmplitude[tactile::k320];
  return tactile;
}

/// Colours of the corners of a rectangle, which all are the same.
std_msgs::ColorRGBA colourOf(const Marker& marker, int rectangle) {
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(marker.colors[6 * rectangle + i], marker.colors[6 * rectangle]);
  }
  return marker.colors[6 * rectangle];
}

Eigen::Vector3d middleOf(const Marker& marker, int rectangle) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int i : {0, 2}) {  // opposite corners
    const geometry_msgs::Point& corner = marker.points[6 * rectangle + i];
    sum += Eigen::Vector3d(corner.x, corner.y, corner.z);
  }
  return 0.5 * sum;
}

TEST(TactileMarkers, ColourTheContactorThatVibratesOnThePadAndOnThePanel) {
  TactileMarkers markers;
  const auto shown = markers.update(vibration(), 40.0, kStamp);
  const std_msgs::ColorRGBA full = colourMessage(viridis(1.0)), half = colourMessage(viridis(0.5)),
                            none = colourMessage(viridis(0.0));
  const Marker& pad = find(shown, "tactile_pads", 1);
  const Marker& panel_40 = find(shown, "tactile_panels", 2);
  const Marker& panel_320 = find(shown, "tactile_panels", 3);
  for (int i = 0; i < tactile::kContactors; ++i) {
    EXPECT_EQ(colourOf(pad, 2 * i), i == 5 ? full : none);
    EXPECT_EQ(colourOf(pad, 2 * i + 1), i == 5 ? half : none);
    EXPECT_EQ(colourOf(panel_40, i), i == 5 ? full : none);
    EXPECT_EQ(colourOf(panel_320, i), i == 5 ? half : none);
    EXPECT_EQ(colourOf(find(shown, "tactile_panels", 0), i), none) << "the index";
  }
}

TEST(TactileMarkers, PadsAreAtTrueSizeOutsideOfTheSkin) {
  TactileMarkers markers;
  const auto shown = markers.update(vibration(), 40.0, kStamp);
  const Marker& pad = find(shown, "tactile_pads", 0);
  EXPECT_EQ(pad.header.frame_id, "index_tactile");
  EXPECT_EQ(find(shown, "tactile_pads", 1).header.frame_id, "thumb_tactile");
  EXPECT_TRUE(pad.frame_locked);
  EXPECT_EQ(pad.header.stamp, ros::Time(0)) << "it would wait for a transform of its own";
  ASSERT_EQ(pad.points.size(), 2u * 6u * tactile::kContactors);
  for (int i = 0; i < tactile::kContactors; ++i) {
    const Eigen::Vector3d first = middleOf(pad, 2 * i), second = middleOf(pad, 2 * i + 1);
    const Eigen::Vector2d middle = 0.5 * (first + second).head<2>();
    EXPECT_NEAR((middle - tactile::contactorPlace(i)).norm(), 0.0, 1e-15);
    EXPECT_GT(second.x(), first.x()) << "320 Hz distally";
    EXPECT_GT(first.z(), 0.0012);
  }
}

TEST(TactileMarkers, PanelsShowThePadUprightAndFaceTheViewer) {
  TactileMarkers markers;
  const auto shown = markers.update(vibration(), 40.0, kStamp);
  // Yaw 1 and pitch 0.2 of the view of rviz/haptex.rviz.
  const Eigen::Vector3d viewer(std::cos(1.0) * std::cos(0.2), std::sin(1.0) * std::cos(0.2),
                               std::sin(0.2));
  for (int id = 0; id < 4; ++id) {
    const Marker& panel = find(shown, "tactile_panels", id);
    EXPECT_EQ(panel.header.frame_id, "world");
    ASSERT_EQ(panel.points.size(), 6u * tactile::kContactors);
    const Eigen::Vector3d along_x = middleOf(panel, 5) - middleOf(panel, 0);
    const Eigen::Vector3d along_y = middleOf(panel, 18) - middleOf(panel, 0);
    EXPECT_NEAR(along_x.normalized().z(), std::cos(0.2), 1e-12) << "upright in the picture";
    EXPECT_GT(along_x.cross(along_y).normalized().dot(viewer), 1.0 - 1e-12)
        << "z of the array comes out of the pad";
  }
}

TEST(TactileMarkers, CaptionsNameFingerChannelLargestAmplitudeAndScale) {
  TactileMarkers markers;
  const auto shown = markers.update(vibration(), 40.2, kStamp);
  EXPECT_EQ(find(shown, "tactile_captions", 0).text, "index 40 Hz\n0.0 um of 40");
  EXPECT_EQ(find(shown, "tactile_captions", 3).text, "thumb 320 Hz\n1.0 um of 10");
  EXPECT_EQ(find(shown, "tactile_captions", 4).text, "tactile renderer 40 Hz");
  EXPECT_EQ(find(shown, "tactile_captions", 3).header.stamp, kStamp);
}

}  // namespace
}  // namespace haptex::nodes::test_tactile_markers
