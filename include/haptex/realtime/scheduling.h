// Which threads the processor serves first.
#pragma once

#include <pthread.h>

#include <string>

namespace haptex::realtime {

/// Of SCHED_FIFO, from 1 to 99. On the force path, from the device's position to its force, the
/// loops of device and driver come first, then the force renderer's loop, then the threads of the
/// sockets between them: one that interrupted a loop while it publishes would wait for roscpp's
/// lock, which the loop holds. What brings other messages comes after them, and before everything
/// ordinary, such as diagnostics, markers and a recorder.
constexpr int kLoopPriority = 80;
constexpr int kForcePriority = 76;
constexpr int kSocketPriority = 75;
constexpr int kMessagePriority = 20;

/// Asks for SCHED_FIFO for a thread.
/// @returns why it was refused; empty if it was granted
std::string askForFifo(pthread_t thread, int priority);

/// For this thread, once: threads of a library can be reached only from a callback on them.
void askForFifoOnce(int priority);

/// Keeps a thread of the force path on one processor, the same one for all of them, the last that
/// the process may use: they wake each other up in turn, thousands of times a second, and waking a
/// thread up on another processor takes an interrupt there (docs/real_time.md).
void keepOnForceProcessor(pthread_t thread);

/// Keeps a thread that computes for milliseconds off the processor of keepOnForceProcessor(), where
/// there is another one: beside the force path it would get what that leaves.
void keepOffForceProcessor(pthread_t thread);

/// While it lives, the thread that made it is ordinary.
class OrdinaryScope {
 public:
  OrdinaryScope();
  ~OrdinaryScope();
  OrdinaryScope(const OrdinaryScope&) = delete;
  OrdinaryScope& operator=(const OrdinaryScope&) = delete;

 private:
  int policy_ = SCHED_OTHER;
  sched_param parameters_{};
};

/// Before other threads are there: what the process has touched, or will touch, stays in memory.
/// Not under a limit (RLIMIT_MEMLOCK), at which later allocations would fail, nor under sanitizers,
/// whose shadow of the memory is larger than the machine's.
void lockMemory();

/// Empty if lockMemory() has locked it.
const std::string& whyMemoryIsNotLocked();

/// Takes SCHED_FIFO from all threads of this process. To be called before it ends: threads that
/// wait for each other in a loop while the process is taken down would take the processors from
/// those they wait for.
void makeAllOrdinary();

}  // namespace haptex::realtime
