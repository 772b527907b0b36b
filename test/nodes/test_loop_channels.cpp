// What goes between the loop and other threads, looked at by one thread. test_exoskeleton_threads
// has the threads.
#include <gtest/gtest.h>

#include <thread>

#include "haptex/nodes/request_box.h"
#include "haptex/nodes/ring.h"
#include "haptex/nodes/steady_clock.h"
#include "haptex/nodes/triple_buffer.h"

namespace haptex::nodes {
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
  const exoskeleton::Time begin = steadyNow();
  EXPECT_FALSE(semaphore.waitFor(20ms));
  EXPECT_GE(steadyNow() - begin, 20ms);
  semaphore.post();
  EXPECT_TRUE(semaphore.waitFor(0ms));
  EXPECT_FALSE(semaphore.waitFor(0ms));
}

TEST(RequestBox, HasNothingToTakeUntilAsked) {
  RequestBox box;
  DriverRequest request{};
  EXPECT_FALSE(box.take(request));
}

TEST(RequestBox, WithdrawsARequestThatTheLoopDoesNotTake) {
  RequestBox box;
  EXPECT_NE(box.ask(DriverRequest::kEnable).find("has not answered within 0.5 s"),
            std::string::npos);
  DriverRequest request{};
  EXPECT_FALSE(box.take(request));  // nobody waits for it any more
}

TEST(RequestBox, BringsBackTheAnswer) {
  RequestBox box;
  for (const char* refusal : {"", "the device is not homed", ""}) {
    std::thread loop([&] {
      DriverRequest request{};
      while (!box.take(request)) std::this_thread::yield();
      EXPECT_EQ(request, DriverRequest::kHome);
      box.answer(refusal);
    });
    EXPECT_EQ(box.ask(DriverRequest::kHome), refusal);
    loop.join();
  }
}

TEST(RequestBox, WaitsForALoopThatIsAtIt) {
  RequestBox box;
  std::thread loop([&] {
    DriverRequest request{};
    while (!box.take(request)) std::this_thread::yield();
    std::this_thread::sleep_for(RequestBox::kPatience + 100ms);  // a very busy machine
    box.answer("late");
  });
  EXPECT_EQ(box.ask(DriverRequest::kHome), "late");
  loop.join();
}

}  // namespace
}  // namespace haptex::nodes
