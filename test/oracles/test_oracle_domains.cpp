// Every oracle at the ends of the domain that its header states, and beyond.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <string>

#include "../refusal.h"
#include "haptex/contact/sphere_contact.h"
#include "haptex/kes/virtual_kes.h"
#include "haptex/kes/virtual_test.h"
#include "haptex/material/compression.h"
#include "haptex/material/contraction.h"
#include "haptex/material/linear_fabric.h"
#include "haptex/oracles/exact/amplification.h"
#include "haptex/oracles/exact/flat_contact.h"
#include "haptex/oracles/exact/pinched_sheet.h"
#include "haptex/oracles/experiments/cloth_swing.h"
#include "haptex/oracles/experiments/free_strip.h"
#include "haptex/oracles/experiments/hanging_strip.h"
#include "haptex/oracles/experiments/standard_stroke.h"
#include "haptex/oracles/experiments/strip_statics.h"

namespace haptex::oracles::test_oracle_domains {
namespace {

using test::refusalOf;

using cloth::IntegrationMethod;
using kes::Direction;
using material::Fabric;
using material::StrainStressCurve;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
const double kNan = std::nan("");

TEST(Domains, ExactElongationFromNoWeightToAHugeOne) {
  const auto elongation = [](double gravity) { return exactElongation({1.0, 1.0, 1.0, gravity}); };
  EXPECT_EQ(elongation(0.0), 0.0);
  // A light strip: w g L / (2 k), less 3/2 of that squared; a heavy one: l^3 = 2 w g s / k.
  for (const double load : {1e-300, 1e-12, 1e-6}) {
    EXPECT_NEAR(elongation(load), 0.5 * load, 1.1 * load * load + 1e-14 * load) << load;
  }
  for (const double load : {1e9, 1e12}) {
    EXPECT_NEAR(elongation(load), 0.75 * std::cbrt(2.0 * load) - 1.0,
                2.0 / std::cbrt(load) + 1e-12 * std::cbrt(load));
  }
  EXPECT_EQ(refusalOf([&] { elongation(1.1e12); }),
            "exactElongation: weight over modulus is 1.1e+12; it must be <= 1e12");
  EXPECT_EQ(refusalOf([&] { elongation(-1.0); }),
            "exactElongation: gravity is -1; it must be finite and >= 0");
  EXPECT_EQ(refusalOf([] {
              exactElongation({0.5, 0.0, 0.1, 9.81});
            }),
            "exactElongation: modulus is 0; it must be finite and > 0");
  EXPECT_EQ(refusalOf([] {
              exactElongation({kNan, 1.0, 0.1, 9.81});
            }),
            "exactElongation: length is nan; it must be finite and > 0");
}

TEST(Domains, StretchUnderFromNoLoadToThatOfTwiceTheLength) {
  const StrainStressCurve curve = StrainStressCurve::linear(100.0);
  EXPECT_EQ(stretchUnder(0.0, curve), 1.0);
  EXPECT_NEAR(stretchUnder(300.0, curve), kLargestStretch, 1e-15);  // 2 k (4 - 1) / 2
  const double small = 1e-9;
  EXPECT_NEAR(stretchUnder(small, curve), 1.0 + 1e-2 * small, 3e-16);
  const std::string allowed = "; it must be >= 0 and <= 300 N/m";
  EXPECT_EQ(refusalOf([&] { stretchUnder(301.0, curve); }), "stretchUnder: load is 301" + allowed);
  EXPECT_EQ(refusalOf([&] { stretchUnder(-1.0, curve); }), "stretchUnder: load is -1" + allowed);
  EXPECT_EQ(refusalOf([&] { stretchUnder(kNan, curve); }), "stretchUnder: load is nan" + allowed);
}

Fabric contracting(double weft, double warp, double contraction) {
  Fabric fabric = material::linearFabric(weft);
  fabric.warp.elastic = StrainStressCurve::linear(warp);
  fabric.contraction = contraction;
  return fabric;
}

/// A linear fabric pulled along weft has evv = -c euu / kv, and pulls with (ku - c^2 / kv) euu.
void expectLinear(const Fabric& fabric, double weft, double warp, double strain) {
  const double coupling = material::contractionModulus(fabric);
  const double green = strain * (1.0 + 0.5 * strain);
  const double across = -coupling * green / warp;
  const Uniaxial found = exactUniaxial(fabric, Direction::kWeft, strain);
  EXPECT_NEAR(found.transverse_strain, std::sqrt(1.0 + 2.0 * across) - 1.0,
              1e-12 / std::sqrt(1.0 + 2.0 * across))
      << strain;
  const double force = (1.0 + strain) * (weft - coupling * coupling / warp) * green;
  EXPECT_NEAR(found.force, force, 1e-12 * std::abs(force) + 1e-15 * weft) << strain;
}

TEST(Domains, ExactUniaxialFromCollapseToNoWidth) {
  const Fabric even = contracting(100.0, 100.0, 0.3);
  const double most = std::sqrt(1.0 + 1.0 / 0.3) - 1.0;  // c eu = k / 2
  for (const double strain : {-1.0 + 1e-9, -0.5, -1e-9, 0.0, 1e-9, 1.0, most - 1e-6}) {
    expectLinear(even, 100.0, 100.0, strain);
  }
  // Stiff threads that are pushed together: the soft ones grow beyond 1.5 times their length.
  for (const double strain : {-0.9, -0.2, 0.01}) {
    expectLinear(contracting(10000.0, 1.0, 0.3), 10000.0, 1.0, strain);
  }
  const std::string prefix = "exactUniaxial: strain is ";
  EXPECT_EQ(refusalOf([&] { exactUniaxial(even, Direction::kWeft, 1.1); }),
            prefix + "1.1; it must be < 1.081665999, where no width is left");
  EXPECT_EQ(refusalOf([&] { exactUniaxial(even, Direction::kWeft, -1.0); }),
            prefix + "-1; it must be finite and > -1");
  EXPECT_EQ(refusalOf([&] { exactUniaxial(even, Direction::kWeft, kNan); }),
            prefix + "nan; it must be finite and > -1");
}

TEST(Domains, ExactUniaxialOfAFabricThatDoesNotContractKeepsItsWidth) {
  const Uniaxial found = exactUniaxial(material::linearFabric(100.0), Direction::kWarp, 9.0);
  EXPECT_EQ(found.transverse_strain, 0.0);
  EXPECT_DOUBLE_EQ(found.force, 10.0 * 100.0 * 49.5);
}

TEST(Domains, ExactTensileForceFromCollapseOn) {
  const Fabric fabric = material::linearFabric(100.0);
  for (const double stretch : {1e-12, 1e-9, 1e-3, 1.0, 1.0 + 1e-12, 2.0, 1e6}) {
    const double strain = stretch - 1.0;  // what is left of the stretch after this rounding
    const double exact = 20.0 * (1.0 + strain) * strain * (1.0 + 0.5 * strain);
    EXPECT_NEAR(kes::exactTensileForce(fabric, Direction::kWeft, strain), exact,
                1e-14 * std::abs(exact))
        << stretch;
  }
  EXPECT_EQ(refusalOf([&] { kes::exactTensileForce(fabric, Direction::kWeft, -1.0); }),
            "exactTensileForce: strain is -1; it must be finite and > -1");
  EXPECT_EQ(refusalOf([&] { kes::exactTensileForce(fabric, Direction::kWeft, kInfinite); }),
            "exactTensileForce: strain is inf; it must be finite and > -1");
}

TEST(Domains, ExactShearForceOfAnyShear) {
  const Fabric fabric = material::linearFabric(100.0);  // 50 N/m in shear
  for (const double shear : {-1e3, -1.0, -1e-12, 0.0, 1e-12, 1.0, 1e3}) {
    const double exact = 0.2 * (50.0 * shear + shear * 50.0 * shear * shear);
    EXPECT_NEAR(kes::exactShearForce(fabric, shear), exact, 1e-14 * std::abs(exact)) << shear;
  }
  EXPECT_EQ(refusalOf([&] { kes::exactShearForce(fabric, kNan); }),
            "exactShearForce: shear is nan; it must be finite");
}

TEST(Domains, ExactShearStrainUpToSixtyDegrees) {
  // Stiff and soft threads; the height b solves b k ((b^2 (1 + t^2) - 1) / 2) = tension.
  for (const double modulus : {1e7, 100.0, 0.5}) {
    const material::MembraneCurves pulled{StrainStressCurve::linear(modulus), StrainStressCurve()};
    for (const double angle : {-60.0, -8.0, -1e-9, 0.0, 8.0, 60.0}) {
      const double tangent = std::tan(angle * M_PI / 180.0);
      double low = 0.0, high = 1e3;
      for (int i = 0; i < 200; ++i) {
        const double b = 0.5 * (low + high);
        const double tension = b * modulus * 0.5 * (b * b * (1.0 + tangent * tangent) - 1.0);
        (tension < kes::kKesShearTension ? low : high) = b;
      }
      EXPECT_NEAR(kes::exactShearStrain(pulled, angle), low * tangent,
                  1e-11 * std::abs(low * tangent))
          << modulus << ' ' << angle;
    }
  }
  const material::MembraneCurves limp;
  EXPECT_THROW(kes::exactShearStrain(limp, 8.0), std::runtime_error);
  EXPECT_EQ(refusalOf([&] { kes::exactShearStrain(limp, 60.5); }),
            "exactShearStrain: angle is 60.5; it must be within 60 degrees either way");
  EXPECT_EQ(refusalOf([&] { kes::exactShearStrain(limp, kNan); }),
            "exactShearStrain: angle is nan; it must be within 60 degrees either way");
}

contact::ContactLaw lawOf(double modulus, double thickness, double pulp) {
  Fabric fabric;
  fabric.compression = {thickness, StrainStressCurve::linear(modulus)};
  fabric.friction = 0.4;
  return contact::ContactLaw(fabric, {pulp, 2.0});
}

TEST(Domains, ExactDragFromTouchToTheCentre) {
  constexpr double kRadius = 0.008, kThickness = 6e-4, kModulus = 2e4, kPulp = 8e6;
  const contact::ContactLaw law = lawOf(kModulus, kThickness, kPulp);
  const double reach = kRadius + law.halfThickness();
  EXPECT_EQ(exactDrag(law, kRadius, 0.0, 1.0), 0.0);
  EXPECT_EQ(exactDrag(law, kRadius, 1e-4, 0.0), 0.0);
  const double k = 1.0 / (1.0 / kPulp + kThickness / (2.0 * kModulus));
  // Where all slips, with the pressure k e at the depth e: 2 pi mu k (reach d^2/2 - d^3/3). The law
  // is linear up to where the fabric's curve ends, hence up to 3 mm.
  for (const double depth : {1e-15, 1e-9, 1e-6, 1e-4, 3e-3}) {
    const double all = 2.0 * M_PI * 0.4 * k * depth * depth * (0.5 * reach - depth / 3.0);
    EXPECT_NEAR(exactDrag(law, kRadius, depth, kInfinite), all, 1e-8 * all) << depth;
    // Where all sticks but the rim: traction over the area.
    const double displacement = 1e-9 * depth;
    const double stuck = law.tangentialStiffness() * displacement * 2.0 * M_PI *
                         (reach * depth - 0.5 * depth * depth);
    EXPECT_NEAR(exactDrag(law, kRadius, depth, displacement), stuck, 1e-3 * stuck) << depth;
  }
  EXPECT_GT(exactDrag(law, kRadius, reach, 1.0), exactDrag(law, kRadius, 0.9 * reach, 1.0));
  EXPECT_EQ(refusalOf([&] { exactDrag(law, kRadius, 0.01, 1.0); }),
            "exactDrag: depth is 0.01; it must be >= 0 and <= 0.0083 m");
  EXPECT_EQ(refusalOf([&] { exactDrag(law, kRadius, -1e-9, 1.0); }),
            "exactDrag: depth is -1e-09; it must be >= 0 and <= 0.0083 m");
  EXPECT_EQ(refusalOf([&] { exactDrag(law, kRadius, 1e-4, kNan); }),
            "exactDrag: displacement is nan; it must be >= 0 m");
  EXPECT_EQ(refusalOf([&] { exactDrag(law, 0.0, 1e-4, 1.0); }),
            "exactDrag: radius is 0; it must be finite and > 0 m");
}

TEST(Domains, PinchForceFromTouchUntilTheCentresMeet) {
  constexpr double kRadius = 0.008, kThickness = 6e-4, kModulus = 2e4, kPulp = 1.3e7;
  const contact::ContactLaw law = lawOf(kModulus, kThickness, kPulp);
  const double reach = kRadius + law.halfThickness();
  const double k = 1.0 / (1.0 / kPulp + kThickness / (2.0 * kModulus));
  for (const double z : {1e-12, 1e-6, 0.5 * reach, reach - 1e-9}) {
    const double depth = reach - z;
    const double exact = M_PI * z * k * depth * depth;
    // 1e-9 m of depth are known to 1e-9 of them.
    EXPECT_NEAR(pinchForce(law, kRadius, 2.0 * z).force, exact, 1e-8 * exact) << z;
  }
  EXPECT_EQ(pinchForce(law, kRadius, 1e9).force, 0.0);
}

TEST(Domains, GrowthPerStepFromNoStepToAHugeOne) {
  for (const cloth::NamedIntegrationMethod& named : cloth::kIntegrationMethods) {
    EXPECT_EQ(growthPerStep(named.method, 0.0), 1.0) << named.name;
    EXPECT_EQ(refusalOf([&] { growthPerStep(named.method, -1.0); }),
              "growthPerStep: phase is -1; it must be finite and >= 0");
    EXPECT_EQ(refusalOf([&] { growthPerStep(named.method, kInfinite); }),
              "growthPerStep: phase is inf; it must be finite and >= 0");
    for (const double phase : {1e-9, 0.1, 1.0, 2.0, 10.0, 1e6, 1e100}) {
      const double growth = growthPerStep(named.method, phase);
      EXPECT_TRUE(std::isfinite(growth) || !isImplicit(named.method)) << named.name << phase;
      EXPECT_TRUE(!isImplicit(named.method) || growth <= 1.0 + 1e-15) << named.name << phase;
    }
  }
  const double huge = 1e8;
  EXPECT_NEAR(growthPerStep(IntegrationMethod::kBackwardEuler, huge), 1e-8, 1e-16);
  EXPECT_EQ(growthPerStep(IntegrationMethod::kBackwardMidpoint, huge), 1.0);
  EXPECT_NEAR(growthPerStep(IntegrationMethod::kBdf2, huge), 1.0 / std::sqrt(2e8), 1e-7);
  EXPECT_LT(growthPerStep(IntegrationMethod::kTrBdf2, huge), 1e-7);
  // Provot's two steps: stable up to a phase of 2, beyond it not.
  EXPECT_EQ(growthPerStep(IntegrationMethod::kTwoStepEuler, 2.0), 1.0);
  EXPECT_NEAR(growthPerStep(IntegrationMethod::kTwoStepEuler, 3.0),
              3.5 + std::sqrt(3.5 * 3.5 - 1.0), 1e-14);
}

/// The factor by which a recurrence multiplies y' = -i omega y in the long run.
TEST(Domains, GrowthPerStepIsThatOfTheRecurrences) {
  using Complex = std::complex<double>;
  for (const double phase : {0.01, 0.3, 2.0, 20.0}) {
    const Complex z(0.0, -phase);
    Complex before = 1.0, now = 1.0 / (1.0 - z);  // BDF-2 starts with backward Euler
    double growth = 0.0;
    for (int i = 0; i < 3000; ++i) {
      const Complex next = (4.0 * now - before) / (3.0 - 2.0 * z);
      growth = std::abs(next) / std::abs(now);
      before = now / std::abs(next);
      now = next / std::abs(next);
    }
    EXPECT_NEAR(growthPerStep(IntegrationMethod::kBdf2, phase), growth, 1e-9) << phase;
    // The trapezoidal rule up to g, BDF-2 through 0, g and 1.
    const double g = 2.0 - std::sqrt(2.0);
    const Complex middle = (1.0 + 0.5 * g * z) / (1.0 - 0.5 * g * z);
    const double a = 1.0 / (g * (2.0 - g)), b = (1.0 - g) * (1.0 - g) / (g * (2.0 - g)),
                 c = (1.0 - g) / (2.0 - g);
    EXPECT_NEAR(growthPerStep(IntegrationMethod::kTrBdf2, phase),
                std::abs((a * middle - b) / (1.0 - c * z)), 1e-14)
        << phase;
  }
}

TEST(Domains, AmplificationOfNoStepIsNone) {
  for (const cloth::NamedIntegrationMethod& named : cloth::kIntegrationMethods) {
    if (isImplicit(named.method)) {
      EXPECT_THROW(amplification(named.method, 1.0), std::invalid_argument) << named.name;
    } else {
      EXPECT_EQ(amplification(named.method, 0.0), 1.0) << named.name;
      EXPECT_EQ(refusalOf([&] { amplification(named.method, kNan); }),
                "amplification: phase is nan; it must be finite and >= 0");
    }
  }
}

TEST(Domains, RankCorrelationOfTwoPairsOrMany) {
  EXPECT_DOUBLE_EQ(rankCorrelation({1.0, 2.0}, {5.0, 3.0}), -1.0);
  EXPECT_DOUBLE_EQ(rankCorrelation({-kInfinite, kInfinite}, {0.0, 1.0}), 1.0);
  EXPECT_EQ(refusalOf([] {
              rankCorrelation({3.0, 3.0, 3.0}, {1.0, 2.0, 3.0});
            }),
            "rank correlation of values that are all 3: allowed are values that differ");
  EXPECT_EQ(refusalOf([] {
              rankCorrelation({1.0, 2.0}, {0.0, 0.0});
            }),
            "rank correlation of values that are all 0: allowed are values that differ");
  EXPECT_EQ(refusalOf([] {
              rankCorrelation({1.0, 2.0}, {0.0, kNan});
            }),
            "rank correlation of a value that is nan: allowed are numbers");
}

TEST(Domains, ExactSagOverSpanFromTautToDeep) {
  // Taut: a parabola, slack = 1 + 8/3 sag^2; deep: half of the length.
  EXPECT_NEAR(exactSagOverSpan(1.001), std::sqrt(3.0 / 8.0 * 1e-3), 1e-5);
  for (const double slack : {1.001, 1.5, 10.0, 1000.0}) {
    // Sag f and half length s of a catenary: c = (s^2 - f^2) / (2 f), half span = c asinh(s / c).
    const double s = 0.5 * slack, f = exactSagOverSpan(slack);
    const double c = (s * s - f * f) / (2.0 * f);
    EXPECT_NEAR(c * std::asinh(s / c), 0.5, 1e-10) << slack;
  }
  for (const double slack : {1.0, 1001.0, kNan}) {
    EXPECT_NE(refusalOf([&] { exactSagOverSpan(slack); }).find("it must be >= 1.001 and <= 1000"),
              std::string::npos);
  }
}

TEST(Domains, ClothSwingOfTheLargestAmplitudeHasItsLength) {
  for (const int cells : {1, 2, 64}) {
    for (const double amplitude : {-0.1, 0.1}) {
      const ClothSwing swing(material::linearFabric(1000.0), cells, amplitude);
      EXPECT_TRUE(std::isfinite(swing.energy(swing.start()))) << cells;
      EXPECT_GT(swing.energy(swing.start()), 0.0) << cells;
    }
  }
}

}  // namespace
}  // namespace haptex::oracles::test_oracle_domains
