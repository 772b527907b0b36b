// A few threads that share the parts of one job at a time.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace haptex::linear {

/// Threads that look for the next job for a moment, because jobs come in rows, and then sleep. They
/// are made by the constructor; run() allocates nothing.
class ThreadPool {
 public:
  /// @param threads at least 1, with the one that calls run()
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const { return static_cast<int>(workers_.size()) + 1; }

  /// Calls function(task, thread) for every task in [0, tasks) and returns when all are done. Which
  /// thread takes which task is not the same in every run. Not to be called from within a task.
  template <typename Function>
  void run(int tasks, const Function& function) {
    if (tasks <= 1 || workers_.empty()) {
      for (int task = 0; task < tasks; ++task) function(task, 0);
      return;
    }
    share(tasks, &function, [](const void* context, int task, int thread) {
      (*static_cast<const Function*>(context))(task, thread);
    });
  }

 private:
  using Call = void (*)(const void* context, int task, int thread);
  void share(int tasks, const void* context, Call call);
  void work(int thread);
  void takeTasks(int thread);

  std::vector<std::thread> workers_;
  std::mutex mutex_;
  std::condition_variable start_;
  std::condition_variable done_;
  std::atomic<long> job_{0};  // counts the jobs
  std::atomic<int> busy_{0};  // workers that have not finished the job
  std::atomic<bool> stop_{false};
  std::atomic<int> next_task_{0};
  int tasks_ = 0;
  const void* context_ = nullptr;
  Call call_ = nullptr;
};

/// The same by one thread where there is no pool. @param pool may be null
template <typename Function>
void runTasks(ThreadPool* pool, int tasks, const Function& function) {
  if (pool != nullptr) return pool->run(tasks, function);
  for (int task = 0; task < tasks; ++task) function(task, 0);
}

}  // namespace haptex::linear
