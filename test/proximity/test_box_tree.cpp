#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "haptex/proximity/box_tree.h"

namespace haptex::proximity::test_box_tree {
namespace {

using Eigen::Vector3d;
using Box = BoxTree::Box;

Box anyBox(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> any(-1.0, 1.0), side(0.0, size);
  const Vector3d least(any(random), any(random), any(random));
  return {least, least + Vector3d(side(random), side(random), side(random))};
}

TEST(BoxTree, VisitsAllPartsThatReachIntoABoxAndNoOthersAlsoAfterTheyMoved) {
  std::mt19937 random(3);
  for (const int count : {1, 2, 7, 100}) {
    std::vector<Box> parts;
    for (int i = 0; i < count; ++i) parts.push_back(anyBox(random, 0.2));
    BoxTree tree(parts);
    for (int round = 0; round < 50; ++round) {
      const Box within = anyBox(random, 0.5);
      std::vector<int> expected, found;
      for (int i = 0; i < count; ++i) {
        if (parts[i].intersects(within)) expected.push_back(i);
      }
      tree.visit(within, [&](int part) { found.push_back(part); });
      std::sort(found.begin(), found.end());
      EXPECT_EQ(found, expected);
      for (Box& part : parts) part = anyBox(random, 0.2);
      tree.refit(parts);
      for (const Box& part : parts) EXPECT_TRUE(tree.box().contains(part));
    }
  }
}

TEST(BoxTree, NeedsAPart) { EXPECT_THROW(BoxTree({}), std::invalid_argument); }

}  // namespace
}  // namespace haptex::proximity::test_box_tree
