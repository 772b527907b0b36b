#include "haptex/nodes/scheduling.h"

#include <sched.h>
#include <sys/resource.h>

#include <cerrno>
#include <system_error>

namespace haptex::nodes {

std::string askForFifo(pthread_t thread, int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int error = pthread_setschedparam(thread, SCHED_FIFO, &parameters);
  if (error == 0) return "";
  std::string why = std::generic_category().message(error);
  if (error == EPERM) {
    why += ": give the user rtprio " + std::to_string(priority) +
           " in /etc/security/limits.conf, or the program cap_sys_nice";
  }
  return why;
}

// In Linux a niceness is a thread's, and those that it starts inherit it.
void preferMessages() { setpriority(PRIO_PROCESS, 0, kMessageNiceness); }

void beOrdinary() { setpriority(PRIO_PROCESS, 0, 0); }

}  // namespace haptex::nodes
