#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>

#include "haptex/nodes/common/loop_diagnostics.h"
#include "haptex/realtime/periodic_thread.h"
#include "haptex/realtime/scheduling.h"

namespace haptex::nodes::test_scheduling {
namespace {

cpu_set_t processorsOf(pthread_t thread) {
  cpu_set_t processors;
  EXPECT_EQ(pthread_getaffinity_np(thread, sizeof processors, &processors), 0);
  return processors;
}

template <typename Work>
void inAThread(Work work) {
  std::thread(work).join();
}

TEST(ForceProcessor, ThreadsOfTheForcePathShareOne) {
  inAThread([] {
    realtime::keepOnForceProcessor(pthread_self());
    const cpu_set_t processors = processorsOf(pthread_self());
    EXPECT_EQ(CPU_COUNT(&processors), 1);
    inAThread([&] {
      realtime::keepOnForceProcessor(pthread_self());
      const cpu_set_t others = processorsOf(pthread_self());
      EXPECT_TRUE(CPU_EQUAL(&processors, &others));
    });
  });
}

TEST(ForceProcessor, WhatComputesForLongHasTheOthers) {
  const cpu_set_t all = processorsOf(pthread_self());
  inAThread([&] {
    realtime::keepOffForceProcessor(pthread_self());
    const cpu_set_t processors = processorsOf(pthread_self());
    EXPECT_EQ(CPU_COUNT(&processors), std::max(1, CPU_COUNT(&all) - 1));
    if (CPU_COUNT(&all) == 1) return;
    realtime::keepOnForceProcessor(pthread_self());
    const cpu_set_t force = processorsOf(pthread_self());
    cpu_set_t both;
    CPU_AND(&both, &processors, &force);
    EXPECT_EQ(CPU_COUNT(&both), 0);
  });
}

TEST(OrdinaryScope, GivesThePriorityBackAtItsEnd) {
  inAThread([] {
    if (!realtime::askForFifo(pthread_self(), realtime::kMessagePriority).empty())
      GTEST_SKIP() << "no right to FIFO";
    {
      const realtime::OrdinaryScope ordinary;
      EXPECT_EQ(sched_getscheduler(0), SCHED_OTHER);
    }
    sched_param parameters{};
    int policy = 0;
    ASSERT_EQ(pthread_getschedparam(pthread_self(), &policy, &parameters), 0);
    EXPECT_EQ(policy, SCHED_FIFO);
    EXPECT_EQ(parameters.sched_priority, realtime::kMessagePriority);
  });
}

TEST(LoopDiagnostics, ALoopThatMissedPeriodsSaysHowManyUntilItIsInTimeAgain) {
  using namespace std::chrono_literals;
  realtime::PeriodicThread loop(1ms, [](base::Time) { std::this_thread::sleep_for(5500us); });
  while (loop.periods() < 2) std::this_thread::yield();
  loop.stop();
  LoopDiagnostics diagnostics;
  diagnostic_updater::DiagnosticStatusWrapper status;
  diagnostics.diagnose(loop, status);
  EXPECT_EQ(status.level, diagnostic_msgs::DiagnosticStatus::WARN);
  EXPECT_EQ(status.message, "missed " + std::to_string(loop.missed()) + " periods lately");
  diagnostics.diagnose(loop, status);  // nothing since
  EXPECT_EQ(status.message.rfind("in time", 0), 0u) << status.message;
}

}  // namespace
}  // namespace haptex::nodes::test_scheduling
