#include "haptex/rviz_plugin/background_subscriptions.h"

#include <thread>
#include <utility>

namespace haptex::rviz_plugin {

void BackgroundSubscriptions::begin() {
  end();
  shared_ = std::make_shared<Shared>();
  std::thread([shared = shared_, wanted = std::move(wanted_)] {
    ros::NodeHandle node;
    node.setCallbackQueue(&shared->queue);
    for (const Subscribe& subscribe : wanted) {
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
    subscribers.swap(shared_->subscribers);
  }
  if (!subscribers.empty()) {
    // The queue outlives them: messages are put into it until they have ended.
    std::thread([shared = shared_, subscribers = std::move(subscribers)]() mutable {
      subscribers.clear();
    }).detach();
  }
  shared_.reset();
}

void BackgroundSubscriptions::callAvailable() {
  const std::shared_ptr<Shared> held = shared_;  // a callback may end this
  if (held) held->queue.callAvailable();
}

}  // namespace haptex::rviz_plugin
