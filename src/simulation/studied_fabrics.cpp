#include "haptex/simulation/studied_fabrics.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace haptex::simulation {

double tensileModulus(const material::Fabric& fabric) {
  return 0.5 * (fabric.weft.elastic.evaluate(0.0).slope + fabric.warp.elastic.evaluate(0.0).slope);
}

std::vector<std::string> studiedFabricNames(const std::vector<scene::Quality>& qualities) {
  std::vector<std::string> names;
  for (const scene::Quality& quality : qualities) {
    for (const scene::MeasuredQuality& measured : quality.measured) {
      const bool known = std::find(names.begin(), names.end(), measured.fabric) != names.end();
      if (!known) names.push_back(measured.fabric);
    }
  }
  return names;
}

const StudiedFabric& nearestStudied(const material::Fabric& fabric,
                                    const std::vector<StudiedFabric>& studied) {
  const double modulus = tensileModulus(fabric);
  const auto distance = [&](const StudiedFabric& other) {
    if (other.name == fabric.name) return -1.0;
    return std::abs(std::log(other.tensile_modulus / modulus));
  };
  return *std::min_element(
      studied.begin(), studied.end(),
      [&](const StudiedFabric& a, const StudiedFabric& b) { return distance(a) < distance(b); });
}

std::vector<scene::MeasuredQuality> measurementsOf(const scene::Quality& quality,
                                                   const std::string& fabric) {
  std::vector<scene::MeasuredQuality> measurements;
  std::copy_if(quality.measured.begin(), quality.measured.end(), std::back_inserter(measurements),
               [&](const scene::MeasuredQuality& measured) { return measured.fabric == fabric; });
  return measurements;
}

}  // namespace haptex::simulation
