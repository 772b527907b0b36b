#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "../cloth/fixtures.h"
#include "haptex/contact/obstacles/obstacles.h"
#include "haptex/contact/obstacles/start_outside.h"
#include "haptex/proximity/element_pair.h"

namespace haptex::contact::test_start_outside {
namespace {

using cloth::placedAt;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using mesh::Obstacle;

/// In the plane x = 0, the middle of its top edge in the origin. Its cells are 6.25 mm wide.
mesh::ClothMesh sheet() {
  return mesh::makeRectangle(0.2, 0.2, 32, 32, mesh::Triangulation::kAlternating);
}

/// The surface of a box, turned outwards.
mesh::ObstacleMesh boxSurface(const Vector3d& sides) {
  mesh::ObstacleMesh surface;
  for (int corner = 0; corner < 8; ++corner) {
    surface.vertices.push_back(
        0.5 * sides.cwiseProduct(Vector3d(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0,
                                          corner & 4 ? 1.0 : -1.0)));
  }
  surface.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                       {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return surface;
}

int firstTouching(const mesh::ClothMesh& mesh, const proximity::RigidObstacle& shape) {
  return contact::firstTouching(mesh.triangles, mesh.initial_positions, shape);
}

/// Largest change of an edge's length, over that length.
double longestStretch(const mesh::ClothMesh& before, const mesh::ClothMesh& after) {
  double most = 0.0;
  for (const auto& [a, b] : proximity::MeshElements(before.triangles).edges) {
    const double length = (before.initial_positions[b] - before.initial_positions[a]).norm();
    const double now = (after.initial_positions[b] - after.initial_positions[a]).norm();
    most = std::max(most, std::abs(now / length - 1.0));
  }
  return most;
}

/// Each reaches through the middle of the sheet by some millimetres.
std::vector<Obstacle> reachingObstacles() {
  const Vector3d sides(0.05, 0.04, 0.03);
  const Isometry3d turned =
      placedAt({-0.025, 0.01, -0.1}) * Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized());
  return {{"sphere", mesh::ObstacleSphere{0.04}, placedAt({-0.03, 0.0, -0.1})},
          {"box", mesh::ObstacleBox{sides}, turned},
          {"surface", boxSurface(sides), turned},
          {"capsule", mesh::ObstacleCapsule{0.01, 0.08},
           placedAt({-0.005, 0.0, -0.1}) * Eigen::AngleAxisd(0.4, Vector3d::UnitX())}};
}

TEST(StartOutside, LeadsOutOfEveryKindOfObstacle) {
  for (const Obstacle& obstacle : reachingObstacles()) {
    SCOPED_TRACE(obstacle.name);
    const mesh::ClothMesh before = sheet();
    mesh::ClothMesh after = before;
    const auto shape = makeObstacle(obstacle);
    const int first = firstTouching(before, shape);
    ASSERT_GE(first, 0);
    const StartMove move = moveOutside(after, {obstacle}, {});
    EXPECT_EQ(move.triangle, first);
    EXPECT_EQ(move.obstacle, obstacle.name);
    EXPECT_GT(move.particles, 0);
    EXPECT_GT(move.longest, 0.001);
    EXPECT_LT(move.longest, 0.04);
    EXPECT_LT(firstTouching(after, shape), 0);
    EXPECT_LT(longestStretch(before, after), 0.1);
    for (const int corner : {0, 32, 32 * 33, 33 * 33 - 1}) {
      EXPECT_LT((after.initial_positions[corner] - before.initial_positions[corner]).norm(), 1e-3);
    }
  }
}

TEST(StartOutside, LeavesWhatTouchesNothingToTheBit) {
  const mesh::ClothMesh before = sheet();
  mesh::ClothMesh after = before;
  const StartMove move =
      moveOutside(after, {{"ball", mesh::ObstacleSphere{0.04}, placedAt({0.0401, 0.0, -0.1})}}, {});
  EXPECT_EQ(move.triangle, -1);
  EXPECT_EQ(move.particles, 0);
  EXPECT_EQ(after.initial_positions, before.initial_positions);
}

TEST(StartOutside, TakesTheSideOfAMeshOnWhichMostOfTheClothIs) {
  // A sheet in a closed case, of which one edge looks out.
  const Obstacle cage{"cage", boxSurface({0.1, 0.3, 0.21}), placedAt({0.0, 0.0, -0.110})};
  mesh::ClothMesh mesh = sheet();
  ASSERT_GE(firstTouching(mesh, makeObstacle(cage)), 0);
  const StartMove move = moveOutside(mesh, {cage}, {});
  EXPECT_GT(move.particles, 0);
  for (const Vector3d& place : mesh.initial_positions) EXPECT_LT(place.z(), -0.005);
  EXPECT_LT(firstTouching(mesh, makeObstacle(cage)), 0);
}

TEST(StartOutside, MovesNothingWhereItLeadsNowhere) {
  const Isometry3d across =
      placedAt({0.0, 0.003, -0.103}) * Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY());
  const mesh::ClothMesh before = sheet();
  const std::vector<int> held = {16 * 33 + 16};  // in the middle
  const std::vector<std::pair<Obstacle, std::vector<int>>> cases = {
      {{"needle", mesh::ObstacleCapsule{5e-4, 0.05}, across}, {}},
      {{"plate",
        mesh::ObstacleMesh{{{-0.02, 0.0, -0.12}, {0.02, 0.0, -0.12}, {0.0, 0.0, -0.08}},
                           {{0, 1, 2}}},
        Isometry3d::Identity()},
       {}},
      {{"ball", mesh::ObstacleSphere{0.04}, placedAt({-0.03, 0.0, -0.1})}, held}};
  for (const auto& [obstacle, its_held] : cases) {
    SCOPED_TRACE(obstacle.name);
    mesh::ClothMesh after = before;
    const StartMove move = moveOutside(after, {obstacle}, its_held);
    EXPECT_GE(move.triangle, 0);
    EXPECT_EQ(move.particles, 0);
    EXPECT_EQ(after.initial_positions, before.initial_positions);
  }
}

}  // namespace
}  // namespace haptex::contact::test_start_outside
