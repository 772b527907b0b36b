#include "haptex/oracles/experiments/standard_stroke.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "haptex/base/require.h"
#include "haptex/material/fabric_file.h"
#include "haptex/oracles/experiments/known_surfaces.h"
#include "haptex/tactile/drive_waveform.h"

namespace haptex::oracles {
namespace {

/// 1 for the smallest.
std::vector<double> ranks(const std::vector<double>& values) {
  for (const double value : values) {
    if (std::isnan(value)) {
      throw std::invalid_argument("rank correlation of a value that is nan: allowed are numbers");
    }
  }
  if (std::count(values.begin(), values.end(), values.front()) ==
      static_cast<std::ptrdiff_t>(values.size())) {
    throw std::invalid_argument("rank correlation of values that are all " +
                                base::shortNumber(values.front()) +
                                ": allowed are values that differ");
  }
  std::vector<double> result;
  for (const double value : values) {
    const auto less =
        std::count_if(values.begin(), values.end(), [&](double other) { return other < value; });
    const auto equal = std::count(values.begin(), values.end(), value);
    result.push_back(static_cast<double>(less) + 0.5 * (static_cast<double>(equal) + 1.0));
  }
  return result;
}

}  // namespace

RenderedStroke renderStrokes(const tactile::Surface& surface, double speed,
                             const std::function<Sway(double)>& sway) {
  constexpr int kSteps = static_cast<int>(tactile::kTactileRate);
  const double angles[] = {0.0, 45.0, 90.0, 135.0};
  const double share = 1.0 / (std::size(angles) * kSteps * tactile::kContactors);
  tactile::ArrayLimits limits;
  limits.largest_displacement = std::numeric_limits<double>::max();
  RenderedStroke result;
  double time = 0.0;
  for (const double angle : angles) {
    const Eigen::Vector2d velocity = speed * direction(angle);
    Eigen::Vector2d even_way = Eigen::Vector2d::Zero();
    tactile::TouchedFabric touched;
    touched.forces.fill(kStandardForce / tactile::kContactors);
    for (int step = 0; step < kSteps; ++step) {
      const Sway strays = sway ? sway(time) : Sway();
      touched.stroke = {velocity + strays.velocity, kStandardForce};
      touched.placement.origin = even_way + strays.displacement;
      for (const auto& [a40, a320] : tactile::arrayAmplitudes(surface, touched, limits)) {
        result.amplitudes[tactile::k40] += share * a40;
        result.amplitudes[tactile::k320] += share * a320;
        result.intensity += share * std::hypot(a40, a320);
        result.perceived_intensity += share * (std::max(a40, a320) + 0.5 * std::min(a40, a320));
      }
      even_way += tactile::kTactileStep * velocity;
      time += tactile::kTactileStep;
    }
  }
  return result;
}

std::vector<RenderedFabric> renderFabrics(const std::string& config_directory) {
  std::vector<RenderedFabric> fabrics;
  for (const auto& entry : std::filesystem::directory_iterator(config_directory + "/fabrics")) {
    if (entry.path().extension() != ".yaml") continue;
    const material::Fabric fabric = material::loadFabric(entry.path().string());
    if (!fabric.surface) continue;
    fabrics.push_back(
        {fabric.name, fabric.surface->roughness, renderStrokes(tactile::buildSurface(fabric))});
  }
  std::sort(fabrics.begin(), fabrics.end(), [](const RenderedFabric& a, const RenderedFabric& b) {
    return a.roughness < b.roughness;
  });
  return fabrics;
}

std::vector<RenderedFabric> renderWeaves(const std::string& config_directory) {
  using material::WeaveKind;
  constexpr double kRoughness = 5e-6, kFrictionDeviation = 0.02, kIrregularity = 0.15;
  material::Fabric fabric = material::loadFabric(config_directory + "/fabrics/wool.yaml");
  std::vector<RenderedFabric> weaves;
  for (const auto& [name, kind] : {std::pair("plain", WeaveKind::kPlain),
                                   {"twill_2_2", WeaveKind::kTwill22},
                                   {"twill_3_1", WeaveKind::kTwill31},
                                   {"satin_5", WeaveKind::kSatin5},
                                   {"rib_2", WeaveKind::kRib2}}) {
    fabric.surface = {kRoughness, kFrictionDeviation, evenWeave(kind, kIrregularity)};
    weaves.push_back({name, kRoughness, renderStrokes(tactile::buildSurface(fabric), kYarnSpeed)});
  }
  return weaves;
}

double rankCorrelation(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size() || a.size() < 2) {
    throw std::invalid_argument("rank correlation of " + std::to_string(a.size()) + " and " +
                                std::to_string(b.size()) +
                                " values: allowed are two equal numbers of at least 2");
  }
  const std::vector<double> rank_a = ranks(a), rank_b = ranks(b);
  const double mean = 0.5 * (static_cast<double>(a.size()) + 1.0);
  double both = 0.0, of_a = 0.0, of_b = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    both += (rank_a[i] - mean) * (rank_b[i] - mean);
    of_a += std::pow(rank_a[i] - mean, 2);
    of_b += std::pow(rank_b[i] - mean, 2);
  }
  return both / std::sqrt(of_a * of_b);
}

}  // namespace haptex::oracles
