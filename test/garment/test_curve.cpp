#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "haptex/garment/pattern/curve.h"

namespace haptex::garment::test_curve {
namespace {

using Eigen::Vector2d;

// Of a parabola y = a x^2 from 0 to x.
double parabolaLength(double a, double x) {
  const double slope = 2.0 * a * x;
  return 0.5 * x * std::sqrt(1.0 + slope * slope) + std::asinh(slope) / (4.0 * a);
}

// From (0, 0) to (x, a x^2): its control point is where the tangents meet.
Curve parabola(double a, double x) {
  return Curve::quadratic({0.0, 0.0}, {0.5 * x, 0.0}, {x, a * x * x});
}

// The same as a cubic curve.
Curve raised(const Curve& curve) {
  const auto& p = curve.points();
  return Curve::cubic(p[0], (p[0] + 2.0 * p[1]) / 3.0, (2.0 * p[1] + p[2]) / 3.0, p[2]);
}

TEST(Curve, LengthsOfParabolasAreExact) {
  for (const double a : {0.1, 1.0, 7.0, 100.0}) {
    const Curve curve = parabola(a, 0.6);
    const double exact = parabolaLength(a, 0.6);
    EXPECT_NEAR(curve.length(), exact, 1e-12 * exact);
    EXPECT_NEAR(raised(curve).length(), exact, 1e-12 * exact);
  }
}

TEST(Curve, ACurveThatRunsBackInACuspHasTheLengthOfBothWays) {
  // x = t^2 (3 - 2 t), y = 0 has none; this one runs from 0 to 1/2 and back: x = 2 t (1 - t).
  EXPECT_NEAR(Curve::quadratic({0.0, 0.0}, {1.0, 0.0}, {0.0, 0.0}).length(), 1.0, 1e-12);
}

TEST(Curve, LengthsAndAreasOfArcsAreExact) {
  const double r = 0.3;
  for (const double angle : {0.01, 1.0, M_PI, 5.0}) {
    const auto on_circle = [&](double at) {
      return Vector2d(1.0 + r * std::cos(at), 2.0 + r * std::sin(at));
    };
    const Curve arc =
        Curve::arc(on_circle(0.4), on_circle(0.4 + 0.3 * angle), on_circle(0.4 + angle));
    EXPECT_NEAR(arc.length(), r * angle, 1e-12);
    // Closed by the chord it is the segment of a circle.
    const Curve chord = Curve::line({arc.end(), arc.start()});
    EXPECT_NEAR(arc.sweptArea() + chord.sweptArea(), 0.5 * r * r * (angle - std::sin(angle)),
                1e-12);
    EXPECT_NEAR((arc.at(0.5) - on_circle(0.4 + 0.5 * angle)).norm(), 0.0, 1e-12);
    EXPECT_NEAR(arc.reversed().sweptArea(), -arc.sweptArea(), 1e-14);
  }
}

TEST(Curve, AreasUnderBezierCurvesAreExact) {
  // Between the parabola y = a x^2 and its chord: a x^3 / 6, below the chord.
  const Curve curve = parabola(2.0, 0.6);
  const Curve chord = Curve::line({curve.end(), curve.start()});
  EXPECT_NEAR(curve.sweptArea() + chord.sweptArea(), 2.0 * std::pow(0.6, 3) / 6.0, 1e-15);
  EXPECT_NEAR(raised(curve).sweptArea(), curve.sweptArea(), 1e-15);
}

TEST(Curve, ParametersDivideTheLength) {
  const Curve curves[] = {parabola(7.0, 0.6),
                          Curve::cubic({0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {1.0, 1.0}),
                          Curve::arc({0.0, 0.0}, {0.5, 0.2}, {1.0, 0.0})};
  for (const Curve& curve : curves) {
    EXPECT_EQ(curve.parameterAt(0.0), 0.0);
    EXPECT_EQ(curve.parameterAt(curve.length()), 1.0);
    // As many straight lines as their error asks for.
    constexpr int kLines = 20000;
    double passed = 0.0;
    Vector2d before = curve.start();
    const double middle = curve.parameterAt(0.3 * curve.length());
    for (int i = 1; i <= kLines; ++i) {
      const Vector2d point = curve.at(middle * i / kLines);
      passed += (point - before).norm();
      before = point;
    }
    EXPECT_NEAR(passed, 0.3 * curve.length(), 1e-8 * curve.length());
  }
  const Curve line = Curve::line({{0.0, 0.0}, {0.1, 0.0}, {0.1, 0.7}, {0.3, 0.7}});
  EXPECT_NEAR((line.at(line.parameterAt(0.2)) - Vector2d(0.1, 0.1)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((line.at(line.parameterAt(0.9)) - Vector2d(0.2, 0.7)).norm(), 0.0, 1e-15);
}

TEST(Curve, FlattenedItStaysWithinTheTolerance) {
  const Curve curves[] = {parabola(7.0, 0.6),
                          Curve::cubic({0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {1.0, 1.0}),
                          Curve::arc({0.0, 0.0}, {0.5, 0.9}, {1.0, 0.0})};
  for (const Curve& curve : curves) {
    for (const double tolerance : {1e-2, 1e-4}) {
      const auto points = curve.flattened(tolerance);
      EXPECT_EQ(points.front(), curve.start());
      EXPECT_EQ(points.back(), curve.end());
      for (int i = 0; i <= 1000; ++i) {
        const Vector2d point = curve.at(i / 1000.0);
        double nearest = 1.0;
        for (std::size_t p = 1; p < points.size(); ++p) {
          const Vector2d ab = points[p] - points[p - 1];
          const double t =
              std::min(1.0, std::max(0.0, (point - points[p - 1]).dot(ab) / ab.squaredNorm()));
          nearest = std::min(nearest, (point - points[p - 1] - t * ab).norm());
        }
        EXPECT_LE(nearest, tolerance * (1.0 + 1e-9));
      }
    }
  }
}

TEST(Curve, DirectionsAreThoseOfItsTangents) {
  EXPECT_NEAR((parabola(1.0, 0.5).endDirection() - Vector2d(1.0, 1.0).normalized()).norm(), 0.0,
              1e-14);
  const Curve half_turn = Curve::arc({1.0, 0.0}, {0.0, 1.0}, {-1.0, 0.0});
  EXPECT_NEAR((half_turn.startDirection() - Vector2d(0.0, 1.0)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((half_turn.endDirection() - Vector2d(0.0, -1.0)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((half_turn.reversed().startDirection() - Vector2d(0.0, 1.0)).norm(), 0.0, 1e-14);
}

TEST(Curve, RefusesPointsThatDetermineNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Curve::line({{0.0, 0.0}}), std::invalid_argument);
  EXPECT_THROW(Curve::line({{0.0, 0.0}, {nan, 0.0}}), std::invalid_argument);
  EXPECT_THROW(Curve::line({{0.0, 0.0}, {1e4, 0.0}}), std::invalid_argument);
  EXPECT_THROW(Curve::arc({0.0, 0.0}, {0.5, 0.0}, {1.0, 0.0}), std::invalid_argument);
  EXPECT_THROW(Curve::arc({0.0, 0.0}, {0.5, 0.5}, {0.0, 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::garment::test_curve
