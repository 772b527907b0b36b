#include <gtest/gtest.h>

#include "haptex/base/disjoint_sets.h"

namespace haptex::base::test_disjoint_sets {
namespace {

TEST(DisjointSets, KnowWhatWasJoinedThroughOthersAndNothingElse) {
  DisjointSets sets(6);
  EXPECT_EQ(sets.root(3), 3);
  sets.join(4, 1);
  sets.join(1, 5);
  sets.join(5, 4);
  sets.join(0, 2);
  for (const int item : {1, 4, 5}) EXPECT_EQ(sets.root(item), 4);
  for (const int item : {0, 2}) EXPECT_EQ(sets.root(item), 0);
  EXPECT_EQ(sets.root(3), 3);
}

}  // namespace
}  // namespace haptex::base::test_disjoint_sets
