#include "haptex/nodes/semaphore.h"

#include <cerrno>
#include <ctime>

#include "haptex/nodes/steady_clock.h"

namespace haptex::nodes {

Semaphore::Semaphore() { sem_init(&semaphore_, 0, 0); }

Semaphore::~Semaphore() { sem_destroy(&semaphore_); }

void Semaphore::post() { sem_post(&semaphore_); }

bool Semaphore::waitFor(exoskeleton::Time patience) { return waitUntil(steadyNow() + patience); }

bool Semaphore::waitUntil(exoskeleton::Time end) {
  const timespec time = toTimespec(end);
  while (sem_clockwait(&semaphore_, CLOCK_MONOTONIC, &time) != 0) {
    if (errno != EINTR) return false;
  }
  return true;
}

}  // namespace haptex::nodes
