// Free strips of linear fabrics, pulled obliquely to their threads.
#include "haptex/base/workload.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/experiments/free_strip.h"

namespace haptex::oracles {
namespace {

// Uniform strains are exact on any mesh: what is left is where the equations count as solved.
constexpr double kStretchTolerance = 1e-9;

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
    strip.along = random.chance(0.5) ? kes::Direction::kWeft : kes::Direction::kWarp;
    strip.cells_along = 12 + random.below(13);
    strip.cells_across = 2 * (1 + random.below(3));
    strip.seed = 1 + random.below(1000000);
    const double stress = shear * random.logarithmic(0.01, 0.3);
    const Uniaxial exact = exactObliqueUniaxial(strip.fabric, strip.along, strip.grain, stress);
    const Uniaxial measured = simulateUniaxial(strip, exact.force);
    CaseName text("cloth", "tensile/oblique");
    text.with(strip.along == kes::Direction::kWeft ? "weft" : "warp").with("grain", strip.grain);
    text.with("weft", weft).with("warp", warp).with("shear", shear);
    text.with("contraction", strip.fabric.contraction.value_or(0.0)).with("force", exact.force);
    sink(base::relativeTo(1.0 + exact.strain, text.text() + "/stretch", 1.0 + exact.strain,
                          1.0 + measured.strain, kStretchTolerance));
    sink(base::relativeTo(1.0 + exact.transverse_strain, text.text() + "/transverse_stretch",
                          1.0 + exact.transverse_strain, 1.0 + measured.transverse_strain,
                          kStretchTolerance));
  }
}

}  // namespace haptex::oracles
