#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "haptex/nodes/markers/workspace_markers.h"

namespace haptex::nodes::test_workspace_markers {
namespace {

using visualization_msgs::Marker;

TEST(WorkspaceMarkers, ShowACubeInWorldAndASurfacePerFingerInTheHand) {
  std::ostringstream urdf;
  urdf << std::ifstream(HAPTEX_SOURCE_DIRECTORY "/urdf/hand_exoskeleton.urdf").rdbuf();
  const auto markers = workspaceMarkers(urdf.str()).markers;
  ASSERT_EQ(markers.size(), 3U);
  EXPECT_EQ(markers[0].header.frame_id, "world");
  EXPECT_EQ(markers[0].points.size(), 24U);  // 12 edges
  for (const geometry_msgs::Point& point : markers[0].points) {
    EXPECT_DOUBLE_EQ(std::abs(point.x), 0.2);
    EXPECT_DOUBLE_EQ(std::abs(point.z + 0.1), 0.2);
  }
  for (const Marker& marker : {markers[1], markers[2]}) {
    EXPECT_EQ(marker.header.frame_id, "hand_base");
    EXPECT_TRUE(marker.header.stamp.isZero());
    EXPECT_TRUE(marker.frame_locked);
    EXPECT_GT(marker.points.size(), 0U);
    EXPECT_EQ(marker.points.size() % 3, 0U);
    EXPECT_EQ(marker.points.size(), marker.colors.size());
  }
  EXPECT_NE(markers[1].ns, markers[2].ns);
}

}  // namespace
}  // namespace haptex::nodes::test_workspace_markers
