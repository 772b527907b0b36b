#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "fixtures.h"
#include "haptex/proximity/kdop_hierarchy.h"
#include "haptex/proximity/rigid_obstacle.h"

namespace haptex::proximity::test_obstacle_query {
namespace {

using Eigen::Vector3d;

std::vector<RigidObstacle> obstaclesOfEveryKind(double size) {
  return {RigidObstacle::sphere(size), RigidObstacle::box({size, 2.0 * size, 3.0 * size}),
          RigidObstacle::capsule(0.5 * size, 3.0 * size),
          RigidObstacle::mesh({{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}},
                              {{0, 1, 2}, {0, 1, 3}, {1, 2, 3}})};
}

/// Triangles within a distance, nearest first.
std::vector<std::pair<double, int>> byBruteForce(const KdopHierarchy& hierarchy,
                                                 const RigidObstacle& obstacle, double distance) {
  std::vector<std::pair<double, int>> near;
  for (int i = 0; i < static_cast<int>(hierarchy.triangles().size()); ++i) {
    const double of_triangle = obstacle.closestPoint(hierarchy.triangle(i)).distance;
    if (of_triangle <= distance) near.emplace_back(of_triangle, i);
  }
  std::sort(near.begin(), near.end());
  return near;
}

void expectSame(const std::vector<NearElement>& found,
                const std::vector<std::pair<double, int>>& exact) {
  ASSERT_EQ(found.size(), exact.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].distance, exact[i].first);
    EXPECT_EQ(found[i].triangle, exact[i].second);
  }
}

TEST(ObstacleQuery, AnswersAreThoseOfBruteForceInEveryState) {
  const mesh::ClothMesh mesh = sheet(10);
  KdopHierarchy hierarchy(mesh.triangles, restPositions(mesh));
  std::vector<NearElement> found;
  int some = 0;
  for (const auto& state : oracles::deformedSheets(mesh)) {
    hierarchy.refit(state.positions);
    const double size = (hierarchy.triangle(0)[0] - hierarchy.triangle(0)[1]).norm() + 1e-9;
    RandomCursors places(state.positions, 3.0 * size, 5);
    for (RigidObstacle& obstacle : obstaclesOfEveryKind(2.0 * size)) {
      for (int i = 0; i < 5; ++i) {
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.linear() = Eigen::Quaterniond::UnitRandom().toRotationMatrix();
        pose.translation() = places.next().parts()[0].begin.centre;
        obstacle.setPose(pose);
        const auto exact = byBruteForce(hierarchy, obstacle, size);
        query(hierarchy, obstacle, {size}, found);
        expectSame(found, exact);
        some += !exact.empty();

        const auto all = byBruteForce(hierarchy, obstacle, std::numeric_limits<double>::infinity());
        query(hierarchy, obstacle, {std::numeric_limits<double>::infinity(), 7}, found);
        expectSame(found, {all.begin(), all.begin() + 7});
      }
    }
  }
  EXPECT_GT(some, 200);
}

TEST(ObstacleQuery, TellsTheNearestPointOfTheElement) {
  const KdopHierarchy hierarchy({{0, 1, 2}}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  RigidObstacle ball = RigidObstacle::sphere(0.5);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Vector3d(0.25, 0.25, 2.0);
  ball.setPose(pose);
  std::vector<NearElement> found;
  query(hierarchy, ball, {1.5}, found);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_DOUBLE_EQ(found[0].distance, 1.5);
  EXPECT_LT((found[0].point - Vector3d(0.25, 0.25, 0.0)).norm(), 1e-15);
  EXPECT_EQ(found[0].normal, Vector3d(0, 0, 1));
  query(hierarchy, ball, {1.4}, found);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace haptex::proximity::test_obstacle_query
