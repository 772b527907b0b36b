// The oracles of the virtual KES tests: what goes into a fabric file comes out of its cloth.
#include <algorithm>
#include <cmath>

#include "haptex/base/workload.h"
#include "haptex/kes/virtual_kes.h"
#include "haptex/oracles/checks/cloth_oracles.h"

namespace haptex::oracles {
namespace {

constexpr double kCurveTolerance = 1e-6;  // of the largest value of the curve
constexpr double kRigidityTolerance = 0.02;
constexpr double kParameterTolerance = 1e-3;  // Simpson's rule over as few readings as testers take
constexpr double kHysteresisTolerance = 0.02;
constexpr double kTableTolerance = 1e-4;  // the contact law's table

/// The point of each curve that is missed by most.
void sinkCurves(const std::string& fabric, const kes::KesResult& result, const Sink& sink) {
  for (const char* direction : {"weft", "warp"}) {
    double peak = 0.0;
    for (const kes::KesPoint& point : result.points) {
      if (point.direction == direction) peak = std::max(peak, std::abs(point.put_in));
    }
    base::Quantity worst{"", 0.0, 0.0, -1.0, 0.0};
    for (const kes::KesPoint& point : result.points) {
      if (point.direction != direction) continue;
      base::keepWorse(
          worst, base::relativeTo(peak, "cloth/kes/" + fabric + "/" + point.test + "/" + direction,
                                  point.put_in, point.simulated, kCurveTolerance));
    }
    sink(worst);
  }
}

/// Those that are not zero.
void sinkParameters(const std::string& fabric, const kes::KesResult& result, double tolerance,
                    const Sink& sink) {
  for (const kes::KesParameter& parameter : result.parameters) {
    if (parameter.put_in == 0.0) continue;
    sink(base::relativeTo(parameter.put_in, "cloth/kes/" + fabric + "/" + parameter.name,
                          parameter.put_in, parameter.measured, tolerance));
  }
}

material::Fabric withoutHysteresis(material::Fabric fabric) {
  fabric.resilience.reset();
  fabric.shear_hysteresis.reset();
  return fabric;
}

/// All that the tests find where the membrane has the file's hysteresis.
void sinkHysteresis(const material::Fabric& fabric, const std::string& name, const Sink& sink) {
  for (const auto test : {kes::kesTensile, kes::kesShear}) {
    sinkParameters(name, test(fabric), kHysteresisTolerance, sink);
  }
}

/// Wider at 0.5 than at 5 degrees, little work returned along the weft and nearly all along the
/// warp.
material::Fabric unusual(material::Fabric fabric) {
  fabric.resilience = {0.3, 0.95};
  fabric.shear_hysteresis = {3.0, 1.5};
  return fabric;
}

}  // namespace

void validateKesHysteresis(const std::vector<material::Fabric>& fabrics, const Sink& sink) {
  for (const material::Fabric& fabric : fabrics) {
    if (base::kSanitized) break;  // the same lines run below
    sinkHysteresis(fabric, "hysteresis/" + fabric.name, sink);
  }
  sinkHysteresis(unusual(fabrics.front()), "hysteresis/unusual", sink);
}

void validateKes(const material::Fabric& fabric, const material::Fabric& anisotropic,
                 const Sink& sink) {
  const material::Fabric wool = withoutHysteresis(fabric);
  const kes::KesResult tensile = kes::kesTensile(wool);
  sinkCurves(wool.name, tensile, sink);
  sinkParameters(wool.name, tensile, kParameterTolerance, sink);
  const kes::KesResult shear = kes::kesShear(wool);
  sinkCurves(wool.name, shear, sink);
  sinkParameters(wool.name, shear, kCurveTolerance, sink);
  for (const material::Fabric* fabric : {&wool, &anisotropic}) {
    sinkParameters(fabric->name, kes::kesBending(*fabric), kRigidityTolerance, sink);
  }
  sinkParameters(wool.name, kes::kesCompression(wool), kTableTolerance, sink);
}

}  // namespace haptex::oracles
