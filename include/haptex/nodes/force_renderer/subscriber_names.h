// Who subscribes to a topic.
#pragma once

#include <ros/ros.h>

#include <algorithm>
#include <mutex>
#include <string>
#include <vector>

namespace haptex::nodes {

/// The nodes that subscribe to a topic: to be told by its publisher's callbacks, from any thread.
class SubscriberNames {
 public:
  void joined(const std::string& node) {
    const std::lock_guard<std::mutex> lock(mutex_);
    nodes_.push_back(node);
  }
  void left(const std::string& node) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = std::find(nodes_.begin(), nodes_.end(), node);
    if (found != nodes_.end()) nodes_.erase(found);
  }

  /// Whether every one of them subscribes to the other topic too.
  bool areAllAmong(const SubscriberNames& others) const {
    const std::scoped_lock lock(mutex_, others.mutex_);
    return std::all_of(nodes_.begin(), nodes_.end(), [&](const std::string& node) {
      return std::find(others.nodes_.begin(), others.nodes_.end(), node) != others.nodes_.end();
    });
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> nodes_;  // once for every subscription
};

/// Advertises a topic of which only the latest message counts, and keeps the names of its
/// subscribers.
/// @param names   has to outlive the publisher
/// @param changed called when a subscriber has come or gone, from the node's callback queue; names
///   has been told before
template <typename Message, typename Changed>
ros::Publisher advertiseLatest(ros::NodeHandle& node, const std::string& topic,
                               SubscriberNames& names, const Changed& changed) {
  const auto joined = [&names, changed](const ros::SingleSubscriberPublisher& subscriber) {
    names.joined(subscriber.getSubscriberName());
    changed();
  };
  const auto left = [&names, changed](const ros::SingleSubscriberPublisher& subscriber) {
    names.left(subscriber.getSubscriberName());
    changed();
  };
  return node.advertise<Message>(topic, 1, joined, left);
}

}  // namespace haptex::nodes
