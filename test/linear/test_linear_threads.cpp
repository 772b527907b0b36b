// The thread pool under the thread sanitizer.
#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <vector>

#include "haptex/linear/thread_pool.h"

namespace haptex::linear::test_linear_threads {
namespace {

TEST(LinearThreads, EveryTaskIsDoneOnceAndSeenByTheCaller) {
  ThreadPool pool(4);
  std::vector<int> done(100, 0);
  for (int job = 1; job <= 200; ++job) {
    // Rows of short jobs, of which some have fewer tasks than there are threads.
    const int tasks = job % 7 == 0 ? 3 : 100;
    std::fill(done.begin(), done.end(), 0);
    pool.run(tasks, [&](int task, int) { done[task] += job; });
    EXPECT_EQ(std::accumulate(done.begin(), done.end(), 0), tasks * job);
  }
}

TEST(LinearThreads, AThreadHasWhatIsItsOwn) {
  ThreadPool pool(3);
  std::array<int, 3> tasks_of{};
  for (int job = 0; job < 100; ++job) {
    pool.run(50, [&](int, int thread) { ++tasks_of[thread]; });
  }
  EXPECT_EQ(std::accumulate(tasks_of.begin(), tasks_of.end(), 0), 5000);
}

TEST(LinearThreads, PoolsComeAndGoWithAndWithoutWork) {
  for (int i = 0; i < 20; ++i) {
    ThreadPool pool(3);
    int sum = 0;
    if (i % 2 == 0) continue;
    std::array<int, 8> parts{};
    pool.run(8, [&](int task, int) { parts[task] = task; });
    for (const int part : parts) sum += part;
    EXPECT_EQ(sum, 28);
  }
}

}  // namespace
}  // namespace haptex::linear::test_linear_threads
