#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <random>

#include "../simulation/small_scene.h"
#include "haptex/nodes/cloth_simulation/cloth_markers.h"
#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/markers/colour_map.h"
#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes::test_cloth_markers {
namespace {

using visualization_msgs::Marker;

const Marker& find(const visualization_msgs::MarkerArray& markers, const std::string& name,
                   int type) {
  for (const Marker& marker : markers.markers) {
    if (marker.ns == name && marker.type == type) return marker;
  }
  throw std::out_of_range(name);
}

TEST(ColourMap, GetsBrighterAllTheWay) {
  const Eigen::Vector3f luminance(0.2126F, 0.7152F, 0.0722F);
  for (int i = 0; i < 100; ++i) {
    EXPECT_LT(luminance.dot(viridis(i / 100.0)), luminance.dot(viridis((i + 1) / 100.0)));
  }
}

TEST(ColourMap, EndsAtItsEndsForEveryNumber) {
  EXPECT_EQ(viridis(-1.0), viridis(0.0));
  EXPECT_EQ(viridis(std::numeric_limits<double>::quiet_NaN()), viridis(0.0));
  EXPECT_EQ(viridis(2.0), viridis(1.0));
}

TEST(ColourMap, SpansFourDecadesBelowTheFullScale) {
  EXPECT_DOUBLE_EQ(strainFraction(0.01, 0.01), 1.0);
  EXPECT_NEAR(strainFraction(1e-6, 0.01), 0.0, 1e-12);
  EXPECT_EQ(strainFraction(0.0, 0.01), 0.0);
  EXPECT_EQ(strainFraction(-0.1, 0.01), 0.0);
}

TEST(ColourMap, LargestPrincipalStrainIsTheLargestEigenvalue) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> strain(-0.1, 0.1);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d e(strain(generator), strain(generator), strain(generator));
    Eigen::Matrix2d tensor;
    tensor << e[0], e[2] / 2, e[2] / 2, e[1];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(tensor);
    EXPECT_NEAR(largestPrincipalStrain(e), solver.eigenvalues()[1], 1e-15);  // rounding
  }
}

TEST(ClothMarkers, ShowEveryTriangleAtItsPlaceWithFiniteColours) {
  simulation::SimulatedCloth simulation = simulation::smallSimulation();
  ClothMarkers markers(simulation.cloth().mesh(), 0.01);
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(simulation.step());
  const Marker& cloth =
      find(markers.update(simulation, ros::Time(3)), "cloth", Marker::TRIANGLE_LIST);
  const auto& triangles = simulation.cloth().mesh().triangles;
  ASSERT_EQ(cloth.points.size(), 3 * triangles.size());
  ASSERT_EQ(cloth.colors.size(), cloth.points.size());
  for (std::size_t i = 0; i < cloth.points.size(); ++i) {
    const Eigen::Vector3d& position = simulation.state().positions[triangles[i / 3][i % 3]];
    EXPECT_EQ(Eigen::Vector3d(cloth.points[i].x, cloth.points[i].y, cloth.points[i].z), position);
    const float sum = cloth.colors[i].r + cloth.colors[i].g + cloth.colors[i].b;
    EXPECT_TRUE(sum > 0.0F && sum <= 3.0F);
  }
}

TEST(ClothMarkers, TellFabricsApartByColourAndName) {
  scene::Scene scene = simulation::smallScene();
  const std::size_t triangles = scene.mesh.triangles.size();
  scene.mesh.triangle_fabrics.assign(triangles, 0);
  scene.mesh.triangle_fabrics[1] = 1;
  material::Fabric first = simulation::smallFabric(), second = first;
  first.name = "wool";
  second.name = "denim";
  simulation::SimulatedCloth simulation(scene, {first, second});
  ClothMarkers markers(scene.mesh, 0.01, {}, ClothColours::kFabric);
  const auto& shown = markers.update(simulation, ros::Time(1));
  const Marker& cloth = find(shown, "cloth", Marker::TRIANGLE_LIST);
  const auto hue = [&](std::size_t triangle) {  // shading takes as much off every colour
    const auto& colour = cloth.colors[3 * triangle];
    return Eigen::Vector3f(colour.r, colour.g, colour.b).normalized();
  };
  EXPECT_LT((hue(0) - distinctColour(0).normalized()).norm(), 1e-3F);
  EXPECT_LT((hue(1) - distinctColour(1).normalized()).norm(), 1e-3F);
  EXPECT_LT((hue(2) - hue(0)).norm(), 1e-3F);
  std::vector<std::string> names;
  for (const Marker& marker : shown.markers) {
    if (marker.ns == "scale") names.push_back(marker.text);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"wool", "denim"}));
}

TEST(ClothMarkers, ShowAttachedParticlesAndVanishWithThem) {
  simulation::SimulatedCloth simulation = simulation::smallSimulation();
  ClothMarkers markers(simulation.cloth().mesh(), 0.01);
  simulation.attach({0});
  const auto& with = markers.update(simulation, ros::Time(1));
  EXPECT_EQ(find(with, "attachments", Marker::LINE_LIST).points.size(), 2u * 4);
  EXPECT_EQ(find(with, "attachments", Marker::SPHERE_LIST).points.size(), 1u);
  simulation.release({0, 20, 21, 22, 23, 24});
  const auto& without = markers.update(simulation, ros::Time(2));
  EXPECT_EQ(find(without, "attachments", Marker::LINE_LIST).action, Marker::DELETE);
  EXPECT_EQ(find(without, "attachments", Marker::SPHERE_LIST).action, Marker::DELETE);
}

TEST(ClothMarkers, ShowExcludedParticlesInGreyWithoutBars) {
  simulation::SimulatedCloth simulation = simulation::smallSimulation();
  ClothMarkers markers(simulation.cloth().mesh(), 0.01);
  simulation.exclude({0, 1, 5});
  const auto& shown = markers.update(simulation, ros::Time(1));
  EXPECT_EQ(find(shown, "attachments", Marker::LINE_LIST).points.size(), 2u * 4);
  EXPECT_EQ(find(shown, "attachments", Marker::SPHERE_LIST).action, Marker::DELETE);
  const Marker& cloth = find(shown, "cloth", Marker::TRIANGLE_LIST);
  const auto& triangles = simulation.cloth().mesh().triangles;
  for (std::size_t i = 0; i < cloth.points.size(); ++i) {
    const int particle = triangles[i / 3][i % 3];
    const bool grey =
        cloth.colors[i].r == cloth.colors[i].g && cloth.colors[i].g == cloth.colors[i].b;
    EXPECT_EQ(grey, particle == 0 || particle == 1 || particle == 5) << particle;
  }
}

TEST(ClothMarkers, AreAllStampedAndInTheFixedFrame) {
  simulation::SimulatedCloth simulation = simulation::smallSimulation();
  ClothMarkers markers(simulation.cloth().mesh(), 0.01);
  int labels = 0;
  for (const Marker& marker : markers.update(simulation, ros::Time(7)).markers) {
    EXPECT_EQ(marker.header.frame_id, fixedFrame());
    EXPECT_EQ(marker.header.stamp, ros::Time(7));
    if (marker.text.find('%') != std::string::npos) ++labels;
  }
  EXPECT_EQ(labels, 1 + kStrainDecades);
}

}  // namespace
}  // namespace haptex::nodes::test_cloth_markers
