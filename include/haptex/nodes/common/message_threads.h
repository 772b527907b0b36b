// Threads for the callbacks of messages that must not wait behind what is ordinary.
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <atomic>
#include <thread>
#include <vector>

namespace haptex::nodes {

/// Call what comes into their queue, with SCHED_FIFO and kMessagePriority if that is granted.
///
/// More than one thread is for services only. A message of a topic whose callback another thread is
/// at is tried again at once, and two threads that try again and again with SCHED_FIFO keep the
/// processor from the one that is at it.
class MessageThreads {
 public:
  MessageThreads() = default;
  /// As stop().
  ~MessageThreads() { stop(); }
  MessageThreads(const MessageThreads&) = delete;
  MessageThreads& operator=(const MessageThreads&) = delete;

  /// The same node with callbacks here.
  ros::NodeHandle handle(ros::NodeHandle node);

  /// When everything that the callbacks use is there. @param count of threads, >= 1
  void start(int count = 1);
  /// Ends each thread after the callback it is at.
  void stop();

 private:
  ros::CallbackQueue queue_;
  std::atomic<bool> stopping_{false};
  std::vector<std::thread> threads_;
};

}  // namespace haptex::nodes
