#include <gtest/gtest.h>

#include "haptex/nodes/force_renderer/subscriber_names.h"

namespace haptex::nodes::test_subscriber_names {
namespace {

TEST(SubscriberNames, AreAllAmongOthersWhereThereAreNone) {
  EXPECT_TRUE(SubscriberNames().areAllAmong(SubscriberNames()));
}

TEST(SubscriberNames, FindsTheOneWhoTakesOnlyThisTopic) {
  SubscriberNames single, both;
  single.joined("/driver");
  EXPECT_FALSE(single.areAllAmong(both));
  both.joined("/driver");
  both.joined("/another");
  EXPECT_TRUE(single.areAllAmong(both));
  single.joined("/observer");
  EXPECT_FALSE(single.areAllAmong(both));
  single.left("/observer");
  EXPECT_TRUE(single.areAllAmong(both));
  both.left("/driver");
  EXPECT_FALSE(single.areAllAmong(both));
}

TEST(SubscriberNames, CountsTwoSubscriptionsOfANode) {
  SubscriberNames single, both;
  both.joined("/driver");
  both.joined("/driver");
  both.left("/driver");
  single.joined("/driver");
  EXPECT_TRUE(single.areAllAmong(both));
  both.left("/driver");
  both.left("/driver");  // not there
  EXPECT_FALSE(single.areAllAmong(both));
}

}  // namespace
}  // namespace haptex::nodes::test_subscriber_names
