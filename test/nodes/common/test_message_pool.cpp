#include <gtest/gtest.h>

#include "haptex/nodes/common/message_pool.h"

namespace haptex::nodes::test_message_pool {
namespace {

TEST(MessagePool, GivesTheSameMessagesInTurnWhileNobodyHoldsThem) {
  MessagePool<int, 2> pool;
  const int* first = pool.next().get();
  const int* second = pool.next().get();
  EXPECT_NE(first, second);
  EXPECT_EQ(pool.next().get(), first);
  EXPECT_EQ(pool.next().get(), second);
}

TEST(MessagePool, LeavesAMessageToWhoeverHoldsIt) {
  MessagePool<int, 2> pool;
  const boost::shared_ptr<int> held = pool.next();
  *held = 7;
  pool.next();
  *pool.next() = 8;
  EXPECT_EQ(*held, 7);
}

}  // namespace
}  // namespace haptex::nodes::test_message_pool
