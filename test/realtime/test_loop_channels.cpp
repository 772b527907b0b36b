// What goes between the loop and other threads, looked at by one thread. test_exoskeleton_threads
// has the threads.
#include <gtest/gtest.h>

#include <thread>

#include "haptex/realtime/ring.h"
#include "haptex/realtime/steady_clock.h"
#include "haptex/realtime/triple_buffer.h"

namespace haptex::realtime::test_loop_channels {
namespace {

using namespace std::chrono_literals;

TEST(TripleBuffer, HandsOverTheNewestValueOnce) {
  TripleBuffer<int> buffer;
  EXPECT_FALSE(buffer.update());
  EXPECT_EQ(buffer.value(), 0);
  buffer.write(1);
  buffer.write(2);
  EXPECT_TRUE(buffer.update());
  EXPECT_EQ(buffer.value(), 2);
  EXPECT_FALSE(buffer.update());
  EXPECT_EQ(buffer.value(), 2);
  for (int i = 3; i < 10; ++i) {
    buffer.write(i);
    EXPECT_TRUE(buffer.update());
    EXPECT_EQ(buffer.value(), i);
  }
}

TEST(Ring, HandsOverAllValuesInOrder) {
  Ring<int, 4> ring;
  int value = 0;
  EXPECT_FALSE(ring.read(value, 0ms));
  int next = 0;
  for (int round = 0; round < 5; ++round) {
    for (int i = 0; i < 3; ++i) ring.write(3 * round + i);
    while (ring.read(value, 0ms)) EXPECT_EQ(value, next++);
  }
  EXPECT_EQ(next, 15);
  EXPECT_EQ(ring.lost(), 0u);
}

TEST(Ring, LosesAndCountsWhatComesWhileItIsFull) {
  Ring<int, 4> ring;
  for (int i = 0; i < 7; ++i) ring.write(i);
  EXPECT_EQ(ring.lost(), 3u);
  int value = -1;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(ring.read(value, 0ms));
    EXPECT_EQ(value, i);
  }
  EXPECT_FALSE(ring.read(value, 0ms));
  ring.write(8);
  EXPECT_TRUE(ring.read(value, 0ms));
  EXPECT_EQ(value, 8);
}

TEST(Semaphore, WaitsNoLongerThanItIsToldTo) {
  Semaphore semaphore;
  const base::Time begin = steadyNow();
  EXPECT_FALSE(semaphore.waitFor(20ms));
  EXPECT_GE(steadyNow() - begin, 20ms);
  semaphore.post();
  EXPECT_TRUE(semaphore.waitFor(0ms));
  EXPECT_FALSE(semaphore.waitFor(0ms));
}

}  // namespace
}  // namespace haptex::realtime::test_loop_channels
