// An executable of its own, because it counts every call of malloc in the process.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <vector>

#include "haptex/proximity/rigid_obstacle.h"

namespace {
std::atomic<long> allocations{0};
}

#ifndef __SANITIZE_ADDRESS__  // which brings its own malloc
extern "C" {
void* __libc_malloc(std::size_t size);
void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
}
#endif

namespace haptex::proximity {
namespace {

TEST(ObstacleAllocation, ClosestPointDoesNotAllocate) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;
  for (int i = 0; i < 1000; ++i) vertices.emplace_back(i % 2, i / 2, 0.0);
  for (int i = 0; i + 2 < 1000; ++i) triangles.push_back({i, i + 1, i + 2});
  const std::vector<RigidObstacle> obstacles = {
      RigidObstacle::sphere(1.0), RigidObstacle::box({1.0, 1.0, 1.0}),
      RigidObstacle::capsule(1.0, 1.0), RigidObstacle::mesh(vertices, triangles)};
  const Triangle triangle = {Eigen::Vector3d(3, 0, 2), Eigen::Vector3d(4, 0, 2),
                             Eigen::Vector3d(3, 1, 2)};
  const long before = allocations;
  for (const RigidObstacle& obstacle : obstacles) {
    EXPECT_GT(obstacle.closestPoint(triangle).distance, 0.0);
  }
  EXPECT_EQ(allocations, before);
  EXPECT_GT(before, 0) << "the count does not work";
}

}  // namespace
}  // namespace haptex::proximity
