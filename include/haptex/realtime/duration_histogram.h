// How often durations of which length occurred, counted without locks.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "haptex/base/clock.h"

namespace haptex::realtime {

/// Counts durations in fixed buckets: of 1 ns up to 32 ns, above that 32 of them per power of two,
/// so that a bucket is at most 1/32 wider than its lower end. One thread adds, any may read. Does
/// not allocate.
class DurationHistogram {
 public:
  using Time = base::Time;

  static constexpr std::size_t kPerOctave = 32;
  static constexpr std::size_t kBuckets = 1024;
  /// The last bucket ends here, at 68.7 s; it takes everything longer too.
  static constexpr Time kLongest{(std::int64_t{1} << 36) - 1};

  /// The counts at one moment, no units.
  struct Counts {
    std::array<std::uint64_t, kBuckets> buckets{};
    /// Since the construction exact, of a difference the upper end of its last bucket.
    Time largest{0};

    std::uint64_t total() const;
    /// The upper end of the first bucket up to which at least the share `share` of all durations
    /// lies, and not above `largest`; 0 without durations.
    /// @throws std::invalid_argument naming the share if it is not in [0, 1]
    Time quantile(double share) const;
    /// What was added since `earlier`, counts of the same histogram.
    Counts since(const Counts& earlier) const;
  };

  /// A negative duration counts as 0.
  void add(Time duration);

  /// Durations that are added meanwhile may or may not be counted.
  Counts counts() const;

 private:
  std::array<std::atomic<std::uint64_t>, kBuckets> buckets_{};
  std::atomic<std::int64_t> largest_{0};  // ns
};

}  // namespace haptex::realtime
