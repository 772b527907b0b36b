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

std::vector<scene::Quality> qualitiesFor(const material::Fabric& fabric,
                                         const std::vector<scene::Quality>& qualities,
                                         const std::vector<StudiedFabric>& studied) {
  std::vector<StudiedFabric> served;
  for (const StudiedFabric& of : studied) {
    if (std::any_of(qualities.begin(), qualities.end(),
                    [&](const scene::Quality& quality) { return quality.fabric == of.name; })) {
      served.push_back(of);
    }
  }
  const std::string nearest = served.empty() ? "" : nearestStudied(fabric, served).name;
  std::vector<scene::Quality> chosen;
  std::copy_if(qualities.begin(), qualities.end(), std::back_inserter(chosen),
               [&](const scene::Quality& quality) {
                 return quality.fabric.empty() || quality.fabric == nearest;
               });
  return chosen;
}

std::vector<scene::MeasuredQuality> measurementsOf(const scene::Quality& quality,
                                                   const std::string& fabric) {
  std::vector<scene::MeasuredQuality> measurements;
  std::copy_if(quality.measured.begin(), quality.measured.end(), std::back_inserter(measurements),
               [&](const scene::MeasuredQuality& measured) { return measured.fabric == fabric; });
  return measurements;
}

}  // namespace haptex::simulation
