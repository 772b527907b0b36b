#include <gtest/gtest.h>

#include "haptex/nodes/patch_triangles.h"

namespace haptex::nodes {
namespace {

constexpr double kSlack = 2e-3;

TEST(PatchTriangles, BeginsEmptyAndStaysSoFarFromTheCloth) {
  PatchTriangles set(kSlack);
  EXPECT_FALSE(set.update({}));
  EXPECT_TRUE(set.triangles().empty());
  EXPECT_FALSE(set.update({{3, 1.9e-3}}));  // within the slack only: none that has to be there
}

TEST(PatchTriangles, ReachesToHalfTheSlackSortedAndEachOnce) {
  PatchTriangles set(kSlack);
  EXPECT_TRUE(set.update({{7, -1e-3}, {2, 0.9e-3}, {5, 1.1e-3}, {7, -2e-3}, {2, 0.5e-3}}));
  EXPECT_EQ(set.triangles(), (std::vector<int>{2, 7}));
}

TEST(PatchTriangles, DoesNotChangeWhileTrianglesMoveWithinTheSlack) {
  PatchTriangles set(kSlack);
  ASSERT_TRUE(set.update({{1, -1e-3}, {2, 0.5e-3}, {3, 1.5e-3}}));
  for (const double move : {1e-6, -1e-6, 0.4e-3, 0.9e-3, -0.4e-3}) {
    EXPECT_FALSE(set.update({{1, -1e-3 + move}, {2, 0.5e-3 + move}, {3, 1.5e-3 + move}})) << move;
    EXPECT_EQ(set.triangles(), (std::vector<int>{1, 2}));
  }
}

TEST(PatchTriangles, ChangesWhenATriangleIsMissing) {
  PatchTriangles set(kSlack);
  ASSERT_TRUE(set.update({{1, -1e-3}, {3, 1.5e-3}}));
  EXPECT_FALSE(set.update({{1, -1e-3}, {3, 1e-9}}));
  EXPECT_TRUE(set.update({{1, -1e-3}, {3, 0.0}}));
  EXPECT_EQ(set.triangles(), (std::vector<int>{1, 3}));
}

TEST(PatchTriangles, ChangesWhenATriangleIsTooFarAway) {
  PatchTriangles set(kSlack);
  ASSERT_TRUE(set.update({{1, -1e-3}, {2, 0.5e-3}}));
  EXPECT_FALSE(set.update({{1, -1e-3}, {2, kSlack}}));
  EXPECT_TRUE(set.update({{1, -1e-3}}));
  EXPECT_EQ(set.triangles(), (std::vector<int>{1}));
}

TEST(PatchTriangles, AFingerThatSwingsByLessThanHalfTheSlackChangesItOnce) {
  PatchTriangles set(kSlack);
  int changes = 0;
  for (int i = 0; i < 100; ++i) {
    const double move = i % 2 == 0 ? 0.45e-3 : -0.45e-3;
    std::vector<NearTriangle> found;
    for (int triangle = 0; triangle < 100; ++triangle) {
      const double excess = -5e-3 + 1e-4 * triangle + move;
      if (excess <= kSlack) found.push_back({triangle, excess});
    }
    changes += set.update(found) ? 1 : 0;
  }
  EXPECT_EQ(changes, 1);
}

}  // namespace
}  // namespace haptex::nodes
