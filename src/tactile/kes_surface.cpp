#include "haptex/tactile/kes_surface.h"

#include <cmath>
#include <complex>
#include <kissfft/kissfft.hh>
#include <vector>

namespace haptex::tactile {
namespace {

using Complex = std::complex<double>;

constexpr double kTestSpeed = 1e-3;        // m/s
constexpr double kNaturalFrequency = 1.0;  // Hz
constexpr double kDampingRatio = 0.6;

/// Response of the high-pass at f (Hz): s^2/(s^2 + 2 zeta w0 s + w0^2) with s = 2 pi i f.
Complex highPass(double frequency) {
  const double ratio = frequency / kNaturalFrequency;
  return ratio * ratio / Complex(ratio * ratio - 1.0, -2.0 * kDampingRatio * ratio);
}

/// Strokes profiles of one length, there and back.
class Tester {
 public:
  Tester(int samples, double spacing)
      : spacing_(spacing),
        profile_(samples),
        spectrum_(samples),
        filtered_(samples),
        there_(samples),
        slope_(samples),
        to_spectrum_(samples, false),
        to_profile_(samples, true) {
    for (int i = 0; i < samples; ++i) {
      const int wave = 2 * i <= samples ? i : i - samples;
      there_[i] = highPass(wave / (samples * spacing) * kTestSpeed);
      slope_[i] = {0.0, 2.0 * M_PI * wave / samples};
      // The highest wave of an even number of samples is its own opposite: its real part counts,
      // and its slope is zero at every sample.
      if (2 * i == samples) there_[i] = there_[i].real();
      if (2 * i == samples) slope_[i] = 0.0;
    }
  }

  Complex& operator[](int sample) { return profile_[sample]; }

  /// Of the profile that was put in.
  KesSurface test() {
    to_spectrum_.transform(profile_.data(), spectrum_.data());
    const KesSurface there = deviations([](const Complex& response) { return response; });
    const KesSurface back = deviations([](const Complex& response) { return std::conj(response); });
    return {0.5 * (there.roughness + back.roughness),
            0.5 * (there.slope_deviation + back.slope_deviation)};
  }

 private:
  /// Height and slope are real, so one transform brings both, as real and imaginary part; the slope
  /// per sample, as large as the height, so that neither loses digits to the other.
  template <typename F>
  KesSurface deviations(F along_stroke) {
    const int samples = static_cast<int>(profile_.size());
    for (int i = 0; i < samples; ++i) {
      profile_[i] = spectrum_[i] * along_stroke(there_[i]) * (1.0 + Complex(0.0, 1.0) * slope_[i]);
    }
    to_profile_.transform(profile_.data(), filtered_.data());
    KesSurface sum{0.0, 0.0};
    for (const Complex& value : filtered_) {
      sum.roughness += std::abs(value.real());
      sum.slope_deviation += std::abs(value.imag());
    }
    const double scale = 1.0 / (static_cast<double>(samples) * samples);
    return {sum.roughness * scale, sum.slope_deviation * scale / spacing_};
  }

  double spacing_;
  std::vector<Complex> profile_, spectrum_, filtered_;
  std::vector<Complex> there_, slope_;  // responses; that of the slope per sample
  kissfft<double> to_spectrum_, to_profile_;
};

/// The mean over `count` profiles, of which get(profile, sample) gives the heights.
template <typename F>
KesSurface meanOfStrokes(int count, int samples, double spacing, F get) {
  Tester tester(samples, spacing);
  KesSurface mean{0.0, 0.0};
  for (int profile = 0; profile < count; ++profile) {
    for (int sample = 0; sample < samples; ++sample) tester[sample] = get(profile, sample);
    const KesSurface found = tester.test();
    mean.roughness += found.roughness / count;
    mean.slope_deviation += found.slope_deviation / count;
  }
  return mean;
}

}  // namespace

KesSurface testSurface(const HeightField& periodic) {
  requireSound(periodic);
  const KesSurface along_weft =
      meanOfStrokes(periodic.rows, periodic.columns, periodic.weft_spacing,
                    [&](int row, int column) { return periodic.at(column, row); });
  const KesSurface along_warp =
      meanOfStrokes(periodic.columns, periodic.rows, periodic.warp_spacing,
                    [&](int column, int row) { return periodic.at(column, row); });
  return {0.5 * (along_weft.roughness + along_warp.roughness),
          0.5 * (along_weft.slope_deviation + along_warp.slope_deviation)};
}

}  // namespace haptex::tactile
