#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "haptex/base/quantity.h"

namespace haptex::base::test_quantity {
namespace {

TEST(Quantity, FailsBeyondItsToleranceAndOnNaN) {
  EXPECT_TRUE(relativeTo(2.0, "a", 2.0, 2.0002, 1.1e-4).pass());
  EXPECT_FALSE(relativeTo(2.0, "a", 2.0, 2.0002, 0.9e-4).pass());
  EXPECT_FALSE(relativeTo(2.0, "a", 2.0, std::numeric_limits<double>::quiet_NaN(), 1.0).pass());
}

TEST(Quantity, NaNIsNeverHiddenByALargerNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(largerOrNaN(1.0, 2.0), 2.0);
  EXPECT_EQ(largerOrNaN(2.0, 1.0), 2.0);
  EXPECT_TRUE(std::isnan(largerOrNaN(nan, 1.0)));
  EXPECT_TRUE(std::isnan(largerOrNaN(1.0, nan)));
  Quantity worst{"", 0.0, 0.0, -1.0, 1.0};
  for (double measured : {0.1, nan, 0.3})
    keepWorse(worst, relativeTo(1.0, "a", 0.0, measured, 1.0));
  EXPECT_FALSE(worst.pass());
  worst = {"", 0.0, 0.0, -1.0, 1.0};
  for (double measured : {0.1, 0.3, 0.2})
    keepWorse(worst, relativeTo(1.0, "a", 0.0, measured, 1.0));
  EXPECT_EQ(worst.error, 0.3);
}

TEST(Quantity, PrintsSixFieldsSeparatedByTabs) {
  std::ostringstream out;
  print(out, {"room/what", 1.5, 1.25, 0.25, 0.125});
  EXPECT_EQ(out.str(), "room/what\t1.5\t1.25\t0.25\t0.125\tFAIL\n");
}

}  // namespace
}  // namespace haptex::base::test_quantity
