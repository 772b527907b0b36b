// The garments that come with the package as drape_garment left them, on their figure.
#include <gtest/gtest.h>

#include <string>

#include "haptex/garment/placement/overlaps.h"
#include "haptex/mesh/obj_file.h"

namespace haptex::dressing::test_worn_garments {
namespace {

const std::string kMeshes = HAPTEX_CONFIG_DIRECTORY "/meshes/";

class WornGarment : public testing::TestWithParam<const char*> {};

TEST_P(WornGarment, IntersectsNeitherItselfNorTheFigure) {
  const mesh::ClothMesh cloth = mesh::loadObj(kMeshes + GetParam() + ".obj");
  const mesh::ObstacleMesh figure = mesh::loadObjSurface(kMeshes + "figure.obj");
  EXPECT_TRUE(garment::findOverlaps(cloth, figure.vertices, figure.triangles).empty());
}

INSTANTIATE_TEST_SUITE_P(, WornGarment,
                         testing::Values("tshirt", "skirt", "shirt_over_trousers",
                                         "shirt_in_trousers", "jacket"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace haptex::dressing::test_worn_garments
