#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "haptex/material/fabric_file.h"
#include "haptex/nodes/force_renderer/layer_builder.h"
#include "haptex/scene/scene.h"

namespace haptex::nodes::test_layer_builder {
namespace {

const std::string kConfig = std::string(HAPTEX_SOURCE_DIRECTORY) + "/config/";
const std::string kScene = kConfig + "scenes/wool_sample.yaml";

haptex::ClothMesh message(const std::string& fabric, int cells = 4) {
  const mesh::ClothMesh mesh =
      mesh::makeRectangle(0.2, 0.2, cells, cells, mesh::Triangulation::kOneWay);
  haptex::ClothMesh message;
  message.fabrics = {fabric};
  message.fabric_files = {material::loadFabric(kConfig + "fabrics/" + fabric + ".yaml").file};
  for (const Eigen::Vector2d& rest : mesh.rest_coordinates) {
    message.rest_weft_coordinates.push_back(rest.x());
    message.rest_warp_coordinates.push_back(rest.y());
  }
  for (const auto& triangle : mesh.triangles) {
    message.triangles.insert(message.triangles.end(), triangle.begin(), triangle.end());
  }
  return message;
}

std::string refusal(const haptex::ClothMesh& message) {
  try {
    LayerBuilder(kScene).build(message);
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

TEST(LayerBuilder, MakesALayerOfTheFabricInTheMessage) {
  const auto layer = LayerBuilder(kScene).build(message("wool"));
  ASSERT_NE(layer, nullptr);
  EXPECT_EQ(layer->settings().layer, contact::HapticSettings::Layer::kPatch);
  EXPECT_NE(layer->preparePatch({0, 1}, std::vector<char>(25, 0)), nullptr);
}

TEST(LayerBuilder, MakesALayerOfAnotherFabricThanTheScenes) {
  const LayerBuilder builder(kScene);
  const auto wool = builder.build(message("wool"));
  const auto knit = builder.build(message("cotton_knit"));
  EXPECT_NE(wool->law().halfThickness(), knit->law().halfThickness());
}

TEST(LayerBuilder, MakesALayerOfTheFabricsOfRegions) {
  haptex::ClothMesh hemmed = message("wool");
  const haptex::ClothMesh denim = message("denim");
  hemmed.fabrics.push_back(denim.fabrics[0]);
  hemmed.fabric_files.push_back(denim.fabric_files[0]);
  hemmed.triangle_fabrics.assign(32, 0);
  hemmed.triangle_fabrics[5] = 1;
  const auto layer = LayerBuilder(kScene).build(hemmed);
  EXPECT_NE(layer->law(0).halfThickness(), layer->law(1).halfThickness());
  hemmed.triangle_fabrics[7] = 2;
  EXPECT_NE(refusal(hemmed).find("triangle_fabrics[7] = 2: there are 2 fabrics"),
            std::string::npos);
  hemmed.triangle_fabrics.resize(31);
  EXPECT_NE(refusal(hemmed).find("triangle_fabrics has 31 elements: allowed are none, or one per "
                                 "triangle, of which there are 32"),
            std::string::npos);
  hemmed.triangle_fabrics.clear();
  hemmed.fabric_files.pop_back();
  EXPECT_NE(refusal(hemmed).find("fabrics has 2 elements and fabric_files 1"), std::string::npos);
}

TEST(LayerBuilder, MakesALayerOfAnotherMesh) {
  const auto layer = LayerBuilder(kScene).build(message("wool", 2));
  EXPECT_THROW(layer->preparePatch({31}, std::vector<char>(9, 0)), std::invalid_argument);
  EXPECT_NE(layer->preparePatch({7}, std::vector<char>(9, 0)), nullptr);
}

TEST(LayerBuilder, NamesTheFabricThatItCannotRead) {
  haptex::ClothMesh broken = message("wool");
  broken.fabric_files[0] = "name: wool";
  EXPECT_NE(refusal(broken).find("fabric 'wool' in cloth/mesh"), std::string::npos);
}

TEST(LayerBuilder, RefusesGravityThatIsNotANumber) {
  haptex::ClothMesh broken = message("wool");
  broken.gravity.z = std::nan("");
  EXPECT_NE(refusal(broken).find("gravity"), std::string::npos) << refusal(broken);
}

TEST(LayerBuilder, RefusesAMeshWithDefects) {
  haptex::ClothMesh broken = message("wool");
  broken.triangles[0] = 1000;
  EXPECT_NE(refusal(broken).find("1000"), std::string::npos);
}

}  // namespace
}  // namespace haptex::nodes::test_layer_builder
