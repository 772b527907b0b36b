#include "haptex/nodes/common/loop_diagnostics.h"

#include "haptex/realtime/scheduling.h"

namespace haptex::nodes {
namespace {

double microseconds(base::Time time) { return 1e-3 * static_cast<double>(time.count()); }

}  // namespace

void addQuantiles(diagnostic_updater::DiagnosticStatusWrapper& status, const std::string& what,
                  const std::string& when, const realtime::DurationHistogram::Counts& counts) {
  status.add(what + " p50 " + when + " (us)", microseconds(counts.quantile(0.5)));
  status.add(what + " p99 " + when + " (us)", microseconds(counts.quantile(0.99)));
  status.add(what + " p99.9 " + when + " (us)", microseconds(counts.quantile(0.999)));
  status.add(what + " max " + when + " (us)", microseconds(counts.largest));
}

std::uint64_t spoiltFrames(const serial::LinkStatistics& statistics) {
  return statistics.lost_states + statistics.received.corrupt_frames;
}

void addLinkCounts(diagnostic_updater::DiagnosticStatusWrapper& status,
                   const serial::LinkStatistics& statistics) {
  status.add("states lost", statistics.lost_states);
  status.add("states repeated or out of order", statistics.repeated_states);
  status.add("corrupt frames", statistics.received.corrupt_frames);
  status.add("bytes of garbage", statistics.received.garbage_bytes);
  status.add("timeouts", statistics.timeouts);
  status.add("answers in another version", statistics.version_mismatches);
  status.add("handshakes", statistics.handshakes);
}

void LoopDiagnostics::diagnose(const realtime::PeriodicThread& loop,
                               diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const realtime::DurationHistogram::Counts lateness = loop.lateness().counts();
  const std::uint64_t missed = loop.missed();
  const std::uint64_t newly_missed = missed - missed_;
  const std::string& refused = loop.refusedScheduler();
  if (newly_missed > 0) {
    status.summaryf(DiagnosticStatus::WARN, "missed %lu periods lately",
                    static_cast<unsigned long>(newly_missed));
  } else if (!refused.empty()) {
    status.summary(DiagnosticStatus::WARN, "in time, but without SCHED_FIFO: " + refused);
  } else {
    status.summary(DiagnosticStatus::OK, "in time");
  }
  status.add("SCHED_FIFO", refused.empty() ? "granted" : "not granted: " + refused);
  const std::string& unlocked = realtime::whyMemoryIsNotLocked();
  status.add("memory", unlocked.empty() ? "locked" : "not locked: " + unlocked);
  status.add("periods", loop.periods());
  status.add("periods missed", missed);
  addQuantiles(status, "wake-up jitter", "of the last second", lateness.since(lateness_));
  addQuantiles(status, "wake-up jitter", "since the start", lateness);
  lateness_ = lateness;
  missed_ = missed;
}

}  // namespace haptex::nodes
