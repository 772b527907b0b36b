#include "haptex/nodes/common/socket_thread.h"

#include <ros/poll_manager.h>

#include <chrono>
#include <memory>

#include "haptex/base/clock.h"
#include "haptex/realtime/scheduling.h"
#include "haptex/realtime/steady_clock.h"

namespace haptex::nodes {
namespace {

using base::Time;

constexpr Time kQuickLook = std::chrono::microseconds(10);  // shorter than a message takes
constexpr int kMaxQuickLooks = 10;
constexpr Time kBreak = std::chrono::microseconds(50);

/// roscpp's thread of the sockets, which calls look() whenever it looks for what is to be done.
/// While another thread writes to a connection (the answer of a service) it finds the socket ready
/// and the connection locked, and looks again at once. With SCHED_FIFO the one that it waits for
/// might never get on: after some such looks it takes a break.
class SocketThread {
 public:
  explicit SocketThread(bool on_force_path) : on_force_path_(on_force_path) {}

  void look() {
    if (!asked_) {
      asked_ = true;
      realtime::askForFifo(pthread_self(),
                           on_force_path_ ? realtime::kSocketPriority : realtime::kMessagePriority);
      if (on_force_path_) realtime::keepOnForceProcessor(pthread_self());
    }
    const Time now = realtime::steadyNow();
    quick_looks_ = now - last_look_ < kQuickLook ? quick_looks_ + 1 : 0;
    last_look_ = now;
    if (quick_looks_ < kMaxQuickLooks) return;
    realtime::sleepUntil(now + kBreak);
    quick_looks_ = 0;
  }

 private:
  const bool on_force_path_;
  bool asked_ = false;
  Time last_look_{0};
  int quick_looks_ = 0;
};

}  // namespace

void preferMessages(bool on_force_path) {
  const auto thread = std::make_shared<SocketThread>(on_force_path);
  ros::PollManager::instance()->addPollThreadListener([thread] { thread->look(); });
}

}  // namespace haptex::nodes
