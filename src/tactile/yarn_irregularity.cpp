#include "haptex/tactile/yarn_irregularity.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace haptex::tactile {
namespace {

constexpr double kFibreLength = 0.04;  // m

}  // namespace

double NormalNumbers::next() {
  const double radius = std::sqrt(-2.0 * std::log1p(-uniform()));
  return radius * std::cos(2.0 * M_PI * uniform());
}

double NormalNumbers::uniform() { return static_cast<double>(generator_() >> 11) * 0x1p-53; }

/// The moving sum of white noise over a fibre's length has the correlation asked for. Of a yarn
/// shorter than two fibres it is taken over half of the way round, which has the correlation
/// 1 - 2 d/length; a deviation of the whole yarn makes up for the rest.
std::vector<double> yarnNoise(NormalNumbers& numbers, int places, double length) {
  const double changing = std::min(1.0, length / (2.0 * kFibreLength));
  const double lasting = std::sqrt(1.0 - changing) * numbers.next();
  std::vector<double> white(places);
  for (double& value : white) value = numbers.next();
  const double share = std::min(0.5, kFibreLength / length);  // of the way round
  const int window = std::max(1, static_cast<int>(share * places + 1e-9));
  std::vector<double> noise(places, lasting);
  for (int i = 0; i < places; ++i) {
    double sum = 0.0;
    for (int k = 0; k < window; ++k) sum += white[(i + k) % places];
    noise[i] += std::sqrt(changing / window) * sum;
  }
  return noise;
}

double variation(double noise, double irregularity) {
  const double variance = std::log1p(irregularity * irregularity);
  return std::exp(std::sqrt(variance) * noise - 0.5 * variance);
}

std::vector<double> cellPowers(NormalNumbers& numbers, const ParallelYarns& yarns,
                               double irregularity) {
  const double length = kMapCells * AmplitudeMap::kSpacing;
  const int count = static_cast<int>(std::lround(length / yarns.spacing));
  const double width = static_cast<double>(kMapCells) / count;  // in cells
  std::vector<double> powers(static_cast<std::size_t>(kMapCells) * kMapCells);
  for (int yarn = 0; yarn < count; ++yarn) {
    const std::vector<double> noise =
        yarnNoise(numbers, kMapCells, yarns.length_per_length * length);
    const double begin = yarn * width, end = begin + width;
    for (int cell = static_cast<int>(begin); cell < std::min(end, 1.0 * kMapCells); ++cell) {
      const double share = std::min(end, cell + 1.0) - std::max<double>(begin, cell);
      for (int along = 0; along < kMapCells; ++along) {
        const double factor = variation(noise[along], irregularity);
        powers[static_cast<std::size_t>(kMapCells) * cell + along] += share * factor * factor;
      }
    }
  }
  return powers;
}

AmplitudeMap mapOfPowers(const std::vector<double>& powers) {
  double mean = 0.0;
  for (const double power : powers) mean += power / (kMapCells * kMapCells);
  std::vector<PerChannel<double>> values;
  values.reserve(powers.size());
  for (const double power : powers) {
    const double amplitude = std::sqrt(power / mean);
    values.push_back({amplitude, amplitude});
  }
  return AmplitudeMap(kMapCells, kMapCells, std::move(values));
}

}  // namespace haptex::tactile
