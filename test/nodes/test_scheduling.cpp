#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>
#include <thread>

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

}  // namespace
}  // namespace haptex::nodes::test_scheduling
