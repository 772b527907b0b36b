#include <gtest/gtest.h>

#include <vector>

#include "haptex/dressing/seam_pull.h"

namespace haptex::dressing {
namespace {

using Eigen::Vector3d;

constexpr double kTension = 20.0;   // N/m
constexpr double kEdge = 0.02;      // m
constexpr double kFarthest = 5e-3;  // m

/// Two triangles, an edge of each along the other's.
garment::GarmentMesh twoTriangles() {
  garment::GarmentMesh garment;
  garment.mesh.rest_coordinates = {{0, 0}, {kEdge, 0}, {0, kEdge}, {0, 0}, {kEdge, 0}, {0, -kEdge}};
  garment.mesh.triangles = {{0, 1, 2}, {3, 5, 4}};
  garment.seams = {{{0, 1}, {3, 4}, {0.0, 1.0}, {0.0, 1.0}}};
  return garment;
}

/// The sides of the seam so far apart (m), and all so far along (m).
std::vector<Vector3d> places(double apart, double along) {
  const double half = 0.5 * apart;
  return {{along, half, 0},  {kEdge + along, half, 0},  {along, kEdge, 0},
          {along, -half, 0}, {kEdge + along, -half, 0}, {along, -kEdge, 0}};
}

TEST(SeamPull, PullsEverySideToTheMiddle) {
  SeamPull pull(twoTriangles(), kTension);
  const auto& loads = pull.loads(places(0.8e-3, 0.0), kFarthest, 1.0);
  ASSERT_EQ(loads.size(), 4u);
  for (const cloth::PointLoad& load : loads) {
    EXPECT_NEAR(load.position.y(), 0.0, 1e-15);
    // Half of the edge is the particle's.
    EXPECT_NEAR(load.stiffness(0, 0) * kFarthest, 0.5 * kEdge * kTension, 1e-12);
  }
  EXPECT_NEAR(pull.gap(places(0.8e-3, 0.0)), 0.4e-3, 1e-15);
}

TEST(SeamPull, ExpectsTheMiddleToGoOnAsFarAsItIsTold) {
  constexpr double kWay = 1e-3;  // m, in a step
  for (const double onwards : {0.0, 0.2, 1.0}) {
    SeamPull pull(twoTriangles(), kTension);
    pull.loads(places(4e-3, 0.0), kFarthest, onwards);
    for (const cloth::PointLoad& load : pull.loads(places(4e-3, kWay), kFarthest, onwards)) {
      const int end = load.triangle == 0 ? 1 : 2;  // corner of the triangle where the edge ends
      const double at = kEdge * load.weights[end];
      EXPECT_NEAR(load.position.x() - at, (1.0 + onwards) * kWay, 1e-15) << onwards;
    }
  }
}

TEST(SeamPull, PullsHarderWhereNothingComesNearerUpTo20Times) {
  SeamPull pull(twoTriangles(), kTension);
  double stiffness = 0.0;
  for (int step = 0; step < 200; ++step) {
    const double before = stiffness;
    stiffness = pull.loads(places(20e-3, 0.0), kFarthest, 0.2).front().stiffness(0, 0);
    EXPECT_GE(stiffness, before);
  }
  EXPECT_NEAR(stiffness * kFarthest, 20.0 * 0.5 * kEdge * kTension, 1e-12);
}

}  // namespace
}  // namespace haptex::dressing
