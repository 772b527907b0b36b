#include "haptex/realtime/semaphore.h"

#include <cerrno>
#include <ctime>

#include "haptex/realtime/steady_clock.h"

namespace haptex::realtime {

Semaphore::Semaphore() { sem_init(&semaphore_, 0, 0); }

Semaphore::~Semaphore() { sem_destroy(&semaphore_); }

void Semaphore::post() { sem_post(&semaphore_); }

bool Semaphore::waitFor(base::Time patience) { return waitUntil(steadyNow() + patience); }

bool Semaphore::waitUntil(base::Time end) {
  const timespec time = toTimespec(end);
  while (sem_clockwait(&semaphore_, CLOCK_MONOTONIC, &time) != 0) {
    if (errno != EINTR) return false;
  }
  return true;
}

}  // namespace haptex::realtime
