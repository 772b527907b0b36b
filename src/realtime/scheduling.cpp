#include "haptex/realtime/scheduling.h"

#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "haptex/base/workload.h"

namespace haptex::realtime {
namespace {

std::string memory_trouble = "nobody has asked for it";

std::string tryToLockMemory() {
  if (base::kSanitized) return "built with a sanitizer";
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  if (limit.rlim_cur != RLIM_INFINITY && geteuid() != 0) {
    return "give the user memlock unlimited in /etc/security/limits.conf";
  }
  if (mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0) return "";
  return std::generic_category().message(errno);
}

int lastOf(const cpu_set_t& processors) {
  int last = CPU_SETSIZE - 1;
  while (last > 0 && !CPU_ISSET(last, &processors)) --last;
  return last;
}

}  // namespace

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

OrdinaryScope::OrdinaryScope() {
  pthread_getschedparam(pthread_self(), &policy_, &parameters_);
  const sched_param ordinary{};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &ordinary);
}

OrdinaryScope::~OrdinaryScope() { pthread_setschedparam(pthread_self(), policy_, &parameters_); }

void askForFifoOnce(int priority) {
  thread_local bool asked = false;
  if (asked) return;
  asked = true;
  askForFifo(pthread_self(), priority);
}

void keepOnForceProcessor(pthread_t thread) {
  cpu_set_t allowed;
  if (sched_getaffinity(getpid(), sizeof allowed, &allowed) != 0) return;
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(lastOf(allowed), &one);
  pthread_setaffinity_np(thread, sizeof one, &one);  // refused: it runs elsewhere
}

void keepOffForceProcessor(pthread_t thread) {
  cpu_set_t allowed;
  if (sched_getaffinity(getpid(), sizeof allowed, &allowed) != 0) return;
  if (CPU_COUNT(&allowed) == 1) return;
  CPU_CLR(lastOf(allowed), &allowed);
  pthread_setaffinity_np(thread, sizeof allowed, &allowed);
}

void lockMemory() { memory_trouble = tryToLockMemory(); }

const std::string& whyMemoryIsNotLocked() { return memory_trouble; }

void makeAllOrdinary() {
  const sched_param ordinary{};
  std::error_code error;  // a thread may end meanwhile
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task", error)) {
    const pid_t thread = std::atoi(entry.path().filename().c_str());
    sched_setscheduler(thread, SCHED_OTHER, &ordinary);  // always allowed
  }
}

}  // namespace haptex::realtime
