#include <gtest/gtest.h>

#include <string>

#include "haptex/nodes/force_renderer/layer_builder.h"
#include "haptex/scene/scene.h"

namespace haptex::nodes::test_layer_builder {
namespace {

const std::string kScene = std::string(HAPTEX_SOURCE_DIRECTORY) + "/config/scenes/wool_sample.yaml";

haptex::ClothMesh message(const std::string& fabric, int cells = 4) {
  const mesh::ClothMesh mesh =
      mesh::makeRectangle(0.2, 0.2, cells, cells, mesh::Triangulation::kOneWay);
  haptex::ClothMesh message;
  message.fabric = fabric;
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

TEST(LayerBuilder, MakesALayerOfTheScenesFabric) {
  const auto layer = LayerBuilder(kScene).build(message("wool"));
  ASSERT_NE(layer, nullptr);
  EXPECT_EQ(layer->settings().layer, contact::HapticSettings::Layer::kPatch);
  EXPECT_NE(layer->preparePatch({0, 1}, std::vector<char>(25, 0)), nullptr);
}

TEST(LayerBuilder, MakesALayerOfAnotherFabricOfThePackageByItsName) {
  const LayerBuilder builder(kScene);
  const auto wool = builder.build(message("wool"));
  const auto knit = builder.build(message("cotton_knit"));
  EXPECT_NE(wool->law().halfThickness(), knit->law().halfThickness());
}

TEST(LayerBuilder, MakesALayerOfAnotherMesh) {
  const auto layer = LayerBuilder(kScene).build(message("wool", 2));
  EXPECT_THROW(layer->preparePatch({31}, std::vector<char>(9, 0)), std::invalid_argument);
  EXPECT_NE(layer->preparePatch({7}, std::vector<char>(9, 0)), nullptr);
}

TEST(LayerBuilder, NamesTheFabricThatItCannotLoad) {
  for (const std::string fabric : {"no_such_fabric", "../fabrics/wool", ""}) {
    const std::string why = refusal(message(fabric));
    EXPECT_NE(why.find("'" + fabric + "'"), std::string::npos) << fabric << ": " << why;
  }
}

TEST(LayerBuilder, RefusesAMeshWithDefects) {
  haptex::ClothMesh broken = message("wool");
  broken.triangles[0] = 1000;
  EXPECT_NE(refusal(broken).find("1000"), std::string::npos);
}

}  // namespace
}  // namespace haptex::nodes::test_layer_builder
