// A counting semaphore whose waiting ends by the steady clock (C++17 has none).
#pragma once

#include <semaphore.h>

#include "haptex/base/clock.h"

namespace haptex::realtime {

class Semaphore {
 public:
  Semaphore();
  ~Semaphore();
  Semaphore(const Semaphore&) = delete;
  Semaphore& operator=(const Semaphore&) = delete;

  /// Never waits: for threads that must not.
  void post();

  /// Takes one, waiting for it if there is none. @returns false if none came in time
  bool waitFor(base::Time patience);
  /// The same until a time of the steady clock.
  bool waitUntil(base::Time end);

 private:
  sem_t semaphore_;
};

}  // namespace haptex::realtime
