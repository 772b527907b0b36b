#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

#include "haptex/contact/obstacles/obstacles.h"
#include "haptex/scene/scene.h"

namespace haptex::contact::test_obstacles {
namespace {

const std::string kScene = HAPTEX_CONFIG_DIRECTORY "/scenes/wool_among_obstacles.yaml";

// The gaps that the comments of the scene promise, computed from its numbers by hand: the sample is
// flat in x = 0 when the scene starts, from y = -0.1 to 0.1 and z = -0.2 to 0.
TEST(MakeObstacle, ShippedObstaclesAreAsFarFromTheFlatSampleAsTheSceneSays) {
  const scene::Scene scene = scene::loadScene(kScene);
  const std::map<std::string, double> expected = {
      {"table", 0.01}, {"ball", 0.02}, {"post", 0.005}, {"shelf", 0.01}};
  for (const mesh::Obstacle& obstacle : scene.obstacles) {
    const proximity::RigidObstacle made = makeObstacle(obstacle);
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [a, b, c] : scene.mesh.triangles) {
      const auto& places = scene.mesh.initial_positions;
      least = std::min(least, made.closestPoint({places[a], places[b], places[c]}).distance);
    }
    EXPECT_NEAR(least, expected.at(obstacle.name), 1e-15) << obstacle.name;
  }
}

TEST(MakeObstacle, TakesThePose) {
  mesh::Obstacle post{"post", mesh::ObstacleCapsule{0.1, 2.0}, Eigen::Isometry3d::Identity()};
  post.pose.translation() = Eigen::Vector3d(0, 3, 0);
  post.pose.linear() = Eigen::AngleAxisd(std::asin(1.0), Eigen::Vector3d::UnitX()).matrix();
  // The segment along z lies along y now: it reaches from 2 to 4.
  EXPECT_NEAR(makeObstacle(post).support(Eigen::Vector3d::UnitY()), 4.1, 1e-15);
  EXPECT_NEAR(makeObstacle(post).support(Eigen::Vector3d::UnitZ()), 0.1, 1e-15);
}

TEST(MakeObstacle, RefusesWhatTheSceneFileWouldNotHaveLetThrough) {
  const mesh::Obstacle ball{"ball", mesh::ObstacleSphere{-1.0}, Eigen::Isometry3d::Identity()};
  EXPECT_THROW(makeObstacle(ball), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::contact::test_obstacles
