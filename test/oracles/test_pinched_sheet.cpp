#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "../refusal.h"
#include "haptex/contact/sphere_contact.h"
#include "haptex/material/compression.h"
#include "haptex/oracles/exact/pinched_sheet.h"

namespace haptex::oracles::test_pinched_sheet {
namespace {

using contact::ContactLaw;

constexpr double kRadius = 0.008;  // m

material::Fabric fabricWith(const material::Compression& compression) {
  material::Fabric fabric;
  fabric.compression = compression;
  fabric.friction = 0.2;
  return fabric;
}

ContactLaw softLaw() {
  return ContactLaw(fabricWith(material::compressionFromKes({0.7e-3, 0.45e-3, 0.2})));
}

TEST(PinchedSheet, HasTheClosedFormOfALinearLaw) {
  // Pressure k depth: force = pi z k depth^2.
  const double thickness = 6e-4, modulus = 2e4, pulp = 1.3e7;
  const ContactLaw law(fabricWith({thickness, material::StrainStressCurve::linear(modulus)}),
                       {pulp, 2.0});
  const double k = 1.0 / (1.0 / pulp + thickness / (2.0 * modulus));
  for (const double depth : {1e-6, 1e-4, 1e-3, 3e-3}) {
    const double z = kRadius + thickness / 2.0 - depth;
    const PinchForce pinch = pinchForce(law, kRadius, 2.0 * z);
    const double force = M_PI * z * k * depth * depth;
    EXPECT_NEAR(pinch.force, force, 1e-9 * force) << depth;
    // - d force / d distance.
    const double stiffness = M_PI * k * (z * depth - depth * depth / 2.0);
    EXPECT_NEAR(pinch.stiffness, stiffness, 1e-9 * stiffness) << depth;
    const double reach = kRadius + thickness / 2.0;
    EXPECT_NEAR(pinch.area, M_PI * (reach * reach - z * z), 1e-15);
  }
}

TEST(PinchedSheet, IsTheSumOverRingsOfTheSheet) {
  const ContactLaw law = softLaw();
  const double reach = kRadius + law.halfThickness();
  for (const double depth : {5e-5, 4e-4, 2e-3}) {
    const double z = reach - depth;
    const double rim = std::sqrt(reach * reach - z * z);
    constexpr int kRings = 200000;
    double force = 0.0;
    for (int i = 0; i < kRings; ++i) {
      const double rho = rim * (i + 0.5) / kRings;
      const double s = std::hypot(rho, z);
      force += law.pressure(reach - s).stress * z / s * 2.0 * M_PI * rho * rim / kRings;
    }
    // The midpoint rule errs by about 1 / kRings^2.
    EXPECT_NEAR(pinchForce(law, kRadius, 2.0 * z).force, force, 1e-8 * force) << depth;
  }
}

TEST(PinchedSheet, HasTheStiffnessOfItsForce) {
  const ContactLaw law = softLaw();
  const double reach = kRadius + law.halfThickness();
  for (const double depth : {5e-5, 4e-4, 2e-3}) {
    const double distance = 2.0 * (reach - depth), step = 1e-4 * depth;
    const double difference = (pinchForce(law, kRadius, distance - step).force -
                               pinchForce(law, kRadius, distance + step).force) /
                              (2.0 * step);
    EXPECT_NEAR(pinchForce(law, kRadius, distance).stiffness, difference, 1e-5 * difference);
  }
}

TEST(PinchedSheet, FeelsNothingUntilBothTouch) {
  const ContactLaw law = softLaw();
  const PinchForce pinch = pinchForce(law, kRadius, 2.0 * (kRadius + law.halfThickness()));
  EXPECT_EQ(pinch.force, 0.0);
  EXPECT_EQ(pinch.stiffness, 0.0);
  EXPECT_EQ(pinch.area, 0.0);
  EXPECT_GT(pinchForce(law, kRadius, 2.0 * kRadius).force, 0.0);
}

TEST(PinchedSheet, IsWhatParticleContactConvergesTo) {
  // A square grid of particles in the plane z = 0 under one of the spheres. The force of a smooth
  // pressure that fades out at its rim converges with at least the square of the spacing.
  const ContactLaw law = softLaw();
  const double depth = 1e-3, z = kRadius + law.halfThickness() - depth;
  const double expected = pinchForce(law, kRadius, 2.0 * z).force;
  contact::Fingertip fingertip;
  fingertip.position = {0.13e-3, -0.29e-3, -z};  // not on a particle
  fingertip.radius = kRadius;
  const auto error_at = [&](double spacing) {
    std::vector<Eigen::Vector3d> positions;
    const int half = static_cast<int>(0.008 / spacing);
    for (int i = -half; i <= half; ++i) {
      for (int j = -half; j <= half; ++j) positions.emplace_back(i * spacing, j * spacing, 0.0);
    }
    const std::vector<Eigen::Vector3d> velocities(positions.size(), Eigen::Vector3d::Zero());
    const std::vector<double> areas(positions.size(), spacing * spacing);
    contact::SphereContact contact(law, positions.size());
    double force = 0.0;
    for (const auto& touched : contact.evaluate(
             {positions, velocities, areas, static_cast<int>(positions.size())}, fingertip)) {
      force += touched.force().z();
    }
    return std::abs(force - expected) / expected;
  };
  EXPECT_LT(error_at(1e-3), 2e-2);
  EXPECT_LT(error_at(0.25e-3), 2e-3);
  EXPECT_LT(error_at(0.0625e-3), 2e-4);
}

std::string refusalOf(double radius, double distance) {
  return test::refusalOf([&] { pinchForce(softLaw(), radius, distance); });
}

TEST(PinchedSheet, RefusesSpheresThatAreNone) {
  EXPECT_EQ(refusalOf(0.0, 0.016), "pinch: radius 0 must be finite and > 0");
  EXPECT_EQ(refusalOf(0.008, -0.016), "pinch: distance -0.016 must be finite and > 0");
  EXPECT_EQ(refusalOf(0.008, std::numeric_limits<double>::quiet_NaN()),
            "pinch: distance nan must be finite and > 0");
}

}  // namespace
}  // namespace haptex::oracles::test_pinched_sheet
