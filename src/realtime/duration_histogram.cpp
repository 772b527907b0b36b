#include "haptex/realtime/duration_histogram.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace haptex::realtime {
namespace {

constexpr std::size_t kPerOctave = DurationHistogram::kPerOctave;
constexpr int kOctaveBits = 5;
static_assert(kPerOctave == 1U << kOctaveBits);

/// @param nanoseconds from 0 to kLongest
std::size_t bucketOf(std::int64_t nanoseconds) {
  const auto value = static_cast<std::uint64_t>(nanoseconds);
  if (value < kPerOctave) return value;
  const int highest_bit = 63 - __builtin_clzll(value);
  const int shift = highest_bit - kOctaveBits;
  return static_cast<std::size_t>(shift) * kPerOctave + (value >> shift);
}

/// The longest duration that falls into a bucket.
base::Time endOf(std::size_t bucket) {
  if (bucket < kPerOctave) return base::Time(bucket);
  const std::size_t shift = bucket / kPerOctave - 1;
  const std::uint64_t mantissa = bucket % kPerOctave + kPerOctave;
  return base::Time(((mantissa + 1) << shift) - 1);
}

}  // namespace

std::uint64_t DurationHistogram::Counts::total() const {
  std::uint64_t sum = 0;
  for (const std::uint64_t count : buckets) sum += count;
  return sum;
}

base::Time DurationHistogram::Counts::quantile(double share) const {
  if (!(share >= 0.0 && share <= 1.0)) {
    throw std::invalid_argument("share = " + std::to_string(share) + ": allowed are 0 to 1");
  }
  const std::uint64_t all = total();
  if (all == 0) return Time{0};
  const double wanted = std::max(1.0, std::ceil(share * static_cast<double>(all)));
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < kBuckets; ++i) {
    below += buckets[i];
    if (static_cast<double>(below) >= wanted) return std::min(endOf(i), largest);
  }
  return largest;
}

DurationHistogram::Counts DurationHistogram::Counts::since(const Counts& earlier) const {
  Counts difference;
  for (std::size_t i = 0; i < kBuckets; ++i) {
    difference.buckets[i] = buckets[i] - earlier.buckets[i];
    if (difference.buckets[i] > 0) difference.largest = std::min(endOf(i), largest);
  }
  return difference;
}

void DurationHistogram::add(Time duration) {
  const std::int64_t nanoseconds = std::max<std::int64_t>(duration.count(), 0);
  // There is one writer, so nothing can come between a load and its store.
  if (nanoseconds > largest_.load(std::memory_order_relaxed)) {
    largest_.store(nanoseconds, std::memory_order_relaxed);
  }
  std::atomic<std::uint64_t>& bucket = buckets_[bucketOf(std::min(nanoseconds, kLongest.count()))];
  bucket.store(bucket.load(std::memory_order_relaxed) + 1, std::memory_order_release);
}

DurationHistogram::Counts DurationHistogram::counts() const {
  Counts counts;
  for (std::size_t i = 0; i < kBuckets; ++i) {
    counts.buckets[i] = buckets_[i].load(std::memory_order_acquire);
  }
  counts.largest = Time(largest_.load(std::memory_order_relaxed));
  return counts;
}

}  // namespace haptex::realtime
