#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/common/vector_messages.h"
#include "haptex/nodes/markers/colour_map.h"
#include "haptex/nodes/markers/marker_shapes.h"
#include "haptex/nodes/proximity/proximity_markers.h"
#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes::test_proximity_markers {
namespace {

using proximity::Sphere;
using visualization_msgs::Marker;

const proximity::Triangle kTriangle = {Eigen::Vector3d(0.0, 0.0, 0.0),
                                       Eigen::Vector3d(0.0, 0.01, 0.0),
                                       Eigen::Vector3d(0.0, 0.0, 0.01)};

proximity::Kdop boxAround(const Eigen::Vector3d& middle, double half) {
  proximity::Kdop box;
  for (const Eigen::Vector3d& axis : proximity::kdopAxes(proximity::KdopKind::k6)) {
    box.push_back({axis, axis.dot(middle) + half});
    box.push_back({-axis, -axis.dot(middle) + half});
  }
  return box;
}

ProximityScene someScene() {
  ProximityScene scene;
  scene.stamp = ros::Time(7);
  scene.triangles = {kTriangle};
  scene.volumes = {
      {"volumes", {boxAround({0.0, 0.0, 0.0}, 0.1), boxAround({0.3, 0.0, 0.0}, 0.1)}, {0, 1}}};
  return scene;
}

std::vector<mesh::Obstacle> oneOfEachKind() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(0.1, 0.2, 0.3));
  pose.rotate(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()));
  return {
      {"ball", mesh::ObstacleSphere{0.05}, pose},
      {"table", mesh::ObstacleBox{{0.1, 0.2, 0.3}}, pose},
      {"post", mesh::ObstacleCapsule{0.01, 0.1}, pose},
      {"sheet", mesh::ObstacleMesh{{kTriangle[0], kTriangle[1], kTriangle[2]}, {{0, 1, 2}}}, pose}};
}

const Marker& find(const visualization_msgs::MarkerArray& markers, const std::string& name,
                   int type) {
  for (const Marker& marker : markers.markers) {
    if (marker.ns == name && marker.type == type) return marker;
  }
  throw std::out_of_range(name);
}

Eigen::Vector3d vector(const geometry_msgs::Point& point) { return {point.x, point.y, point.z}; }

/// Volume within a closed surface, by the divergence theorem.
double volumeWithin(const std::vector<geometry_msgs::Point>& corners) {
  double volume = 0.0;
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    volume += vector(corners[i]).dot(vector(corners[i + 1]).cross(vector(corners[i + 2]))) / 6.0;
  }
  return volume;
}

/// Of the convex hull of two spheres by slices across its axis; radius of the slice at x.
double exactVolume(double length, double begin, double end) {
  const double lean = (begin - end) / length;  // sine of the slope of the cone
  const double slope = lean / std::sqrt(1.0 - lean * lean);
  const auto squared_radius = [&](double x) {
    const double from = begin * lean, to = length + end * lean;  // where the cone touches
    if (x < from) return begin * begin - x * x;
    if (x > to) return end * end - (x - length) * (x - length);
    const double radius = begin * std::sqrt(1.0 - lean * lean) - slope * (x - from);
    return radius * radius;
  };
  const int slices = 100000;
  double volume = 0.0;
  const double step = (length + begin + end) / slices;
  for (int i = 0; i < slices; ++i) volume += squared_radius(-begin + (i + 0.5) * step);
  return 3.14159265358979 * volume * step;
}

TEST(MarkerShapes, SurfaceOfATaperedCapsuleIsClosedAndOnItFromOutside) {
  const Eigen::Vector3d a(0.01, -0.02, 0.03);
  const Eigen::Vector3d b = a + 0.05 * Eigen::Vector3d(1.0, -2.0, 2.0) / 3.0;
  for (const auto& [begin, end] :
       std::vector<std::pair<double, double>>{{0.01, 0.01}, {0.02, 0.005}, {0.0, 0.02}}) {
    const proximity::TaperedCapsule capsule{{a, begin}, {b, end}};
    std::vector<geometry_msgs::Point> corners;
    appendSurface(capsule, corners);
    for (const geometry_msgs::Point& corner : corners) {
      const Eigen::Vector3d place = vector(corner);
      const double distance =
          proximity::closestPoint(proximity::Triangle{place, place, place}, capsule).distance;
      EXPECT_NEAR(distance, 0.0, 1e-12);
    }
    // Chords of 24 meridians cut off 1.2 % of a circle, those of 16 parallels less than that.
    const double exact = exactVolume(0.05, begin, end);
    EXPECT_LT(volumeWithin(corners), exact);
    EXPECT_GT(volumeWithin(corners), 0.97 * exact);
  }
}

