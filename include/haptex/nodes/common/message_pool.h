// Messages that are published from a loop, without allocating one each time.
#pragma once

#include <array>
#include <boost/make_shared.hpp>
#include <boost/shared_ptr.hpp>
#include <cstddef>

namespace haptex::nodes {

/// Shared messages in turn, so that a subscriber of the same process takes a message without a
/// copy. One that somebody still holds is left to him, and another one made.
template <typename Message, std::size_t kCount = 8>
class MessagePool {
 public:
  MessagePool() {
    for (auto& message : messages_) message = boost::make_shared<Message>();
  }

  /// To be filled and published; what it holds is of the past.
  const boost::shared_ptr<Message>& next() {
    boost::shared_ptr<Message>& message = messages_[next_];
    next_ = (next_ + 1) % kCount;
    if (message.use_count() > 1) message = boost::make_shared<Message>();
    return message;
  }

 private:
  std::array<boost::shared_ptr<Message>, kCount> messages_;
  std::size_t next_ = 0;
};

}  // namespace haptex::nodes
