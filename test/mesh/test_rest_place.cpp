#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "haptex/mesh/rest_place.h"

namespace haptex::mesh::test_rest_place {
namespace {

using Eigen::Vector2d;

TEST(RestPlace, WeightsGiveBackTheCoordinates) {
  const ClothMesh mesh = makeRectangle(0.3, 0.2, 7, 5, Triangulation::kAlternating);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 100; ++i) {
    Vector2d rest(0.3 * uniform(random), 0.2 * uniform(random));
    if (i < 4) rest = {i % 2 == 0 ? 0.0 : 0.3, i < 2 ? 0.0 : 0.2};  // corners
    const std::optional<RestPlace> place = findRestPlace(mesh, rest);
    ASSERT_TRUE(place) << rest.transpose();
    EXPECT_GE(place->weights.minCoeff(), 0.0);
    EXPECT_NEAR(place->weights.sum(), 1.0, 1e-15);
    Vector2d sum = Vector2d::Zero();
    for (int c = 0; c < 3; ++c) {
      sum += place->weights[c] * mesh.rest_coordinates[mesh.triangles[place->triangle][c]];
    }
    EXPECT_LT((sum - rest).norm(), 1e-12);
  }
}

TEST(RestPlace, IsNoneOutsideAndOfOtherTriangles) {
  const ClothMesh mesh = makeRectangle(0.3, 0.2, 7, 5, Triangulation::kOneWay);
  EXPECT_FALSE(findRestPlace(mesh, {0.31, 0.1}));
  EXPECT_FALSE(findRestPlace(mesh, {0.1, -1e-6}));
  EXPECT_FALSE(findRestPlace(mesh, {0.1, std::numeric_limits<double>::quiet_NaN()}));
  EXPECT_FALSE(findRestPlace(mesh, {0, 1}, {0.29, 0.19}));
}

}  // namespace
}  // namespace haptex::mesh::test_rest_place
