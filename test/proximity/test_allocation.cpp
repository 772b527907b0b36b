// An executable of its own, because it counts every call of malloc in the process.
#include <gtest/gtest.h>

#include "../malloc_counter.h"
#include "fixtures.h"
#include "haptex/proximity/kdop_hierarchy.h"

namespace haptex::proximity {
namespace {

TEST(ProximityAllocation, NeitherRefitNorQueryAllocatesAfterTheFirst) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  const cloth::ClothMesh mesh = sheet(20);
  const auto states = evaluation::deformedSheets(mesh);
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

}  // namespace
}  // namespace haptex::proximity
