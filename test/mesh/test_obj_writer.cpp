// Cloth written as an OBJ file.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "haptex/mesh/obj_file.h"
#include "haptex/mesh/obj_writer.h"
#include "haptex/mesh/seam.h"

namespace haptex::mesh::test_obj_writer {
namespace {

/// Two squares beside each other, sewn into one mesh.
ClothMesh sewn() {
  ClothMesh both;
  both.panels = {{0, 0.0}, {0, 0.3}};
  for (int panel = 0; panel < 2; ++panel) {
    const ClothMesh one = makeRectangle(0.1, 0.1, 2, 2, Triangulation::kOneWay);
    for (std::size_t i = 0; i < one.rest_coordinates.size(); ++i) {
      both.rest_coordinates.push_back(one.rest_coordinates[i]);
      both.initial_positions.emplace_back(one.initial_positions[i] +
                                          Eigen::Vector3d(0, 0.1 * panel, 0));
    }
    for (const auto& [a, b, c] : one.triangles) {
      both.triangles.push_back({9 * panel + a, 9 * panel + b, 9 * panel + c});
      both.triangle_panels.push_back(panel);
    }
  }
  return merge(both, {{{2, 5, 8}, {9, 12, 15}}}).mesh;
}

std::string written(const ClothMesh& mesh, const std::vector<std::string>& names) {
  std::ostringstream out;
  writeObj(mesh, names, out);
  return out.str();
}

std::string save(const std::string& text) {
  const std::string path = testing::TempDir() + "obj_writer.obj";
  std::ofstream(path) << text;
  return path;
}

TEST(ObjWriter, GivesASheetBackToTheLastBit) {
  ClothMesh sheet = makeRectangle(0.3, 0.7, 3, 5, Triangulation::kAlternating);
  sheet.initial_positions[4] = {1.0 / 3.0, -1e-17, 2e5 / 7.0};
  MeshGroups groups;
  const ClothMesh back = loadObj(save(written(sheet, {"sheet"})), groups);
  EXPECT_EQ(back.initial_positions, sheet.initial_positions);
  EXPECT_EQ(back.triangles, sheet.triangles);
  EXPECT_EQ(back.rest_coordinates, sheet.rest_coordinates);
  EXPECT_EQ(groups.at("sheet").size(), sheet.triangles.size());
}

TEST(ObjWriter, GivesEveryPanelAGroupAndItsOwnRestCoordinates) {
  const ClothMesh mesh = sewn();
  const std::string text = written(mesh, {"left", "right"});
  const ObstacleMesh back = loadObjSurface(save(text));
  EXPECT_EQ(back.vertices, mesh.initial_positions);
  EXPECT_EQ(back.triangles, mesh.triangles);
  EXPECT_NE(text.find("g left\n"), std::string::npos);
  std::istringstream right(text.substr(text.find("g right\n")));
  std::string line;
  int coordinates = 0;
  while (std::getline(right, line)) coordinates += line.rfind("vt ", 0) == 0 ? 1 : 0;
  EXPECT_EQ(coordinates, 9);
}

TEST(ObjWriter, GivesSewnPanelsBackWithTheirSeams) {
  const ClothMesh mesh = sewn();
  MeshGroups groups;
  const ClothMesh back = loadObj(save(written(mesh, {"left", "right"})), groups);
  EXPECT_EQ(groups.at("right").size(), 8u);
  EXPECT_EQ(back.initial_positions, mesh.initial_positions);
  EXPECT_EQ(back.triangles, mesh.triangles);
  EXPECT_EQ(back.triangle_panels, mesh.triangle_panels);
  ASSERT_EQ(back.panelCount(), 2);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) EXPECT_EQ(back.restCorners(t)[i], mesh.restCorners(t)[i]);
  }
  ASSERT_EQ(back.seam_hinges.size(), mesh.seam_hinges.size());
  for (std::size_t h = 0; h < mesh.seam_hinges.size(); ++h) {
    const SeamHinge &hinge = back.seam_hinges[h], &expected = mesh.seam_hinges[h];
    EXPECT_EQ(hinge.triangles, expected.triangles);
    EXPECT_NEAR(hinge.length, expected.length, 1e-15);
    for (int side = 0; side < 2; ++side) {
      EXPECT_LT((hinge.along[side] - expected.along[side]).norm(), 1e-12);
      EXPECT_LT((hinge.inward[side] - expected.inward[side]).norm(), 1e-12);
    }
  }
}

TEST(ObjWriter, RefusesNamesThatAnObjFileCannotHold) {
  const ClothMesh mesh = sewn();
  EXPECT_THROW(written(mesh, {"left"}), std::invalid_argument);
  EXPECT_THROW(written(mesh, {"left", "right sleeve"}), std::invalid_argument);
  EXPECT_THROW(written(mesh, {"left", ""}), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::mesh::test_obj_writer
