// The diagnostics of a periodic thread, and of the driver's end of a serial line.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <cstdint>
#include <string>

#include "haptex/realtime/duration_histogram.h"
#include "haptex/realtime/periodic_thread.h"
#include "haptex/serial/link_status.h"

namespace haptex::nodes {

/// Adds the quantiles of durations (us). @param what for example "wake-up jitter"
void addQuantiles(diagnostic_updater::DiagnosticStatusWrapper& status, const std::string& what,
                  const std::string& when, const realtime::DurationHistogram::Counts& counts);

/// Frames that were lost or corrupt, no unit.
std::uint64_t spoiltFrames(const serial::LinkStatistics& statistics);

/// Adds what the line has counted.
void addLinkCounts(diagnostic_updater::DiagnosticStatusWrapper& status,
                   const serial::LinkStatistics& statistics);

/// Whether the loop is in time, whether it has SCHED_FIFO, and its jitter, since the start and
/// since it was asked before. By one thread.
class LoopDiagnostics {
 public:
  void diagnose(const realtime::PeriodicThread& loop,
                diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  realtime::DurationHistogram::Counts lateness_;
  std::uint64_t missed_ = 0;
};

}  // namespace haptex::nodes
