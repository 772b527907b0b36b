#include <gtest/gtest.h>

#include <cmath>

#include "haptex/oracles/exact/elastica.h"
#include "haptex/oracles/experiments/strip_statics.h"

namespace haptex::oracles::test_strip_statics {
namespace {

TEST(StripStatics, TheCatenaryHasTheLengthOfTheStrip) {
  // Sag f and half length s of a catenary: c = (s^2 - f^2) / (2 f), half span = c asinh(s / c).
  const double s = 0.5 * 5.0 / 3.0, f = exactSagOverSpan();
  const double c = (s * s - f * f) / (2.0 * f);
  EXPECT_NEAR(c * std::asinh(s / c), 0.5, 1e-12);
}

TEST(StripStatics, ACantileverConvergesUnderRefinement) {
  const double exact = exactDropOverReach(1.0);
  for (StripMesh mesh : {StripMesh::kOneWay, StripMesh::kAlternating, StripMesh::kIrregular}) {
    Cantilever cantilever{1.0, mesh};
    const auto error = [&](int cells) {
      cantilever.cells = cells;
      return std::abs(simulatedDropOverReach(cantilever) / exact - 1.0);
    };
    // Of second order: 1/9. What the strip stretches, 3e-5, is left at last.
    EXPECT_LT(error(24), 0.15 * error(8)) << static_cast<int>(mesh);
  }
}

}  // namespace
}  // namespace haptex::oracles::test_strip_statics
