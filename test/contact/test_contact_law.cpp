#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "haptex/contact/contact_law.h"
#include "haptex/material/compression.h"

namespace haptex::contact::test_contact_law {
namespace {

using material::Compression;
using material::CurveValue;
using material::Fabric;
using material::StrainStressCurve;

Fabric fabricWith(const Compression& compression) {
  Fabric fabric;
  fabric.name = "sample";
  fabric.compression = compression;
  fabric.friction = 0.2;
  return fabric;
}

Compression softCompression() { return material::compressionFromKes({0.7e-3, 0.45e-3, 0.2}); }

template <typename F>
double bisect(double low, double high, F is_too_large) {
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (is_too_large(middle) ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

// The two springs in series, solved without the class: first the fabric's strain for a pressure,
// then the pressure for a depth.
double seriesPressure(const Compression& fabric, double pulp_stiffness, double depth) {
  const auto depth_at = [&](double pressure) {
    const double strain =
        bisect(0.0, 1.0, [&](double e) { return fabric.pressure.evaluate(e).stress > pressure; });
    return pressure / pulp_stiffness + 0.5 * fabric.thickness * strain;
  };
  return bisect(0.0, 1e7, [&](double pressure) { return depth_at(pressure) > depth; });
}

TEST(ContactLaw, PutsLinearSpringsInSeriesExactly) {
  const double modulus = 2e4, thickness = 6e-4, pulp = 1.3e7;
  const ContactLaw law(fabricWith({thickness, StrainStressCurve::linear(modulus)}), {pulp, 2.0});
  const double stiffness = 1.0 / (1.0 / pulp + thickness / (2.0 * modulus));
  for (const double depth : {1e-9, 1e-6, 1e-4, 1e-3, 5e-3, 2e-2}) {
    const CurveValue value = law.pressure(depth);
    EXPECT_NEAR(value.stress, stiffness * depth, 1e-9 * stiffness * depth) << depth;
    EXPECT_NEAR(value.slope, stiffness, 1e-9 * stiffness) << depth;
  }
}

TEST(ContactLaw, AgreesWithTheSeriesOfPulpAndHalfTheFabric) {
  for (const double pulp : {1e6, 1.3e7, 1e9}) {
    const Fabric fabric = fabricWith(softCompression());
    const ContactLaw law(fabric, {pulp, 2e-3});
    // Down to depths of which the fabric takes everything, up to those of the pulp.
    for (double depth = 1e-7; depth < 5e-3; depth *= 1.17) {
      const double expected = seriesPressure(*fabric.compression, pulp, depth);
      if (expected > 2e6) break;  // beyond the table
      EXPECT_NEAR(law.pressure(depth).stress, expected, 1e-4 * expected) << pulp << ' ' << depth;
    }
  }
}

TEST(ContactLaw, GivesAPinchedFabricTheThicknessOfItsCompressionCurve) {
  // Two rigid plates (a pulp that does not yield) closer by twice the depth.
  const Fabric fabric = fabricWith(softCompression());
  const ContactLaw law(fabric, {1e13, 2e-3});
  // From the KES numbers: 49.03325 Pa at T0 = 0.7 mm, 4903.325 Pa at Tm = 0.45 mm.
  EXPECT_NEAR(law.pressure(law.halfThickness() - 0.35e-3).stress, 49.03325, 1e-3 * 49.03325);
  EXPECT_NEAR(law.pressure(law.halfThickness() - 0.225e-3).stress, 4903.325, 1e-4 * 4903.325);
}

TEST(ContactLaw, HasTheSlopeOfItsPressure) {
  const ContactLaw law(fabricWith(softCompression()));
  for (double depth = 1e-6; depth < 6e-3; depth *= 1.31) {
    const double step = 1e-4 * depth;
    const double difference =
        (law.pressure(depth + step).stress - law.pressure(depth - step).stress) / (2.0 * step);
    // The difference quotient of a cubic errs by its third derivative times step^2 / 6; across a
    // knot by the jump of the second derivative times step.
    EXPECT_NEAR(law.pressure(depth).slope, difference, 1e-4 * difference) << depth;
  }
}

TEST(ContactLaw, IsZeroOutsideAndNeverPullsOrFalls) {
  const ContactLaw law(fabricWith(softCompression()));
  for (const double depth : {-1.0, -1e-9, 0.0}) {
    EXPECT_EQ(law.pressure(depth).stress, 0.0);
    EXPECT_EQ(law.pressure(depth).slope, 0.0);
  }
  CurveValue before{0.0, 0.0};
  for (double depth = 1e-6; depth < 1e-2; depth += 1e-6) {
    const CurveValue value = law.pressure(depth);
    ASSERT_GT(value.stress, before.stress) << depth;
    ASSERT_GE(value.slope, 0.0) << depth;
    before = value;
  }
  EXPECT_TRUE(std::isnan(law.pressure(std::numeric_limits<double>::quiet_NaN()).stress));
}

TEST(ContactLaw, IsContinuousWithItsSlope) {
  // From one nanometre to the next the pressure changes by no more than the pulp's slope explains.
  // The slope rises to that of the pulp within about 0.1 mm, so smoothly by 1e-5 of it.
  const ContactLaw law(fabricWith(softCompression()));
  CurveValue before = law.pressure(1e-9);
  for (double depth = 2e-9; depth < 5e-4; depth += 1e-9) {
    const CurveValue value = law.pressure(depth);
    ASSERT_NEAR(value.stress, before.stress, PulpSettings().stiffness * 1.01e-9) << depth;
    ASSERT_NEAR(value.slope, before.slope, PulpSettings().stiffness * 1e-4) << depth;
    before = value;
  }
}

TEST(ContactLaw, ApproachesThePulpAloneWhenTheFabricIsCompressed) {
  const ContactLaw law(fabricWith(softCompression()));
  const double pulp = PulpSettings().stiffness;
  EXPECT_NEAR(law.pressure(5e-3).slope, pulp, 0.01 * pulp);
  EXPECT_LT(law.pressure(5e-3).slope, pulp);
}

TEST(ContactLaw, TakesItsNumbersFromFabricAndPulp) {
  const ContactLaw law(fabricWith({6e-4, StrainStressCurve::linear(1e4)}), {3e6, 5e-3});
  EXPECT_EQ(law.halfThickness(), 3e-4);
  EXPECT_EQ(law.friction(), 0.2);
  EXPECT_EQ(law.damping(), 5e-3);
  EXPECT_DOUBLE_EQ(law.tangentialStiffness(), 2e6);  // Mindlin's 2/3 for a pulp of constant volume
}

std::string refusalOf(const Fabric& fabric, const PulpSettings& pulp = {}) {
  return test::refusalOf([&] { ContactLaw law(fabric, pulp); });
}

TEST(ContactLaw, NamesTheMissingProperty) {
  Fabric fabric = fabricWith(softCompression());
  fabric.friction.reset();
  EXPECT_EQ(refusalOf(fabric), "fabric sample: contact needs the property 'friction'");
  fabric = fabricWith(softCompression());
  fabric.compression.reset();
  EXPECT_EQ(refusalOf(fabric), "fabric sample: contact needs the property 'compression'");
}

TEST(ContactLaw, RefusesPulpsThatAreNone) {
  const Fabric fabric = fabricWith(softCompression());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusalOf(fabric, {0.0, 1e-3}), "pulp: stiffness 0 must be finite and > 0");
  EXPECT_EQ(refusalOf(fabric, {-1.0, 1e-3}), "pulp: stiffness -1 must be finite and > 0");
  EXPECT_EQ(refusalOf(fabric, {nan, 1e-3}), "pulp: stiffness nan must be finite and > 0");
  EXPECT_EQ(refusalOf(fabric, {1e7, 0.0}), "pulp: damping 0 must be finite and > 0");
  EXPECT_EQ(refusalOf(fabric, {1e7, nan}), "pulp: damping nan must be finite and > 0");
}

// k layers and a half are the half of one fabric that is 2 k + 1 times as thick.
TEST(ContactLaw, PutsLayersInSeries) {
  const Compression one = softCompression();
  const ContactLaw layered(fabricWith(one), {}, 4);
  for (int before = 0; before < 4; ++before) {
    const ContactLaw thick(fabricWith({(2 * before + 1) * one.thickness, one.pressure}));
    const double reach = layered.reachThrough(before);
    EXPECT_DOUBLE_EQ(reach, thick.halfThickness());
    for (const double depth : {-1e-5, 1e-6, 5e-5, 2e-4, 6e-4}) {
      const CurveValue value = layered.pressureThrough(before, reach - depth);
      const CurveValue exact = thick.pressure(depth);
      EXPECT_NEAR(value.stress, exact.stress, 1e-9 * (1.0 + exact.stress)) << before;
      EXPECT_NEAR(value.slope, exact.slope, 1e-9 * (1.0 + exact.slope)) << before;
    }
  }
}

TEST(ContactLaw, GoesOnEvenlyFromOneNumberOfLayersToTheNext) {
  const ContactLaw law(fabricWith(softCompression()), {}, 3);
  const double distance = 3e-4;
  const double none = law.pressureThrough(0.0, distance).stress;
  const double one = law.pressureThrough(1.0, distance).stress;
  ASSERT_GT(one, none);
  EXPECT_NEAR(law.pressureThrough(0.25, distance).stress, 0.75 * none + 0.25 * one, 1e-9 * one);
  EXPECT_NEAR(law.pressureThrough(1.0 - 1e-9, distance).stress, one, 1e-6 * one);
}

}  // namespace
}  // namespace haptex::contact::test_contact_law
