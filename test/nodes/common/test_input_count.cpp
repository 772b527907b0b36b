#include <gtest/gtest.h>
#include <ros/time.h>

#include <stdexcept>

#include "haptex/nodes/common/input_count.h"

namespace haptex::nodes::test_input_count {
namespace {

TEST(InputCount, TellsWhatWasTakenAndWhyTheLastWasRefused) {
  ros::Time::init();  // of warnings
  InputCount count;
  EXPECT_EQ(count.status().taken, 0u);
  count.count("topic", [] {});
  count.count("topic", [] { throw std::invalid_argument("first"); });
  count.count("topic", [] { throw std::invalid_argument("second"); });
  count.count("topic", [] {});
  EXPECT_EQ(count.status().taken, 2u);
  EXPECT_EQ(count.status().refused, 2u);
  EXPECT_EQ(count.status().refused_from, "topic");
  EXPECT_EQ(count.status().refused_why, "second");
}

}  // namespace
}  // namespace haptex::nodes::test_input_count
