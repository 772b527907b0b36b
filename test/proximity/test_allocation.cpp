// An executable of its own, because it counts every call of malloc in the process.
#include <gtest/gtest.h>

#include "../malloc_counter.h"
#include "fixtures.h"
#include "haptex/proximity/kdop_hierarchy.h"
#include "haptex/proximity/rigid_obstacle.h"
#include "haptex/proximity/self_proximity.h"
#include "haptex/proximity/sky_occlusion.h"

namespace haptex::proximity::test_allocation {
namespace {

TEST(ProximityAllocation, NeitherRefitNorQueryAllocatesAfterTheFirst) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  const mesh::ClothMesh mesh = sheet(20);
  const auto states = oracles::deformedSheets(mesh);
  KdopHierarchy hierarchy(mesh.triangles, restPositions(mesh));
  const Sphere sphere{{0.1, 0.1, 0.0}, 0.02};
  const Cursor cursors[] = {Cursor::point(sphere.centre), Cursor::spheres({sphere, sphere, sphere}),
                            Cursor::capsule(sphere.centre, {0.15, 0.1, 0.0}, 0.01)};
  std::vector<NearElement> found;
  found.reserve(mesh.triangles.size());
  hierarchy.query(cursors[1], {}, found);

  const long before = allocations;
  for (const auto& state : states) {
    hierarchy.refit(state.positions);
    for (const Cursor& cursor : cursors) {
      hierarchy.query(cursor, {0.05}, found);
      hierarchy.query(cursor, {0.05, 9}, found);
    }
  }
  EXPECT_EQ(allocations - before, 0);
}

TEST(ProximityAllocation, SharesOfTheSkyAreComputedWithoutAllocating) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  const mesh::ClothMesh mesh = sheet(8);
  const auto states = oracles::deformedSheets(mesh);
  SkyOcclusion sky(mesh.triangles, restPositions(mesh).size());
  const long before = allocations;
  for (const auto& state : states) sky.compute(state.positions);
  EXPECT_EQ(allocations - before, 0);
}

TEST(ProximityAllocation, ClosestPointOfAnObstacleDoesNotAllocate) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  const mesh::ClothMesh mesh = sheet(20);
  const std::vector<RigidObstacle> obstacles = {
      RigidObstacle::sphere(1.0), RigidObstacle::box({1.0, 1.0, 1.0}),
      RigidObstacle::capsule(1.0, 1.0), RigidObstacle::mesh(restPositions(mesh), mesh.triangles)};
  const Triangle triangle = {Eigen::Vector3d(3, 0, 2), Eigen::Vector3d(4, 0, 2),
                             Eigen::Vector3d(3, 1, 2)};
  const long before = allocations;
  for (const RigidObstacle& obstacle : obstacles) {
    EXPECT_GT(obstacle.closestPoint(triangle).distance, 0.0);
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(before, 0) << "the count does not work";
}

TEST(ProximityAllocation, LookingForSelfPairsDoesNotAllocateOnceItHasSeenAsMany) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  const mesh::ClothMesh mesh = sheet(20);
  KdopHierarchy hierarchy(mesh.triangles, restPositions(mesh));
  SelfProximity self(hierarchy, restPositions(mesh), 0.001);
  std::vector<NearPair> found;
  std::vector<double> bounds;
  const auto states = oracles::deformedSheets(mesh);
  const auto find_all = [&] {
    for (const auto& state : states) {
      hierarchy.refit(state.positions);
      self.find(found, &bounds);
    }
  };
  find_all();
  find_all();  // both halves of the front
  const long before = allocations;
  find_all();
  EXPECT_EQ(allocations - before, 0);
}

}  // namespace
}  // namespace haptex::proximity::test_allocation
