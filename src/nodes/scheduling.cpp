#include "haptex/nodes/scheduling.h"

#include <sched.h>

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

void preferMessages() { askForFifo(pthread_self(), kMessagePriority); }

void beOrdinary() {
  const sched_param ordinary{};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &ordinary);  // always allowed
}

}  // namespace haptex::nodes
