#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "../../refusal.h"
#include "haptex/appearance/directions.h"
#include "haptex/nodes/markers/colour_map.h"
#include "haptex/nodes/markers/marker_shapes.h"
#include "haptex/nodes/rviz_plugin/cloth_surface.h"

namespace haptex::nodes::test_cloth_surface {
namespace {

/// 100 N/m along weft and warp.
std::string linearFabric() {
  std::ifstream file(HAPTEX_CONFIG_DIRECTORY "/fabrics/linear.yaml");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Two triangles, a square of 1 m: particles 0 and 1 below, 2 and 3 above.
haptex::ClothMesh squareMesh() {
  haptex::ClothMesh mesh;
  mesh.mesh = 3;
  mesh.fabrics = {"linear"};
  mesh.fabric_files = {linearFabric()};
  mesh.rest_weft_coordinates = {0.0, 1.0, 0.0, 1.0};
  mesh.rest_warp_coordinates = {0.0, 0.0, 1.0, 1.0};
  mesh.triangles = {0, 1, 2, 1, 3, 2};
  return mesh;
}

/// Weft along y, warp along z, stretched along weft.
haptex::ClothState squareState(double stretch) {
  haptex::ClothState state;
  state.mesh = 3;
  state.header.frame_id = "world";
  for (const double z : {0.0, 1.0}) {
    for (const double y : {0.0, stretch}) {
      geometry_msgs::Point point;
      point.y = y;
      point.z = z;
      state.positions.push_back(point);
    }
  }
  return state;
}

VertexColour shaded(const Eigen::Vector3f& colour, const Eigen::Vector3d& normal) {
  VertexColour bytes{0, 0, 0, 255};
  for (int i = 0; i < 3; ++i) {
    bytes[i] = static_cast<std::uint8_t>(std::lround(255.0F * shade(normal) * colour[i]));
  }
  return bytes;
}

TEST(ClothSurface, HasTheColourOfItsLargestPrincipalStrain) {
  ClothSurface surface(squareMesh(), ColourBy::kStrain);
  surface.take(squareState(1.002));
  const double strain = 0.5 * (1.002 * 1.002 - 1.0);
  const Eigen::Vector3f colour = viridis(1.0 + std::log10(strain / 0.01) / 4.0);
  ASSERT_EQ(surface.colours().size(), 4u);
  for (const VertexColour& vertex : surface.colours()) {
    EXPECT_EQ(vertex, shaded(colour, Eigen::Vector3d::UnitX()));
  }
}

TEST(ClothSurface, HasTheColourOfTheStressOfItsFabric) {
  ClothSurface surface(squareMesh(), ColourBy::kStress);
  surface.take(squareState(1.002));
  const double stress = 100.0 * 0.5 * (1.002 * 1.002 - 1.0);  // N/m
  const Eigen::Vector3f colour = viridis(1.0 + std::log10(stress / 100.0) / 4.0);
  EXPECT_EQ(surface.colours().front(), shaded(colour, Eigen::Vector3d::UnitX()));
}

TEST(ClothSurface, FollowsAnotherFullScale) {
  ClothSurface surface(squareMesh(), ColourBy::kStrain);
  surface.setFullScale(0.0001);
  surface.take(squareState(1.002));
  EXPECT_EQ(surface.colours().front(), shaded(viridis(1.0), Eigen::Vector3d::UnitX()));
  surface.setFullScale(0.0);
  EXPECT_EQ(surface.scale().full, 0.01) << "0 is the default";
}

TEST(ClothSurface, SharesOutContactForcesByBarycentricWeights) {
  ClothSurface surface(squareMesh(), ColourBy::kContactForce);
  haptex::ContactForces forces;
  forces.mesh = 3;
  forces.triangles = {0};
  forces.barycentric = {0.5, 0.5, 0.0};
  forces.forces.resize(1);
  forces.forces[0].x = 0.02;
  surface.take(forces);
  surface.take(squareState(1.0));
  const Eigen::Vector3f colour = viridis(1.0 + std::log10(0.01 / 0.1) / 3.0);
  const Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
  EXPECT_EQ(surface.colours()[0], shaded(colour, normal));
  EXPECT_EQ(surface.colours()[1], shaded(colour, normal));
  EXPECT_EQ(surface.colours()[2], shaded(viridis(0.0), normal));
  forces.mesh = 4;
  forces.forces[0].x = 1.0;
  surface.take(forces);
  surface.take(squareState(1.0));
  EXPECT_EQ(surface.colours()[0], shaded(colour, normal)) << "forces of another mesh";
}

TEST(ClothSurface, BothSidesAreEquallyBright) {
  ClothSurface surface(squareMesh(), ColourBy::kStrain);
  surface.take(squareState(1.002));
  const std::vector<VertexColour> front = surface.colours();
  haptex::ClothState state = squareState(1.002);
  for (geometry_msgs::Point& point : state.positions) point.y = -point.y;  // turns the normals
  surface.take(state);
  EXPECT_EQ(surface.colours(), front);
}

/// The square along y and z, and another one before it that hides half of the sky from its edge.
haptex::ClothMesh cornerMesh() {
  haptex::ClothMesh mesh = squareMesh();
  mesh.rest_weft_coordinates.insert(mesh.rest_weft_coordinates.end(), {2.0, 2.0});
  mesh.rest_warp_coordinates.insert(mesh.rest_warp_coordinates.end(), {0.0, 1.0});
  mesh.triangles.insert(mesh.triangles.end(), {1, 4, 3, 4, 5, 3});
  return mesh;
}

TEST(ClothSurface, ShadowsTheSideInACornerAndNotTheOneOutside) {
  ClothSurface surface(cornerMesh(), ColourBy::kContactForce);
  haptex::ClothState state = squareState(1.0);
  for (const double z : {0.0, 1.0}) {
    geometry_msgs::Point point;
    point.x = 1.0;
    point.y = 1.0;
    point.z = z;
    state.positions.push_back(point);
  }
  surface.take(state);
  const std::vector<VertexColour> bare = surface.colours();
  surface.setSelfShadow(true);
  surface.setEye(Eigen::Vector3d(-5.0, 0.5, 0.5));
  surface.take(state);
  EXPECT_EQ(surface.colours()[0], bare[0]);
  surface.setEye(Eigen::Vector3d(5.0, 0.5, 0.5));
  surface.take(state);
  EXPECT_LT(surface.colours()[0][2], bare[0][2]);
  EXPECT_EQ(surface.colours()[0][3], bare[0][3]);
  const std::vector<VertexColour> shadowed = surface.colours();
  surface.seeFrom(Eigen::Vector3d(-5.0, 0.5, 0.5));
  EXPECT_EQ(surface.colours()[0], bare[0]);
  surface.seeFrom(Eigen::Vector3d(5.0, 0.5, 0.5));
  EXPECT_EQ(surface.colours(), shadowed) << "the eye went and came back, the cloth did not move";
  surface.setEye(std::nullopt);
  surface.take(state);
  EXPECT_EQ(surface.colours(), bare);
  surface.seeFrom(Eigen::Vector3d(5.0, 0.5, 0.5));
  EXPECT_EQ(surface.colours(), bare) << "a state without shadows has none";
}

/// What a fabric reflects, the same to all sides, 1 for all light.
appearance::Brdf::Table white() {
  return appearance::Brdf::Table::Constant(static_cast<float>(1.0 / M_PI));
}

std::vector<std::shared_ptr<const appearance::Brdf>> looks(const appearance::Brdf::Table& table) {
  return {std::make_shared<appearance::Brdf>(table)};
}

TEST(ClothSurface, ALookIsLitBySunAndSkyOnTheSideOfTheEye) {
  ClothSurface surface(squareMesh(), ColourBy::kLook);
  appearance::Brdf::Table table = white();
  table.row(1) *= 0.5F;
  table.row(2) *= 0.0F;
  surface.setLooks(looks(table));
  const haptex::ClothState state = squareState(1.0);
  surface.take(state);
  EXPECT_EQ(surface.colours()[0], shaded({0.62F, 0.62F, 0.62F}, Eigen::Vector3d::UnitX()))
      << "there is no eye";
  surface.setEye(Eigen::Vector3d(5.0, 0.5, 0.5));
  surface.take(state);
  const double sunny = kAmbient + (1.0 - kAmbient) * towardsSun().x();
  const auto encoded = [](double linear) {
    return std::lround(255.0 * (1.055 * std::pow(linear, 1.0 / 2.4) - 0.055));
  };
  for (const VertexColour& vertex : surface.colours()) {
    EXPECT_NEAR(vertex[0], encoded(sunny), 1);
    EXPECT_NEAR(vertex[1], encoded(0.5 * sunny), 1);
    EXPECT_EQ(vertex[2], 0);
    EXPECT_EQ(vertex[3], 255);
  }
  surface.seeFrom(Eigen::Vector3d(-5.0, 0.5, 0.5));
  EXPECT_NEAR(surface.colours()[0][0], encoded(kAmbient), 1) << "the sun is on the other side";
}

/// White for eyes on the side that the weft points to, black for others.
appearance::Brdf::Table brightAlongWeft() {
  appearance::Brdf::Table table = white();
  for (int view = 0; view < appearance::kDirections; ++view) {
    if (appearance::sampledDirections()[view].x() > 0.0) continue;
    table.middleCols<appearance::kDirections>(appearance::kDirections * view).setZero();
  }
  return table;
}

TEST(ClothSurface, ALookTurnsWithTheYarns) {
  const Eigen::Vector3d along_weft(3.0, 4.5, 0.5), against_weft(3.0, -3.5, 0.5);
  ClothSurface surface(squareMesh(), ColourBy::kLook);
  surface.setLooks(looks(brightAlongWeft()));
  surface.setEye(along_weft);
  surface.take(squareState(1.0));
  EXPECT_GT(surface.colours()[0][0], 200);
  surface.seeFrom(against_weft);
  EXPECT_LT(surface.colours()[0][0], 50);
  // From behind, as the other side has the same yarns.
  surface.seeFrom(Eigen::Vector3d(-3.0, 4.5, 0.5));
  EXPECT_GT(surface.colours()[0][0], 100);
  surface.seeFrom(Eigen::Vector3d(-3.0, -3.5, 0.5));
  EXPECT_LT(surface.colours()[0][0], 50);

  // Two panels, the second cut the other way round.
  haptex::ClothMesh sewn = squareMesh();
  sewn.corner_weft_coordinates = {0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  sewn.corner_warp_coordinates = {0.0, 0.0, 1.0, 1.0, 0.0, 0.0};
  sewn.triangle_panels = {0, 1};
  ClothSurface garment(sewn, ColourBy::kLook);
  ASSERT_EQ(garment.vertexCount(), 6u);
  garment.setLooks(looks(brightAlongWeft()));
  garment.setEye(along_weft);
  garment.take(squareState(1.0));
  EXPECT_GT(garment.colours()[garment.triangles()[0]][0], 200);
  EXPECT_LT(garment.colours()[garment.triangles()[3]][0], 50);
}

TEST(ClothSurface, RefusesAnotherNumberOfLooks) {
  ClothSurface surface(squareMesh(), ColourBy::kLook);
  EXPECT_EQ(test::refusalOf([&] { surface.setLooks({}); }),
            "there are 0 looks of 1 fabrics: allowed is one each");
  ClothSurface by_strain(squareMesh(), ColourBy::kStrain);
  EXPECT_EQ(test::refusalOf([&] { by_strain.setLooks(looks(white())); }),
            "the colours are of no look");
}

TEST(ClothSurface, FabricsMeetInASharpEdge) {
  haptex::ClothMesh mesh = squareMesh();
  mesh.fabrics = {"linear", "linear"};
  mesh.fabric_files = {linearFabric(), linearFabric()};
  mesh.triangle_fabrics = {0, 1};
  ClothSurface surface(mesh, ColourBy::kFabric);
  EXPECT_EQ(surface.vertexCount(), 6u) << "the two common particles twice";
  EXPECT_EQ(surface.groups().size(), 2u);
  surface.take(squareState(1.0));
  const std::vector<std::uint32_t>& vertices = surface.triangles();
  ASSERT_EQ(vertices.size(), 6u);
  for (std::size_t corner = 0; corner < 6; ++corner) {
    const Eigen::Vector3f colour = distinctColour(corner < 3 ? 0 : 1);
    EXPECT_EQ(surface.colours()[vertices[corner]], shaded(colour, Eigen::Vector3d::UnitX()));
  }
}

TEST(ClothSurface, PanelsArePartsThatNoTriangleJoins) {
  haptex::ClothMesh mesh = squareMesh();
  mesh.rest_weft_coordinates.insert(mesh.rest_weft_coordinates.end(), {2.0, 3.0, 2.0});
  mesh.rest_warp_coordinates.insert(mesh.rest_warp_coordinates.end(), {0.0, 0.0, 1.0});
  mesh.triangles.insert(mesh.triangles.end(), {4, 5, 6});
  const ClothSurface surface(mesh, ColourBy::kPanel);
  EXPECT_EQ(surface.groups(), (std::vector<std::string>{"panel 0", "panel 1"}));
}

TEST(ClothSurface, GrainLinesRunAlongWeftAndWarpOnce) {
  const ClothSurface surface(squareMesh(), ColourBy::kStrain);
  EXPECT_EQ(surface.grainLines().size(), 2u * 4u) << "the square's sides, and not its diagonal";
}

TEST(ClothSurface, WhatIsLeftOutIsGreyAndNotMarkedAsAttached) {
  ClothSurface surface(squareMesh(), ColourBy::kStrain);
  haptex::ClothState state = squareState(1.002);
  state.attached = {0, 3, 77};
  state.excluded = {3};
  surface.take(state);
  EXPECT_EQ(surface.attached(state).size(), 1u);
  const Eigen::Vector3f grey(0.62F, 0.62F, 0.62F);
  const std::set<VertexColour> colours(surface.colours().begin(), surface.colours().end());
  EXPECT_EQ(colours.count(shaded(grey, Eigen::Vector3d::UnitX())), 1u);
}

std::string refusalOf(const haptex::ClothMesh& mesh, ColourBy colour_by = ColourBy::kStrain) {
  return test::refusalOf([&] { const ClothSurface surface(mesh, colour_by); });
}

TEST(ClothSurface, RefusesMeshesThatDoNotFitTogether) {
  haptex::ClothMesh mesh = squareMesh();
  mesh.triangles[5] = 4;
  EXPECT_EQ(refusalOf(mesh), "triangles[5] = 4: there are 4 particles");
  mesh = squareMesh();
  mesh.triangle_fabrics = {0, 2};
  EXPECT_EQ(refusalOf(mesh), "triangle_fabrics names fabric 2: there are 1");
  mesh.triangle_fabrics = {0};
  EXPECT_EQ(refusalOf(mesh),
            "triangle_fabrics has 1 elements: allowed are none, or 2, one per triangle");
  mesh = squareMesh();
  mesh.fabric_files = {"name: another"};
  EXPECT_NE(refusalOf(mesh, ColourBy::kStress).find("fabric 'linear' in cloth/mesh"),
            std::string::npos);
  EXPECT_EQ(refusalOf(mesh, ColourBy::kStrain), test::kNotRefused) << "which needs no fabric";
}

TEST(ClothSurface, RefusesStatesThatCannotBeDrawn) {
  ClothSurface surface(squareMesh(), ColourBy::kStrain);
  haptex::ClothState state = squareState(1.0);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e5}) {
    state.positions[2].x = bad;
    EXPECT_THROW(surface.take(state), std::invalid_argument) << bad;
  }
  state = squareState(1.0);
  state.positions.pop_back();
  EXPECT_THROW(surface.take(state), std::invalid_argument);
  state = squareState(1.0);
  state.mesh = 4;
  EXPECT_FALSE(surface.knows(state));
}

TEST(ClothSurface, TrianglesWithoutAreaHaveAColour) {
  haptex::ClothMesh mesh = squareMesh();
  mesh.rest_weft_coordinates = {0.0, 0.0, 0.0, 0.0};
  ClothSurface surface(mesh, ColourBy::kStrain);
  surface.take(squareState(1.0));
  for (const float coordinate : surface.positions()) EXPECT_TRUE(std::isfinite(coordinate));
  ClothSurface look(mesh, ColourBy::kLook);
  look.setLooks(looks(white()));
  look.setEye(Eigen::Vector3d(5.0, 0.5, 0.5));
  look.take(squareState(1.0));
  for (const VertexColour& vertex : look.colours()) EXPECT_GT(vertex[0], 100);
}

}  // namespace
}  // namespace haptex::nodes::test_cloth_surface
