#include "haptex/nodes/rviz_plugin/background_subscriptions.h"

#include <chrono>
#include <thread>
#include <utility>

namespace haptex::nodes {
namespace {

constexpr std::chrono::milliseconds kRetryPeriod(500);

}  // namespace

/// roscpp holds the lock of all subscriptions of the process while it asks the master, and asks one
/// that is gone again and again: others would wait for that lock.
/// @returns false if it has ended meanwhile
bool BackgroundSubscriptions::awaitMaster(Shared& shared) {
  while (!ros::master::check()) {
    std::unique_lock<std::mutex> lock(shared.mutex);
    if (shared.ended || ros::isShuttingDown()) return false;
    shared.changed.wait_for(lock, kRetryPeriod);
  }
  return true;
}

void BackgroundSubscriptions::begin() {
  end();
  shared_ = std::make_shared<Shared>();
  std::thread([shared = shared_, wanted = std::move(wanted_)] {
    ros::NodeHandle node;
    node.setCallbackQueue(&shared->queue);
    for (const Subscribe& subscribe : wanted) {
      if (!awaitMaster(*shared)) return;
      ros::Subscriber subscriber = subscribe(node);
      const std::lock_guard<std::mutex> lock(shared->mutex);
      if (shared->ended) return;  // which ends this one, too
      shared->subscribers.push_back(std::move(subscriber));
    }
  }).detach();
  wanted_.clear();
}

void BackgroundSubscriptions::end() {
  if (!shared_) return;
  std::vector<ros::Subscriber> subscribers;
  {
    const std::lock_guard<std::mutex> lock(shared_->mutex);
    shared_->ended = true;
    shared_->changed.notify_all();
    subscribers.swap(shared_->subscribers);
  }
  if (!subscribers.empty()) {
    // The queue outlives them: messages are put into it until they have ended.
    std::thread([shared = shared_, subscribers = std::move(subscribers)]() mutable {
      ros::master::check();  // waits for one that hangs, as unsubscribing would
      subscribers.clear();
    }).detach();
  }
  shared_.reset();
}

void BackgroundSubscriptions::callAvailable() {
  const std::shared_ptr<Shared> held = shared_;  // a callback may end this
  if (held) held->queue.callAvailable();
}

}  // namespace haptex::nodes
