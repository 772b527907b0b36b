#include "haptex/linear/thread_pool.h"

#include <chrono>

namespace haptex::linear {
namespace {

/// Looks for as long as a thread takes to fall asleep and wake up.
template <typename Condition>
void awaitBriefly(const Condition& condition) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::microseconds kPatience{50};
  const Clock::time_point end = Clock::now() + kPatience;
  while (!condition() && Clock::now() < end) std::this_thread::yield();
}

}  // namespace

ThreadPool::ThreadPool(int threads) {
  for (int thread = 1; thread < threads; ++thread) {
    workers_.emplace_back([this, thread] { work(thread); });
  }
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  start_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::share(int tasks, const void* context, Call call) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    tasks_ = tasks;
    context_ = context;
    call_ = call;
    next_task_ = 0;
    busy_ = static_cast<int>(workers_.size());
    ++job_;
  }
  start_.notify_all();
  takeTasks(0);
  const auto done = [this] { return busy_ == 0; };
  awaitBriefly(done);
  std::unique_lock<std::mutex> lock(mutex_);
  done_.wait(lock, done);
}

void ThreadPool::work(int thread) {
  long last_job = 0;
  const auto wanted = [&] { return stop_ || job_ != last_job; };
  while (true) {
    awaitBriefly(wanted);
    {
      std::unique_lock<std::mutex> lock(mutex_);
      start_.wait(lock, wanted);
      if (stop_) return;
      last_job = job_;
    }
    takeTasks(thread);
    const std::lock_guard<std::mutex> lock(mutex_);
    if (--busy_ == 0) done_.notify_one();
  }
}

void ThreadPool::takeTasks(int thread) {
  for (int task = next_task_++; task < tasks_; task = next_task_++) call_(context_, task, thread);
}

}  // namespace haptex::linear
