#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "haptex/dressing/lay_garment.h"
#include "haptex/garment/body/body_file.h"
#include "haptex/garment/pattern/pattern_file.h"
#include "haptex/mesh/obj_file.h"

namespace haptex::dressing::test_lay_garment {
namespace {

constexpr double kEdge = 0.05;  // m

std::string shipped(const std::string& file) { return HAPTEX_CONFIG_DIRECTORY "/" + file; }

TEST(LayGarment, PlacesPanelsAsTheirFileSaysBesideASurface) {
  const LaidGarment laid =
      layGarment(shipped("garments/shirt.yaml"), shipped("meshes/figure.obj"), kEdge);
  const garment::GarmentMesh expected =
      garment::makeGarmentMesh(garment::loadPattern(shipped("garments/shirt.yaml")), kEdge);
  EXPECT_EQ(laid.garment.mesh.initial_positions, expected.mesh.initial_positions);
  EXPECT_EQ(laid.body.triangles, mesh::loadObjSurface(shipped("meshes/figure.obj")).triangles);
}

TEST(LayGarment, BendsPanelsOnCarriersAroundABody) {
  const garment::Body body = garment::loadBody(shipped("bodies/woman.yaml"));
  const LaidGarment laid =
      layGarment(shipped("garments/fitted_shirt.yaml"), shipped("bodies/woman.yaml"), kEdge);
  const garment::GarmentMesh expected = garment::makeGarmentMesh(
      garment::loadPattern(shipped("garments/fitted_shirt.yaml")), kEdge, body);
  EXPECT_EQ(laid.garment.mesh.initial_positions, expected.mesh.initial_positions);
  EXPECT_EQ(laid.body.vertices, body.vertices);
  EXPECT_EQ(laid.body.triangles, body.triangles);
}

TEST(LayGarment, RefusesCarriersWithASurfaceThatHasNone) {
  try {
    layGarment(shipped("garments/fitted_shirt.yaml"), shipped("meshes/figure.obj"), kEdge);
    FAIL();
  } catch (const std::invalid_argument& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("is to be laid on the carrier"), std::string::npos)
        << refusal.what();
  }
}

}  // namespace
}  // namespace haptex::dressing::test_lay_garment
