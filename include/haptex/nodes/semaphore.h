// A counting semaphore whose waiting ends by the steady clock (C++17 has none).
#pragma once

#include <semaphore.h>

#include "haptex/exoskeleton/clock.h"

namespace haptex::nodes {

class Semaphore {
 public:
  Semaphore();
  ~Semaphore();
  Semaphore(const Semaphore&) = delete;
  Semaphore& operator=(const Semaphore&) = delete;

  /// Never waits: for threads that must not.
  void post();

  /// Takes one, waiting for it if there is none. @returns false if none came in time
  bool waitFor(exoskeleton::Time patience);
  /// The same until a time of the steady clock.
  bool waitUntil(exoskeleton::Time end);

 private:
  sem_t semaphore_;
};

}  // namespace haptex::nodes
