#include "haptex/nodes/markers/colour_map.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haptex::nodes {

Eigen::Vector3f viridis(double fraction) {
  // The map at 0, 1/8, ... 1; between them straight lines in RGB stay within 0.02 of it.
  static const std::array<Eigen::Vector3f, 9> colours = {
      Eigen::Vector3f(0.267F, 0.005F, 0.329F), Eigen::Vector3f(0.279F, 0.175F, 0.483F),
      Eigen::Vector3f(0.230F, 0.322F, 0.546F), Eigen::Vector3f(0.173F, 0.449F, 0.558F),
      Eigen::Vector3f(0.128F, 0.567F, 0.551F), Eigen::Vector3f(0.158F, 0.684F, 0.502F),
      Eigen::Vector3f(0.369F, 0.789F, 0.383F), Eigen::Vector3f(0.678F, 0.864F, 0.190F),
      Eigen::Vector3f(0.993F, 0.906F, 0.144F)};
  if (!(fraction > 0.0)) return colours.front();
  if (fraction >= 1.0) return colours.back();
  const double place = fraction * (colours.size() - 1);
  const auto index = static_cast<std::size_t>(place);
  const auto weight = static_cast<float>(place - static_cast<double>(index));
  return (1.0F - weight) * colours[index] + weight * colours[index + 1];
}

double strainFraction(double strain, double full_scale) {
  return strain > 0.0 ? 1.0 + std::log10(strain / full_scale) / kStrainDecades : 0.0;
}

double largestPrincipalStrain(const Eigen::Vector3d& strain) {
  const double mean = 0.5 * (strain[0] + strain[1]);
  const double difference = 0.5 * (strain[0] - strain[1]), shear = 0.5 * strain[2];
  return mean + std::sqrt(difference * difference + shear * shear);
}

Eigen::Vector3f distinctColour(int index) {
  constexpr double kGoldenSection = 0.6180339887498949;
  const double hue = std::fmod(index * kGoldenSection, 1.0);
  Eigen::Vector3f colour;
  for (int channel = 0; channel < 3; ++channel) {
    // 1 at the hue of the channel, falling to 0 a third of the circle away.
    const double distance = std::abs(std::remainder(hue - channel / 3.0, 1.0));
    colour[channel] = static_cast<float>(std::clamp(2.0 - 6.0 * distance, 0.0, 1.0));
  }
  return colour;
}

}  // namespace haptex::nodes
