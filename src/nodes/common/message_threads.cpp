#include "haptex/nodes/common/message_threads.h"

#include "haptex/realtime/scheduling.h"

namespace haptex::nodes {
namespace {

const ros::WallDuration kPatience(0.1);  // until it is looked whether the threads are to end

}  // namespace

ros::NodeHandle MessageThreads::handle(ros::NodeHandle node) {
  node.setCallbackQueue(&queue_);
  return node;
}

void MessageThreads::start(int count) {
  for (int i = 0; i < count; ++i) {
    threads_.emplace_back([this] {
      realtime::askForFifoOnce(realtime::kMessagePriority);
      while (!stopping_) queue_.callOne(kPatience);
    });
  }
}

void MessageThreads::stop() {
  stopping_ = true;
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

}  // namespace haptex::nodes
