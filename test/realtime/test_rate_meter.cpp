#include <gtest/gtest.h>

#include <cmath>

#include "haptex/realtime/rate_meter.h"

namespace haptex::realtime::test_rate_meter {
namespace {

using namespace std::chrono_literals;

TEST(RateMeter, CountsPerSecondOnceASecondHasPassed) {
  RateMeter meter;
  EXPECT_TRUE(std::isnan(meter.update(100, 1s)));
  EXPECT_TRUE(std::isnan(meter.update(500, 1500ms)));
  EXPECT_DOUBLE_EQ(meter.update(1100, 2s), 1000.0);
  EXPECT_DOUBLE_EQ(meter.update(1200, 2500ms), 1000.0) << "the last one until the next";
  EXPECT_DOUBLE_EQ(meter.update(1300, 4s), 100.0);
}

}  // namespace
}  // namespace haptex::realtime::test_rate_meter
