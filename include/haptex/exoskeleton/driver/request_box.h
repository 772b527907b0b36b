// Requests of persons to a loop that waits for nobody.
#pragma once

#include <atomic>
#include <mutex>

#include "haptex/exoskeleton/control/device_controller.h"
#include "haptex/realtime/semaphore.h"

namespace haptex::exoskeleton {

/// What a person can ask of the driver, see exoskeleton::DeviceController.
enum class DriverRequest { kEnable, kDisable, kPause, kHome, kClearFault };

/// Takes one request at a time from any thread to the loop and the answer back.
class RequestBox {
 public:
  /// How long the loop may take. A request that it has not begun by then is withdrawn.
  static constexpr Time kPatience = std::chrono::milliseconds(500);

  /// By any thread: waits for the answer, and before that for those who asked before.
  /// @returns why the request was refused or withdrawn; empty if it was carried out
  Refusal ask(DriverRequest request);

  /// By the loop only: takes a request, if there is one. It has to be answered.
  bool take(DriverRequest& request);
  /// By the loop only: answers the request that was taken.
  void answer(Refusal refusal);

 private:
  enum class State { kIdle, kAsked, kTaken };

  std::mutex askers_;  // held by the one who asks; never taken by the loop
  // Whose turn it is with the next two: the loop's while kTaken, the asker's otherwise.
  std::atomic<State> state_{State::kIdle};
  DriverRequest request_ = DriverRequest::kDisable;
  Refusal refusal_;
  realtime::Semaphore answered_;
};

}  // namespace haptex::exoskeleton
