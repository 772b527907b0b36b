#include <gtest/gtest.h>

#include "haptex/base/checksum.h"

namespace haptex::base::test_checksum {
namespace {

TEST(Checksum, IsThatOfFnv1a) {
  // Of the reference implementation by Fowler, Noll and Vo.
  EXPECT_EQ(digitsOf(checksum("")), "cbf29ce484222325");
  EXPECT_EQ(digitsOf(checksum("a")), "af63dc4c8601ec8c");
  EXPECT_EQ(digitsOf(checksum("foobar")), "85944171f73967e8");
}

TEST(Checksum, GoesOnWhereAnotherEnded) {
  EXPECT_EQ(checksum("bar", checksum("foo")), checksum("foobar"));
}

}  // namespace
}  // namespace haptex::base::test_checksum