TEST(MarkerShapes, SphereWithinTheOtherVanishes) {
  const Sphere large{{0.0, 0.0, 0.0}, 0.02}, small{{0.005, 0.0, 0.0}, 0.01};
  std::vector<geometry_msgs::Point> both, same, alone;
  appendSurface({large, small}, both);
  appendSurface({small, large}, same);
  appendSurface({large, large}, alone);
  const double exact = 4.0 / 3.0 * 3.14159265358979 * 0.02 * 0.02 * 0.02;
  for (const auto& corners : {both, same, alone}) {
    EXPECT_NEAR(volumeWithin(corners), exact, 0.03 * exact);  // chords, see above
  }
}

TEST(MarkerShapes, DistinctColoursAreColoursAndNeighboursDiffer) {
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3f colour = distinctColour(i);
    EXPECT_TRUE((colour.array() >= 0.0F).all() && (colour.array() <= 1.0F).all());
    EXPECT_GT((colour - distinctColour(i + 1)).norm(), 0.5F);
  }
}

TEST(MarkerShapes, ShadeDoesNotDependOnTheFrameOfTheMarker) {
  Marker straight = makeMarker("test", 0, Marker::TRIANGLE_LIST);
  appendBox({0.1, 0.2, 0.3}, straight.points);
  Marker turned = straight;
  const Eigen::Quaterniond rotation(Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, 3).normalized()));
  turned.pose.orientation.w = rotation.w();
  turned.pose.orientation.x = rotation.x();
  turned.pose.orientation.y = rotation.y();
  turned.pose.orientation.z = rotation.z();
  for (auto& point : turned.points) point = pointMessage(rotation.inverse() * vector(point));
  for (Marker* marker : {&straight, &turned}) {
    shadeTriangles(*marker, Eigen::Vector3f(1.0F, 0.5F, 0.0F), 0.25F);
  }
  ASSERT_EQ(straight.colors.size(), straight.points.size());
  std::set<float> shades;
  for (std::size_t i = 0; i < straight.colors.size(); ++i) {
    EXPECT_NEAR(straight.colors[i].r, turned.colors[i].r, 1e-6F);  // single precision
    EXPECT_FLOAT_EQ(straight.colors[i].g, 0.5F * straight.colors[i].r);
    EXPECT_EQ(straight.colors[i].a, 0.25F);
    EXPECT_GT(straight.colors[i].r, 0.3F);
    shades.insert(straight.colors[i].r);
  }
  EXPECT_EQ(shades.size(), 3u);  // opposite faces are alike
}

TEST(ProximityMarkers, ShowTheElementsInRedOnBothSides) {
  ProximityMarkers markers({});
  const Marker& elements =
      find(markers.update(someScene(), {}), "near_elements", Marker::TRIANGLE_LIST);
  EXPECT_EQ(elements.action, Marker::ADD);
  ASSERT_EQ(elements.points.size(), 6u);
  ASSERT_EQ(elements.colors.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    const Eigen::Vector3d off = vector(elements.points[i]) - kTriangle[i % 3];
    EXPECT_GT((i < 3 ? 1.0 : -1.0) * off.x(), 1e-4);
    EXPECT_LT(off.norm(), 1e-3);  // but not so far that it looks like another surface
    EXPECT_GT(elements.colors[i].r, 0.8F);
    EXPECT_LT(elements.colors[i].g, 0.2F);
    EXPECT_LT(elements.colors[i].b, 0.2F);
  }
}

TEST(ProximityMarkers, ShowEachVolumeInAColourOfItsOwn) {
  ProximityMarkers markers({});
  const auto& array = markers.update(someScene(), {});
  const Marker& faces = find(array, "volumes", Marker::TRIANGLE_LIST);
  const Marker& edges = find(array, "volumes", Marker::LINE_LIST);
  ASSERT_EQ(faces.points.size(), 2u * 6 * 2 * 3);  // boxes, faces, triangles, corners
  ASSERT_EQ(edges.points.size(), 2u * 6 * 4 * 2);  // boxes, faces, edges, ends
  ASSERT_EQ(faces.colors.size(), faces.points.size());
  ASSERT_EQ(edges.colors.size(), edges.points.size());
  // Two boxes of 0.2 m.
  EXPECT_NEAR(volumeWithin(faces.points), 2.0 * 0.008, 1e-12);
  std::set<std::array<float, 3>> colours;
  for (const auto& colour : faces.colors) {
    colours.insert({colour.r, colour.g, colour.b});
    EXPECT_GT(colour.a, 0.0F);
    EXPECT_LT(colour.a, 0.5F);
  }
  EXPECT_EQ(colours.size(), 2u);
}

