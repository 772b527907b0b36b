// Topics for a graphical program, which must not wait for the master.
#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <boost/shared_ptr.hpp>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace haptex::nodes {

/// Subscribes and unsubscribes on a thread of its own, because both ask the master, and roscpp
/// waits for one that is gone without end; from the first begin() on it waits no more in the whole
/// process. Messages come in callAvailable(), on the thread that calls it.
class BackgroundSubscriptions {
 public:
  BackgroundSubscriptions() = default;
  /// Ends them. Waits for nothing.
  ~BackgroundSubscriptions() { end(); }
  BackgroundSubscriptions(const BackgroundSubscriptions&) = delete;
  BackgroundSubscriptions& operator=(const BackgroundSubscriptions&) = delete;

  /// To be called before begin(). Of messages that have not been taken yet, all but the newest
  /// `queue` are dropped without being read.
  /// @param topic as roscpp resolves it: relative to the process's namespace
  template <typename Message>
  void add(const std::string& topic, std::uint32_t queue,
           std::function<void(const boost::shared_ptr<const Message>&)> callback) {
    addEvents<Message>(topic, queue, [callback](const ros::MessageEvent<const Message>& event) {
      callback(event.getConstMessage());
    });
  }

  /// The same for who wants to know the sender of a message, too.
  template <typename Message>
  void addEvents(const std::string& topic, std::uint32_t queue,
                 std::function<void(const ros::MessageEvent<const Message>&)> callback) {
    wanted_.push_back([topic, queue, callback](ros::NodeHandle& node) {
      ros::SubscribeOptions options;
      options.initByFullCallbackType<const ros::MessageEvent<const Message>&>(topic, queue,
                                                                              callback);
      options.transport_hints = ros::TransportHints().tcpNoDelay();
      return node.subscribe(options);
    });
  }

  void begin();
  /// Afterwards no callback is called, and others may be added.
  void end();

  /// Calls the callbacks of what has come. Throws nothing but what they throw.
  void callAvailable();

 private:
  using Subscribe = std::function<ros::Subscriber(ros::NodeHandle&)>;
  struct Shared {
    ros::CallbackQueue queue;
    std::mutex mutex;  // guards the next
    bool ended = false;
    std::condition_variable changed;
    std::vector<ros::Subscriber> subscribers;
  };

  static std::optional<ros::Subscriber> awaitSubscriber(Shared& shared, ros::NodeHandle& node,
                                                        const Subscribe& subscribe);

  std::vector<Subscribe> wanted_;
  std::shared_ptr<Shared> shared_;  // with the thread
};

}  // namespace haptex::nodes
