// Callbacks on the thread that brings the messages.
#pragma once

#include <ros/callback_queue_interface.h>

#include <cstdint>

namespace haptex::nodes {

/// Calls at once, where the message arrives: on roscpp's thread of the sockets, or, within one
/// process, on the thread that publishes. For small messages whose callbacks take microseconds,
/// wait for nobody and neither subscribe nor end a subscription: it saves waking another thread up.
///
/// When Subscriber::shutdown() has returned nothing is called any more: roscpp calls while it holds
/// the lock that it takes for removing a subscription.
class ImmediateQueue : public ros::CallbackQueueInterface {
 public:
  void addCallback(const ros::CallbackInterfacePtr& callback,
                   std::uint64_t /*owner*/ = 0) override {
    callback->call();
  }
  void removeByID(std::uint64_t /*owner*/) override {}
};

}  // namespace haptex::nodes
