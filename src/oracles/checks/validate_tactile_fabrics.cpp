// How fabrics feel in the standard stroke.
#include <algorithm>
#include <cmath>
#include <limits>

#include "haptex/oracles/checks/tactile_oracles.h"

namespace haptex::oracles {
namespace {

/// At least or at most: the error is what lacks.
base::Quantity atLeast(double least, std::string name, double measured) {
  return {std::move(name), least, measured,
          std::isnan(measured) ? measured : std::max(0.0, least - measured), 0.0};
}

/// Rough fabrics feel strong.
void validateRanking(const std::string& config_directory, const Sink& sink) {
  constexpr double kMinFabrics = 8.0, kLowest = 1e-6, kHighest = 15e-6;
  constexpr double kTolerance = 0.05;
  const std::vector<RenderedFabric> fabrics = renderFabrics(config_directory);
  sink(atLeast(kMinFabrics, "tactile/ranking/fabrics", static_cast<double>(fabrics.size())));
  if (fabrics.size() < 2) return;
  sink(atLeast(kHighest / kLowest, "tactile/ranking/span_of_roughness",
               fabrics.back().roughness / fabrics.front().roughness));
  std::vector<double> roughness, intensity, perceived;
  for (const RenderedFabric& fabric : fabrics) {
    roughness.push_back(fabric.roughness);
    intensity.push_back(fabric.stroke.intensity);
    perceived.push_back(fabric.stroke.perceived_intensity);
  }
  sink(base::relativeTo(1.0, "tactile/ranking/intensity_and_roughness", 1.0,
                        rankCorrelation(roughness, intensity), kTolerance));
  sink(base::relativeTo(1.0, "tactile/ranking/perceived_intensity_and_roughness", 1.0,
                        rankCorrelation(roughness, perceived), kTolerance));
}

/// Weaves of the same yarns, SMD and MMD differ in the ratio of the two channels: the least
/// difference between any two.
void validateWeaves(const std::string& config_directory, const Sink& sink) {
  constexpr double kMinPercent = 5.0;
  std::vector<double> ratios;
  for (const RenderedFabric& weave : renderWeaves(config_directory)) {
    ratios.push_back(weave.stroke.ratio());
  }
  std::sort(ratios.begin(), ratios.end());
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < ratios.size(); ++i) {
    least = std::min(least, 100.0 * (ratios[i] / ratios[i - 1] - 1.0));
  }
  sink(atLeast(kMinPercent, "tactile/weaves/least_difference_of_ratio_percent", least));
}

}  // namespace

void validateTactileFabrics(const std::string& config_directory, const Sink& sink) {
  validateRanking(config_directory, sink);
  validateWeaves(config_directory, sink);
}

}  // namespace haptex::oracles
