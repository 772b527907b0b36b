// Free strips: of linear fabrics, pulled obliquely to their threads; and along the threads of
// fabrics whose curves stiffen, with transverse contraction.
#include <algorithm>
#include <cmath>
#include <vector>

#include "haptex/base/workload.h"
#include "haptex/material/contraction.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/experiments/free_strip.h"

namespace haptex::oracles {
namespace {

/// A curve that stiffens: its slope grows from the modulus (N/m).
material::StrainStressCurve drawCurve(Random& random, double modulus) {
  double strain = 0.0, stress = 0.0;
  std::vector<material::CurvePoint> points = {{0.0, 0.0}};
  for (int i = 0; i < 5; ++i) {
    const double further = random.uniform(0.02, 0.06);
    strain += further;
    stress += modulus * further;
    points.push_back({strain, stress});
    modulus *= random.uniform(1.0, 1.6);
  }
  return material::StrainStressCurve::fit(points, material::NegativeBranch::kLinear);
}

void drawMesh(Random& random, FreeStrip& strip) {
  strip.along = random.chance(0.5) ? kes::Direction::kWeft : kes::Direction::kWarp;
  strip.cells_along = 12 + random.below(13);
  strip.cells_across = 2 * (1 + random.below(3));
  strip.seed = 1 + random.below(1000000);
}

void compare(const CaseName& text, const Uniaxial& exact, const Uniaxial& measured,
             const Sink& sink) {
  // Uniform strains are exact on any mesh: what is left is where the equations count as solved.
  constexpr double kTolerance = 1e-9;
  sink(base::relativeTo(1.0 + exact.strain, text.text() + "/stretch", 1.0 + exact.strain,
                        1.0 + measured.strain, kTolerance));
  sink(base::relativeTo(1.0 + exact.transverse_strain, text.text() + "/transverse_stretch",
                        1.0 + exact.transverse_strain, 1.0 + measured.transverse_strain,
                        kTolerance));
}

}  // namespace

void randomTensile(const std::string&, Random& random, const Sink& sink) {
  for (int i = 0; i < base::unlessSanitized(4, 1); ++i) {
    const double weft = random.logarithmic(10.0, 1e4);  // N/m
    const double warp = weft * random.logarithmic(0.2, 5.0);
    const double shear = std::min(weft, warp) * random.uniform(0.1, 0.8);
    FreeStrip strip;
    strip.fabric.name = "drawn";
    strip.fabric.areal_density = random.logarithmic(0.03, 1.0);
    strip.fabric.weft.elastic = material::StrainStressCurve::linear(weft);
    strip.fabric.warp.elastic = material::StrainStressCurve::linear(warp);
    strip.fabric.shear.elastic = material::StrainStressCurve::linear(shear);
    if (random.chance(0.5)) strip.fabric.contraction = random.uniform(0.05, 0.5);
    strip.grain = random.uniform(-0.5 * M_PI, 0.5 * M_PI);
    drawMesh(random, strip);
    const double stress = shear * random.logarithmic(0.01, 0.3);
    const Uniaxial exact = exactObliqueUniaxial(strip.fabric, strip.along, strip.grain, stress);
    CaseName text("cloth", "tensile/oblique");
    text.with(nameOf(strip.along)).with("grain", strip.grain);
    text.with("weft", weft).with("warp", warp).with("shear", shear);
    text.with("contraction", strip.fabric.contraction.value_or(0.0)).with("force", exact.force);
    compare(text, exact, simulateUniaxial(strip, exact.force), sink);
  }
}

void randomContraction(const std::string&, Random& random, const Sink& sink) {
  for (int i = 0; i < base::unlessSanitized(4, 1); ++i) {
    FreeStrip strip;
    const double weft = random.logarithmic(20.0, 2e3);  // N/m
    strip.fabric.name = "drawn";
    strip.fabric.areal_density = random.logarithmic(0.03, 1.0);
    strip.fabric.weft.elastic = drawCurve(random, weft);
    strip.fabric.warp.elastic = drawCurve(random, weft * random.logarithmic(0.3, 3.0));
    strip.fabric.shear.elastic = material::StrainStressCurve::linear(0.2 * weft);
    strip.fabric.contraction = random.uniform(0.05, 0.5) * largestContraction(strip.fabric);
    drawMesh(random, strip);
    const double strain = random.uniform(0.005, 0.15);
    const Uniaxial exact = exactUniaxial(strip.fabric, strip.along, strain);
    CaseName text("cloth", "contraction");
    text.with(nameOf(strip.along)).with("strain", strain);
    text.with("contraction", *strip.fabric.contraction).with("force", exact.force);
    compare(text, exact, simulateUniaxial(strip, exact.force), sink);
  }
}

}  // namespace haptex::oracles
