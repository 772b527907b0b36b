#include <gtest/gtest.h>

#include <string>

#include "haptex/material/fabric_file.h"
#include "haptex/nodes/common/cloth_fabric.h"

namespace haptex::nodes::test_cloth_fabric {
namespace {

const std::string kFabrics = std::string(HAPTEX_SOURCE_DIRECTORY) + "/config/fabrics/";

haptex::ClothMesh wool() {
  haptex::ClothMesh message;
  message.fabrics = {"wool"};
  message.fabric_files = {material::loadFabric(kFabrics + "wool.yaml").file};
  return message;
}

std::string refusal(const haptex::ClothMesh& message) {
  try {
    fabricsOfCloth(message);
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

TEST(ClothFabric, IsReadFromTheMessage) {
  const material::Fabric fabric = fabricsOfCloth(wool()).front();
  EXPECT_EQ(fabric.name, "wool");
  EXPECT_GT(fabric.areal_density, 0.0);
}

TEST(ClothFabric, ThatIsMalformedIsRefusedByName) {
  haptex::ClothMesh none;
  EXPECT_NE(refusal(none).find("allowed are 1 to 256 names, and for each its file"),
            std::string::npos);
  haptex::ClothMesh without_file = wool();
  without_file.fabric_files.clear();
  EXPECT_NE(refusal(without_file).find("fabric_files 0"), std::string::npos);
  haptex::ClothMesh another = wool();
  another.fabrics[0] = "denim";
  EXPECT_NE(refusal(another).find("'denim' in cloth/mesh: its file is of the fabric 'wool'"),
            std::string::npos);
  for (const std::string file : {"", "name: [", "name: wool", "- 1"}) {
    haptex::ClothMesh broken = wool();
    broken.fabric_files[0] = file;
    EXPECT_NE(refusal(broken).find("fabric 'wool' in cloth/mesh: "), std::string::npos) << file;
  }
}

TEST(ClothFabric, ThatIsTooLongIsNotRead) {
  haptex::ClothMesh file = wool();
  file.fabric_files[0] += '#' + std::string(kLongestFabricFile, ' ');
  EXPECT_NE(refusal(file).find("fabric_files[0] has "), std::string::npos);
  haptex::ClothMesh name = wool();
  name.fabrics[0] = std::string(kLongestFabricName + 1, 'w');
  EXPECT_NE(refusal(name).find("fabrics[0] has 201 bytes"), std::string::npos);
}

}  // namespace
}  // namespace haptex::nodes::test_cloth_fabric
