#include "haptex/nodes/rviz_plugin/colour_scale.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace haptex::nodes {

double ColourScale::fraction(double value) const {
  if (!(value > 0.0)) return 0.0;
  constexpr float kDecade = 3.32192809F;  // log2(10)
  // In single precision: its logarithm is faster, and errs by far less than a colour has steps.
  const float octaves = std::log2(static_cast<float>(value / full));
  return std::clamp(1.0F + octaves / (kDecade * static_cast<float>(decades)), 0.0F, 1.0F);
}

std::vector<ScaleTick> ColourScale::ticks() const {
  std::vector<ScaleTick> ticks;
  for (int decade = 0; decade <= decades; ++decade) {
    char number[32];
    std::snprintf(number, sizeof(number), "%.4g", factor * full * std::pow(10.0, decade - decades));
    ticks.push_back({static_cast<double>(decade) / decades, number + unit});
  }
  return ticks;
}

ColourScale scaleOf(ColourBy quantity) {
  switch (quantity) {
    case ColourBy::kStrain:
      return {"strain", 0.01, 4, 100.0, " %"};
    case ColourBy::kStress:
      return {"stress, N/m", 100.0, 4};
    case ColourBy::kContactForce:
      return {"force per particle, mN", 0.1, 3, 1000.0};
    case ColourBy::kFabric:
    case ColourBy::kPanel:
    case ColourBy::kLook:
      break;
  }
  throw std::invalid_argument("fabrics, panels and looks have colours, but no scale");
}

}  // namespace haptex::nodes
