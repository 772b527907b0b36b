#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fixtures.h"
#include "haptex/tactile/drive_waveform.h"

namespace haptex::tactile::test_drive_waveform {
namespace {

constexpr double kRates[] = {44100.0, 48000.0, 1000.0, 8000.0, 777.7};

ArrayAmplitudes everywhere(double a40, double a320) {
  ArrayAmplitudes amplitudes;
  amplitudes.fill({a40, a320});
  return amplitudes;
}

/// All samples of one contactor over some steps.
template <typename NextOf>
std::vector<double> run(double rate, int steps, int contactor, const NextOf& next_of) {
  DriveWaveform waveform(rate);
  std::vector<double> all;
  for (int i = 0; i < steps; ++i) {
    for (const auto& sample : waveform.step(next_of(i))) all.push_back(sample[contactor]);
  }
  return all;
}

TEST(DriveWaveform, SamplesAddUpAtAnyRate) {
  for (const double rate : kRates) {
    const auto samples = run(rate, 1000, 0, [](int) { return everywhere(1e-6, 0.0); });
    EXPECT_EQ(samples.size(), static_cast<std::size_t>(std::ceil(25.0 * rate - 1e-6))) << rate;
  }
}

TEST(DriveWaveform, IsTheSumOfTwoSinesAcrossSteps) {
  for (const double rate : kRates) {
    const auto samples = run(rate, 80, 7, [](int) { return everywhere(3e-6, 2e-6); });
    const std::size_t settled = static_cast<std::size_t>(std::ceil(rate * kTactileStep));
    for (std::size_t n = settled; n < samples.size(); ++n) {
      const long double turn = 2.0L * std::acos(-1.0L) * n / rate;
      const double exact = 3e-6 * std::sin(40.0L * turn) + 2e-6 * std::sin(320.0L * turn);
      ASSERT_NEAR(samples[n], exact, 1e-14 * 5e-6) << rate << " Hz, sample " << n;
    }
  }
}

TEST(DriveWaveform, AmplitudesGoAlongAStraightLine) {
  for (const double rate : kRates) {
    const auto next_of = [](int i) { return everywhere(1e-6 * (i % 3), i % 2 == 0 ? 4e-6 : 0.0); };
    const auto samples = run(rate, 12, 0, next_of);
    for (std::size_t n = 0; n < samples.size(); ++n) {
      const double time = static_cast<double>(n) / rate;
      const int step = static_cast<int>(time * kTactileRate + 1e-9);
      const double share = time * kTactileRate - step;
      const PerChannel<double> from = step == 0 ? PerChannel<double>{} : next_of(step - 1)[0];
      const PerChannel<double> to = next_of(step)[0];
      const double exact =
          (from[k40] + share * (to[k40] - from[k40])) * std::sin(2.0 * M_PI * 40.0 * time) +
          (from[k320] + share * (to[k320] - from[k320])) * std::sin(2.0 * M_PI * 320.0 * time);
      ASSERT_NEAR(samples[n], exact, 1e-12 * 6e-6) << rate << " Hz, sample " << n;
    }
  }
}

TEST(DriveWaveform, NothingJumps) {
  for (const double rate : kRates) {
    // From nothing to the largest and back in every step.
    const auto samples =
        run(rate, 40, 23, [](int i) { return everywhere(i % 2 == 0 ? 2e-5 : 0.0, 3e-6); });
    // Steepest: the sines at full amplitude, and the lines from 0 to 1 within a step.
    const double bound =
        2.0 * M_PI * (40.0 * 2e-5 + 320.0 * 3e-6) / rate + (2e-5 + 3e-6) * kTactileRate / rate;
    double before = 0.0;
    for (const double sample : samples) {
      ASSERT_LE(std::abs(sample - before), bound) << rate;
      before = sample;
    }
  }
}

TEST(DriveWaveform, PhasesStayExactHoweverLongItRuns) {
  // 1e5 steps are 2.5 million samples at this rate: by then a sum of angles, or the product of
  // frequency and rounded time, would have lost five digits.
  DriveWaveform waveform(1000.0);
  const ArrayAmplitudes amplitudes = everywhere(1.0, 1.0);
  constexpr int kSteps = 100000;
  for (int i = 0; i < kSteps; ++i) waveform.step(amplitudes);
  const auto& samples = waveform.step(amplitudes);
  ASSERT_EQ(samples.size(), 25u);
  for (long long i = 0; i < 25; ++i) {
    const long long n = 25LL * kSteps + i;
    const double exact = std::sin(2.0 * M_PI * static_cast<double>(40 * n % 1000) / 1000.0) +
                         std::sin(2.0 * M_PI * static_cast<double>(320 * n % 1000) / 1000.0);
    EXPECT_NEAR(samples[i][0], exact, 1e-15);
  }
}

TEST(DriveWaveform, ContactorsDoNotMix) {
  ArrayAmplitudes amplitudes{};
  amplitudes[5] = {1e-6, 0.0};
  DriveWaveform waveform(8000.0);
  waveform.step(amplitudes);
  double largest = 0.0;
  for (const auto& sample : waveform.step(amplitudes)) {
    for (int i = 0; i < kContactors; ++i) {
      if (i == 5) continue;
      ASSERT_EQ(sample[i], 0.0);
    }
    largest = std::max(largest, sample[5]);
  }
  EXPECT_NEAR(largest, 1e-6, 1e-12);  // 8000/40 samples per period include the crest
}

TEST(DriveWaveform, RefusesRatesThatCannotCarryTheChannels) {
  EXPECT_EQ(test::refusalOf([] { DriveWaveform(640.0); }),
            "the sample rate is 640 Hz: allowed are numbers above 640 Hz and up to 1e+06 Hz");
  for (const double rate :
       {0.0, -44100.0, 2e6, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(DriveWaveform{rate}, std::invalid_argument) << rate;
  }
}

}  // namespace
}  // namespace haptex::tactile::test_drive_waveform
