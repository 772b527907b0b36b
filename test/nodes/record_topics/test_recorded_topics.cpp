#include <gtest/gtest.h>

#include <regex>

#include "haptex/nodes/record_topics/bag_recorder.h"

namespace haptex::nodes::test_recorded_topics {
namespace {

TEST(RecordedTopics, AreWholeNamesOrThoseWithinTheNamespace) {
  const RecordedTopics topics{
      {std::regex("haptex/.*"), std::regex("/tf")}, {std::regex("haptex/emulator/.*")}, "/left"};
  EXPECT_TRUE(topics.match("/left/haptex/cloth/state"));
  EXPECT_TRUE(topics.match("/tf"));
  EXPECT_FALSE(topics.match("/left/haptex/emulator/phase"));
  EXPECT_FALSE(topics.match("/right/haptex/cloth/state"));
  EXPECT_FALSE(topics.match("/haptex/cloth/state"));
  EXPECT_FALSE(topics.match("/lefthaptex/cloth"));
}

TEST(RecordedTopics, OfTheRootAreWithinItToo) {
  const RecordedTopics topics{{std::regex("haptex/.*"), std::regex("/other/.*")}, {}, "/"};
  EXPECT_TRUE(topics.match("/haptex/cloth/state"));
  EXPECT_TRUE(topics.match("/other/topic"));
  EXPECT_FALSE(topics.match("/left/haptex/cloth/state"));
}

}  // namespace
}  // namespace haptex::nodes::test_recorded_topics
