#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "body/body_fixtures.h"
#include "haptex/base/repeatable_random.h"
#include "haptex/garment/placement/carrier_fit.h"
#include "haptex/garment/placement/carrier_surface.h"

namespace haptex::garment::test_carrier_surface {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

CarrierSurface tilted(double radius, double slope) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.8, Vector3d(1, 2, -1).normalized()));
  return {{0.1, -0.2, 1.1}, turn * Vector3d::UnitZ(), turn * Vector3d::UnitX(), radius, slope};
}

TEST(CarrierSurface, LayingKeepsDistancesAlongTheSurface) {
  base::RepeatableRandom random(1);
  for (const double slope : {0.0, 1e-9, 1e-3, 0.3, -0.3, 0.6}) {
    const CarrierSurface surface = tilted(0.2, slope);
    for (int i = 0; i < 1000; ++i) {
      const PlaceOnSurface place{random.uniform(-4, 4), random.uniform(-0.1, 0.1)};
      const Vector2d a = random.inSquare(-0.1, 0.1), b = random.inSquare(-0.1, 0.1);
      const double length =
          lengthOnSurface(surface, lay(surface, place, a), lay(surface, place, b));
      EXPECT_NEAR(length / (a - b).norm(), 1.0, 1e-11) << slope;
    }
  }
}

TEST(CarrierSurface, LaidPointsLieOnTheCone) {
  base::RepeatableRandom random(2);
  for (const double slope : {0.0, 0.25, -0.5}) {
    const CarrierSurface surface = tilted(0.2, slope);
    for (int i = 0; i < 100; ++i) {
      const Vector3d point =
          lay(surface, {random.uniform(-4, 4), 0.05}, random.inSquare(-0.1, 0.1));
      const double height = (point - surface.origin).dot(surface.up);
      const double radius = (point - surface.origin - height * surface.up).norm();
      EXPECT_NEAR(radius, surface.radiusAt(height), 1e-15);
    }
  }
}

TEST(CarrierSurface, RightSideLooksOutwardsAndLeftIsCounterClockwise) {
  CarrierSurface surface;
  surface.radius = 0.5;
  const Vector3d middle = lay(surface, {0.0, 1.0}, {0, 0});
  EXPECT_EQ(middle, Vector3d(0.5, 0, 1));
  const Vector3d right = lay(surface, {0.0, 1.0}, {0.25 * M_PI, 0}) - middle;
  const Vector3d above = lay(surface, {0.0, 1.0}, {0, 0.1}) - middle;
  EXPECT_NEAR((right - Vector3d(-0.5, 0.5, 0)).norm(), 0.0, 1e-15);  // a quarter turn
  EXPECT_NEAR((above - Vector3d(0, 0, 0.1)).norm(), 0.0, 1e-15);
  EXPECT_GT(right.cross(above).x(), 0.0);
}

TEST(CarrierSurface, StraightEdgesAreChords) {
  CarrierSurface surface;
  surface.radius = 0.1;
  const double chord = (lay(surface, {}, {0.01, 0}) - lay(surface, {}, {-0.01, 0})).norm();
  EXPECT_NEAR(chord, 0.2 * std::sin(0.1), 1e-15);
}

TEST(CarrierFit, CylinderIsAsWideAsNeeded) {
  CarrierSurface surface;
  fitRadius(Carrier::Shape::kCylinder, {{0.0, 0.1}, {0.5, 0.3}, {1.0, 0.2}}, surface);
  EXPECT_EQ(surface.radius, 0.3);
  EXPECT_EQ(surface.slope, 0.0);
}

TEST(CarrierFit, ConeIsTheNarrowestInTheMiddle) {
  CarrierSurface surface;
  // Inside of the line from (0, 0.3) to (1, 0.1).
  fitRadius(Carrier::Shape::kCone, {{0.0, 0.3}, {0.4, 0.2}, {0.7, 0.1}, {1.0, 0.1}}, surface);
  EXPECT_NEAR(surface.radius, 0.3, 1e-15);
  EXPECT_NEAR(surface.slope, 0.2, 1e-15);
  fitRadius(Carrier::Shape::kCone, {{0.0, 3.0}, {1.0, 0.1}}, surface);
  EXPECT_EQ(surface.slope, kSteepestCone);
  EXPECT_GE(surface.radiusAt(0.0), 3.0);
  fitRadius(Carrier::Shape::kCone, {{0.3, 0.2}}, surface);
  EXPECT_EQ(surface.radius, 0.2);
}

TEST(CarrierFit, AxisGoesToTheMiddleOfTheBody) {
  Body body = makePrism(0.1, 1.0, 48);
  for (Vector3d& vertex : body.vertices) vertex += Vector3d(0.03, -0.02, 0);
  SegmentAxis axis(body, 0);
  axis.centre({0.0, 1.0});
  EXPECT_NEAR((axis.axis().origin - Vector3d(0.03, -0.02, 0)).norm(), 0.0, 1e-3);
  for (const NeededRadius& radius : axis.bodyRadii({0.5, 1.0})) {
    EXPECT_GT(radius.height, 0.4);
    EXPECT_LT(radius.radius, 0.101);
  }
}

TEST(CarrierFit, SegmentWithoutLengthIsRefused) {
  Body body = makePrism(0.1, 1.0, 6);
  body.segments[0].end = body.segments[0].start;
  EXPECT_THROW(SegmentAxis(body, 0), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::garment::test_carrier_surface
