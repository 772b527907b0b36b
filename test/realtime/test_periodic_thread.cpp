#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include "haptex/realtime/periodic_thread.h"
#include "haptex/realtime/scheduling.h"
#include "haptex/realtime/steady_clock.h"

namespace haptex::realtime::test_periodic_thread {
namespace {

using base::Time;
using namespace std::chrono_literals;

TEST(NextPeriod, FollowsTheGrid) {
  EXPECT_EQ(nextPeriod(10ms, 1ms, 10ms + 300us).start, 11ms);
  EXPECT_EQ(nextPeriod(10ms, 1ms, 10ms + 300us).missed, 0u);
  EXPECT_EQ(nextPeriod(10ms, 1ms, 10ms).start, 11ms);
}

TEST(NextPeriod, SkipsAndCountsThoseWhoseStartHasPassed) {
  EXPECT_EQ(nextPeriod(10ms, 1ms, 11ms).start, 12ms);  // 11 ms is now, which is too late
  EXPECT_EQ(nextPeriod(10ms, 1ms, 11ms).missed, 1u);
  EXPECT_EQ(nextPeriod(10ms, 1ms, 13ms + 700us).start, 14ms);
  EXPECT_EQ(nextPeriod(10ms, 1ms, 13ms + 700us).missed, 3u);
}

TEST(NextPeriod, IsTheNextForWorkThatWasDoneEarly) {
  EXPECT_EQ(nextPeriod(10ms, 1ms, 9ms).start, 11ms);
  EXPECT_EQ(nextPeriod(10ms, 1ms, 9ms).missed, 0u);
}

TEST(PeriodicThread, WorksAgainAndAgainAtRisingTimes) {
  std::atomic<int> works{0};
  std::atomic<bool> rises{true};
  Time last{0};
  const Time begin = steadyNow();
  PeriodicThread thread(1ms, [&](Time now) {
    if (now <= last) rises = false;
    last = now;
    ++works;
  });
  while (works < 20) std::this_thread::yield();
  thread.stop();
  EXPECT_TRUE(rises);
  EXPECT_GT(last, begin);
  EXPECT_LE(last, steadyNow());
  EXPECT_EQ(thread.periods(), static_cast<std::uint64_t>(works));
  EXPECT_EQ(thread.lateness().counts().total(), thread.periods());
}

TEST(PeriodicThread, NeverWorksBeforeItsTime) {
  const Time begin = steadyNow();
  std::vector<Time> starts;
  PeriodicThread thread(2ms, [&](Time now) { starts.push_back(now); });
  while (thread.periods() < 10) std::this_thread::yield();
  thread.stop();
  for (std::size_t i = 0; i < starts.size(); ++i) EXPECT_GE(starts[i], begin + (i + 1) * 2ms) << i;
}

TEST(PeriodicThread, SkipsAndCountsWhatSlowWorkMisses) {
  const Time begin = steadyNow();
  PeriodicThread thread(1ms, [](Time) { std::this_thread::sleep_for(5500us); });
  while (thread.periods() < 4) std::this_thread::yield();
  thread.stop();
  EXPECT_GE(thread.missed(), 5 * thread.periods());
  // No burst: every start was of a millisecond of its own.
  EXPECT_LE(thread.periods() + thread.missed(),
            static_cast<std::uint64_t>((steadyNow() - begin) / 1ms));
}

TEST(PeriodicThread, RestsAfterItsEnd) {
  std::atomic<int> works{0};
  PeriodicThread thread(1ms, [&](Time) { ++works; });
  while (works < 3) std::this_thread::yield();
  thread.stop();
  const int at_the_end = works;
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(works, at_the_end);
  EXPECT_NO_THROW(thread.stop());
}

TEST(PeriodicThread, HasTheSchedulerThatItSaysItHas) {
  std::atomic<int> policy{-1};
  std::atomic<int> priority{-1};
  std::atomic<bool> look{false};
  PeriodicThread thread(1ms, [&](Time) {
    if (!look || policy >= 0) return;
    sched_param parameters{};
    int found = 0;
    pthread_getschedparam(pthread_self(), &found, &parameters);
    priority = parameters.sched_priority;
    policy = found;
  });
  look = true;  // after the constructor has asked for it
  while (policy < 0) std::this_thread::yield();
  const bool granted = thread.refusedScheduler().empty();
  EXPECT_EQ(policy, granted ? SCHED_FIFO : SCHED_OTHER) << thread.refusedScheduler();
  EXPECT_EQ(priority, granted ? kLoopPriority : 0);
}

TEST(PeriodicThread, WorksAndSaysWhyWhereTheSchedulerIsNotPermitted) {
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_RTPRIO, &limit), 0);
  const rlimit none{0, limit.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_RTPRIO, &none), 0);
  std::thread user([] {
    // The system call itself makes this thread alone another user.
    constexpr unsigned kNobody = 65534;
    ASSERT_EQ(geteuid() == 0 ? syscall(SYS_setresuid, -1, kNobody, -1) : 0, 0);
    PeriodicThread thread(1ms, [](Time) {});
    EXPECT_NE(thread.refusedScheduler().find("rtprio 80"), std::string::npos)
        << thread.refusedScheduler();
    while (thread.periods() < 3) std::this_thread::yield();
  });
  user.join();
  ASSERT_EQ(setrlimit(RLIMIT_RTPRIO, &limit), 0);
}

TEST(PeriodicThread, WorksAtOnceWhenItIsCalled) {
  std::atomic<int> works{0};
  PeriodicThread thread(1h, [&](Time) { ++works; });
  thread.call();
  while (works < 1) std::this_thread::yield();
  EXPECT_EQ(works, 1);
}

TEST(PeriodicThread, NeverWorksTwiceWithinHalfAPeriodHoweverOftenItIsCalled) {
  constexpr Time kPeriod = 4ms;
  std::vector<Time> works;
  std::atomic<bool> done{false};
  PeriodicThreadOptions options;
  // Or a caller that the machine stops for long would leave it to the grid of periods.
  options.wait = [](Time) { return true; };
  PeriodicThread thread(
      kPeriod,
      [&](Time now) {
        if (works.size() < 20) works.push_back(now);
        done = works.size() == 20;
      },
      options);
  while (!done) std::this_thread::yield();
  thread.stop();
  for (std::size_t i = 1; i < works.size(); ++i) EXPECT_GE(works[i] - works[i - 1], kPeriod / 2);
}

TEST(PeriodicThread, GoesOnByItselfWhenNobodyCallsAnyMore) {
  std::atomic<int> works{0};
  PeriodicThread thread(1ms, [&](Time) { ++works; });
  thread.call();
  while (works < 10) std::this_thread::yield();
  EXPECT_GE(works, 10);
}

TEST(PeriodicThread, RefusesPeriodsThatAreNone) {
  EXPECT_THROW(PeriodicThread(0ms, [](Time) {}), std::invalid_argument);
  EXPECT_THROW(PeriodicThread(-1ms, [](Time) {}), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::realtime::test_periodic_thread