TEST(ProximityMarkers, ShowGroupsOfVolumesInNamespacesOfTheirOwnAsLongAsTheyAreThere) {
  ProximityMarkers markers({});
  ProximityScene scene = someScene();
  scene.volumes[0].name = "volumes/3";
  scene.volumes[0].colours = {2, 2};
  const auto& array = markers.update(scene, {});
  EXPECT_EQ(find(array, "volumes", Marker::TRIANGLE_LIST).action, Marker::DELETE);
  const Marker& faces = find(array, "volumes/3", Marker::TRIANGLE_LIST);
  EXPECT_EQ(faces.action, Marker::ADD);
  EXPECT_EQ(faces.points.size(), 2u * 6 * 2 * 3);
  EXPECT_EQ(faces.colors.front(), faces.colors.back());
  scene.volumes.clear();
  EXPECT_EQ(find(markers.update(scene, {}), "volumes/3", Marker::LINE_LIST).action, Marker::DELETE);
  EXPECT_EQ(find(markers.update(someScene(), {}), "volumes", Marker::LINE_LIST).action,
            Marker::ADD);
}

TEST(ProximityMarkers, ShowTheCursorAndAPointAsASmallBall) {
  ProximityMarkers markers({});
  const Sphere sphere{{0.0, 0.0, 0.0}, 0.01};
  const auto with = [&](const proximity::TaperedCapsule& part) {
    return find(markers.update(someScene(), {part}), "cursor", Marker::TRIANGLE_LIST);
  };
  const double exact = 4.0 / 3.0 * 3.14159265358979 * 1e-6;
  EXPECT_NEAR(volumeWithin(with({sphere, sphere}).points), exact, 0.03 * exact);
  EXPECT_LT(with({sphere, sphere}).colors.front().a, 0.9F);
  const Sphere point{{0.0, 0.0, 0.0}, 0.0};
  EXPECT_GT(volumeWithin(with({point, point}).points), 0.0);
}

TEST(ProximityMarkers, DeleteWhatThereIsNothingOf) {
  ProximityMarkers markers({});
  const Sphere sphere{{0.0, 0.0, 0.0}, 0.01};
  markers.update(someScene(), {{sphere, sphere}});
  ProximityScene nothing;
  nothing.stamp = ros::Time(8);
  for (const Marker& marker : markers.update(nothing, {}).markers) {
    EXPECT_EQ(marker.action, Marker::DELETE) << marker.ns;
  }
}

TEST(ProximityMarkers, ShowObstaclesAtTheirPlaces) {
  const auto obstacles = oneOfEachKind();
  ProximityMarkers markers(obstacles);
  const auto& array = markers.update(someScene(), {});
  std::vector<Marker> shown;
  for (const Marker& marker : array.markers) {
    if (marker.ns == "obstacles") shown.push_back(marker);
  }
  ASSERT_EQ(shown.size(), obstacles.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    EXPECT_EQ(shown[i].id, static_cast<int>(i));
    const Eigen::Quaterniond rotation(shown[i].pose.orientation.w, shown[i].pose.orientation.x,
                                      shown[i].pose.orientation.y, shown[i].pose.orientation.z);
    EXPECT_TRUE(rotation.toRotationMatrix().isApprox(obstacles[i].pose.linear(), 1e-14));
    EXPECT_EQ(vector(shown[i].pose.position), obstacles[i].pose.translation());
  }
  const double ball = 4.0 / 3.0 * 3.14159265358979 * 0.05 * 0.05 * 0.05;
  EXPECT_NEAR(volumeWithin(shown[0].points), ball, 0.03 * ball);
  EXPECT_NEAR(volumeWithin(shown[1].points), 0.1 * 0.2 * 0.3, 1e-15);  // rounding
  const double post = exactVolume(0.1, 0.01, 0.01);
  EXPECT_NEAR(volumeWithin(shown[2].points), post, 0.03 * post);
  EXPECT_EQ(shown[3].points.size(), 3u);
}

TEST(ProximityMarkers, AreAllStampedInTheFixedFrameAndNamedOnce) {
  ProximityMarkers markers(oneOfEachKind());
  std::set<std::pair<std::string, int>> names;
  for (const Marker& marker : markers.update(someScene(), {}).markers) {
    EXPECT_EQ(marker.header.frame_id, fixedFrame());
    EXPECT_EQ(marker.header.stamp, ros::Time(7));
    EXPECT_TRUE(names.insert({marker.ns, marker.id}).second);
  }
}

}  // namespace
}  // namespace haptex::nodes::test_proximity_markers
