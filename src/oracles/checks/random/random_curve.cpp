// Curves through points, their energies, and what a tester records.
#include <algorithm>
#include <cmath>
#include <vector>

#include "haptex/material/strain_measures.h"
#include "haptex/oracles/checks/random_checks.h"

namespace haptex::oracles {
namespace {

using material::CurvePoint;
using material::StrainStressCurve;

}  // namespace

void randomCurve(const std::string&, Random& random, const Sink& sink) {
  for (int i = 0; i < 4; ++i) {
    const int count = 2 + random.below(30);
    std::vector<CurvePoint> recorded = {{0.0, 0.0}};  // engineering strain, N/m
    const double strain = random.logarithmic(1e-3, 1.0), force = random.logarithmic(0.1, 1e4);
    for (int k = 0; k < count; ++k) {
      recorded.push_back({recorded.back().strain + strain / count * random.uniform(0.1, 1.9),
                          recorded.back().stress + force / count * random.uniform(0.0, 2.0)});
    }
    const std::vector<CurvePoint> points = material::curvePointsFromTester(recorded);
    const StrainStressCurve curve =
        StrainStressCurve::fit(points, material::NegativeBranch::kLinear);
    CaseName text("material", "curve");
    text.with("points", count).with("strain", recorded.back().strain);
    text.with("force", recorded.back().stress);
    base::Quantity worst{"", 0.0, 0.0, -1.0, 0.0};
    double energy = 0.0;
    for (std::size_t k = 1; k < points.size(); ++k) {
      const double begin = points[k - 1].strain, end = points[k].strain;
      const double back = material::forcePerWidth(curve.evaluate(end).stress, end);
      base::keepWorse(worst, base::relativeTo(recorded.back().stress, text.text() + "/recorded",
                                              recorded[k].stress, back, 1e-12));
      // Simpson's rule is exact for cubics.
      energy += (end - begin) / 6.0 *
                (curve.evaluate(begin).stress + 4.0 * curve.evaluate(0.5 * (begin + end)).stress +
                 curve.evaluate(end).stress);
    }
    sink(worst);
    sink(base::relativeTo(energy, text.text() + "/energy", energy,
                          curve.energy(points.back().strain), 1e-12));
  }
}

}  // namespace haptex::oracles
