#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "haptex/realtime/duration_histogram.h"

namespace haptex::realtime::test_duration_histogram {
namespace {

using base::Time;
using namespace std::chrono_literals;

// What a bucket may say too much: its width, 1/32 of its lower end.
constexpr double kTolerance = 1.0 / 32.0;

TEST(DurationHistogram, TellsQuantilesOfKnownDurations) {
  DurationHistogram histogram;
  for (int i = 1000; i >= 1; --i) histogram.add(i * 1us);  // the i-th share of a thousand is i us
  const DurationHistogram::Counts counts = histogram.counts();
  EXPECT_EQ(counts.total(), 1000u);
  for (const double share : {0.001, 0.25, 0.5, 0.99, 0.999}) {
    const double exact = share * 1e6;  // ns
    const auto told = static_cast<double>(counts.quantile(share).count());
    EXPECT_GE(told, std::floor(exact)) << share;
    EXPECT_LE(told, exact * (1.0 + kTolerance)) << share;
  }
  EXPECT_EQ(counts.quantile(1.0), 1000us);
  EXPECT_EQ(counts.largest, 1000us);
}

TEST(DurationHistogram, NeverTellsLessAndHardlyMoreThanADurationOfAnyLength) {
  for (std::int64_t length = 0; length < DurationHistogram::kLongest.count();
       length += 1 + length / 7) {
    DurationHistogram histogram;
    histogram.add(Time(length));
    histogram.add(DurationHistogram::kLongest);  // or the largest one would bound the first
    const std::int64_t told = histogram.counts().quantile(0.5).count();
    EXPECT_GE(told, length);
    EXPECT_LE(static_cast<double>(told), static_cast<double>(length) * (1.0 + kTolerance));
  }
}

TEST(DurationHistogram, KeepsTheLargestExactlyHoweverLong) {
  DurationHistogram histogram;
  histogram.add(1234567ns);
  EXPECT_EQ(histogram.counts().largest, 1234567ns);
  histogram.add(24h);  // beyond the last bucket
  EXPECT_EQ(histogram.counts().largest, 24h);
  EXPECT_EQ(histogram.counts().total(), 2u);
  EXPECT_EQ(histogram.counts().quantile(1.0), DurationHistogram::kLongest);
}

TEST(DurationHistogram, CountsANegativeDurationAsNone) {
  DurationHistogram histogram;
  histogram.add(-5us);
  EXPECT_EQ(histogram.counts().total(), 1u);
  EXPECT_EQ(histogram.counts().quantile(1.0), 0ns);
}

TEST(DurationHistogram, TellsZeroBeforeTheFirstDuration) {
  EXPECT_EQ(DurationHistogram().counts().quantile(0.5), 0ns);
}

TEST(DurationHistogram, TellsWhatWasAddedSince) {
  DurationHistogram histogram;
  for (int i = 0; i < 10; ++i) histogram.add(5ms);
  const DurationHistogram::Counts earlier = histogram.counts();
  EXPECT_EQ(histogram.counts().since(earlier).total(), 0u);
  EXPECT_EQ(histogram.counts().since(earlier).largest, 0ns);
  for (int i = 0; i < 4; ++i) histogram.add(10us);
  const DurationHistogram::Counts since = histogram.counts().since(earlier);
  EXPECT_EQ(since.total(), 4u);
  EXPECT_GE(since.largest, 10us);
  EXPECT_LE(static_cast<double>(since.largest.count()), 1e4 * (1.0 + kTolerance));
  EXPECT_EQ(since.quantile(0.5), since.largest);
}

TEST(DurationHistogram, RefusesSharesThatAreNone) {
  const DurationHistogram::Counts counts = DurationHistogram().counts();
  for (const double share : {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(counts.quantile(share), std::invalid_argument) << share;
  }
}

}  // namespace
}  // namespace haptex::realtime::test_duration_histogram
