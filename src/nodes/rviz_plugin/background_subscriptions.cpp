#include "haptex/nodes/rviz_plugin/background_subscriptions.h"

#include <ros/console.h>
#include <ros/exceptions.h>

#include <chrono>
#include <thread>
#include <utility>

namespace haptex::nodes {
namespace {

constexpr std::chrono::milliseconds kRetryPeriod(500);

}  // namespace

/// roscpp holds the lock of all subscriptions of the process while it asks the master, and asks one
/// that is gone again and again: others, and rviz's end, would wait for that lock. So there has to
/// be a master before it is asked, and one that dies in between is asked once.
/// @returns none if it has ended meanwhile; an empty one if this process has the topic as another
///   type
std::optional<ros::Subscriber> BackgroundSubscriptions::awaitSubscriber(
    Shared& shared, ros::NodeHandle& node, const Subscribe& subscribe) {
  ros::master::setRetryTimeout(ros::WallDuration(0, 1));  // less is without end
  while (true) {
    if (ros::master::check()) {
      try {
        ros::Subscriber subscriber = subscribe(node);
        if (subscriber) return subscriber;
      } catch (const ros::ConflictingSubscriptionException& error) {
        ROS_ERROR("Not subscribed: %s", error.what());
        return ros::Subscriber();
      }
    }
    std::unique_lock<std::mutex> lock(shared.mutex);
    if (shared.ended || ros::isShuttingDown()) return std::nullopt;
    shared.changed.wait_for(lock, kRetryPeriod);
  }
}

void BackgroundSubscriptions::begin() {
  end();
  shared_ = std::make_shared<Shared>();
  std::thread([shared = shared_, wanted = std::move(wanted_)] {
    ros::NodeHandle node;
    node.setCallbackQueue(&shared->queue);
    for (const Subscribe& subscribe : wanted) {
      std::optional<ros::Subscriber> subscriber = awaitSubscriber(*shared, node, subscribe);
      const std::lock_guard<std::mutex> lock(shared->mutex);
      if (shared->ended || !subscriber) return;  // which ends this one, too
      shared->subscribers.push_back(std::move(*subscriber));
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
