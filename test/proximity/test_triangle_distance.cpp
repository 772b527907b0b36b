#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "haptex/proximity/cursor.h"
#include "haptex/proximity/triangle_distance.h"

namespace haptex::proximity::test_triangle_distance {
namespace {

using Eigen::Vector3d;

class RandomTriangles : public testing::Test {
 protected:
  Vector3d place(double size) { return size * Vector3d(uniform(), uniform(), uniform()); }
  double uniform() { return uniform_(generator_); }

  /// One triangle in four is a needle, one in four has two equal corners or three on a line.
  Triangle triangle(int kind) {
    Triangle corners{place(1.0), place(1.0), place(1.0)};
    if (kind % 4 == 1) corners[2] = corners[1] + place(1e-6);
    if (kind % 8 == 2) corners[1] = corners[0];
    if (kind % 8 == 6) corners[2] = corners[0] + 0.3 * (corners[1] - corners[0]);
    return corners;
  }

 private:
  std::mt19937 generator_{1};
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
};

/// Smallest value of a convex function on [from, to]. 90 thirds leave 1e-16 of the interval.
double smallest(double from, double to, const std::function<double(double)>& f) {
  for (int i = 0; i < 90; ++i) {
    const double a = from + (to - from) / 3.0, b = to - (to - from) / 3.0;
    (f(a) < f(b) ? to : from) = f(a) < f(b) ? b : a;
  }
  return f(0.5 * (from + to));
}

/// The distance is convex in the weights of two corners.
double distanceBySearch(const Triangle& t, const Vector3d& p) {
  return smallest(0.0, 1.0, [&](double v) {
    return smallest(0.0, 1.0 - v, [&](double w) {
      return ((1.0 - v - w) * t[0] + v * t[1] + w * t[2] - p).norm();
    });
  });
}

void expectWeights(const TrianglePoint& point) {
  EXPECT_GE(point.barycentric.minCoeff(), 0.0);
  EXPECT_LE(point.barycentric.maxCoeff(), 1.0);
  EXPECT_NEAR(point.barycentric.sum(), 1.0, 1e-14);
}

TEST_F(RandomTriangles, DistanceOfAPointIsTheSmallestOverTheTriangle) {
  for (int i = 0; i < 400; ++i) {
    const Triangle corners = triangle(i);
    const Vector3d p = place(i % 3 == 0 ? 3.0 : 1.0);
    const TrianglePoint point = closestPoint(corners, p);
    // The search stops where the function is flat to rounding.
    EXPECT_NEAR(point.distance, distanceBySearch(corners, p), 1e-9) << i;
    EXPECT_NEAR((point.on(corners) - p).norm(), point.distance, 1e-14);
    expectWeights(point);
  }
}

TEST_F(RandomTriangles, DistanceOfACapsuleIsTheSmallestOverItsSpheres) {
  for (int i = 0; i < 4000; ++i) {
    const Triangle corners = triangle(i);
    TaperedCapsule capsule{{place(1.5), 0.3 * std::abs(uniform())},
                           {place(1.5), 0.3 * std::abs(uniform())}};
    if (i % 5 == 1) capsule.end.radius = capsule.begin.radius;
    if (i % 5 == 2) capsule.end.radius = 2.0 * std::abs(uniform());  // may hold the other sphere
    if (i % 7 == 3) capsule.end.centre = capsule.begin.centre + 0.7 * (corners[1] - corners[0]);
    if (i % 7 == 4) capsule.end.centre = capsule.begin.centre;
    const auto at = [&](double t) {
      const Vector3d c = capsule.begin.centre + t * (capsule.end.centre - capsule.begin.centre);
      const double r = capsule.begin.radius + t * (capsule.end.radius - capsule.begin.radius);
      return closestPoint(corners, c).distance - r;
    };
    const TrianglePoint point = closestPoint(corners, capsule);
    EXPECT_NEAR(point.distance, smallest(0.0, 1.0, at), 1e-9) << i;
    expectWeights(point);
    // The point itself has that distance.
    const Triangle single{point.on(corners), point.on(corners), point.on(corners)};
    EXPECT_NEAR(closestPoint(single, capsule).distance, point.distance, 1e-9) << i;
  }
}

TEST(TriangleDistance, EveryRegionOfATriangleHasItsClosestPoint) {
  const Triangle corners{Vector3d(0, 0, 0), Vector3d(2, 0, 0), Vector3d(0, 2, 0)};
  const auto closest = [&](double x, double y) {
    return closestPoint(corners, Vector3d(x, y, 3.0)).on(corners);
  };
  EXPECT_EQ(closest(-1, -1), Vector3d(0, 0, 0));
  EXPECT_EQ(closest(4, -1), Vector3d(2, 0, 0));
  EXPECT_EQ(closest(-1, 4), Vector3d(0, 2, 0));
  EXPECT_EQ(closest(1, -1), Vector3d(1, 0, 0));
  EXPECT_EQ(closest(-1, 1), Vector3d(0, 1, 0));
  EXPECT_EQ(closest(2, 2), Vector3d(1, 1, 0));
  EXPECT_LT((closest(0.5, 0.5) - Vector3d(0.5, 0.5, 0)).norm(), 1e-15);
}

TEST(TriangleDistance, IsNegativeInsideACapsule) {
  const Triangle corners{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};
  const TaperedCapsule through{{{0.25, 0.25, -1}, 0.1}, {{0.25, 0.25, 3}, 0.5}};
  // Widest where the axis has gone through: radius 0.1 + 0.25 * 0.4.
  EXPECT_NEAR(closestPoint(corners, through).distance, -0.2, 1e-15);
}

TEST(TriangleDistance, NormalIsOfUnitLengthOrZero) {
  const Vector3d a(0, 0, 0), b(1e-3, 0, 0), c(0, 1e-3, 0);
  EXPECT_EQ(unitNormal({a, b, c}), Vector3d(0, 0, 1));
  EXPECT_EQ(unitNormal({a, c, b}), Vector3d(0, 0, -1));
  EXPECT_EQ(unitNormal({a, b, b}), Vector3d::Zero());
}

TEST(Cursor, RefusesWhatIsNoVolume) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Vector3d origin = Vector3d::Zero();
  EXPECT_THROW(Cursor::point({nan, 0, 0}), std::invalid_argument);
  EXPECT_THROW(Cursor::point({0, infinity, 0}), std::invalid_argument);
  EXPECT_THROW(Cursor::point({0, 0, 2e9}), std::invalid_argument);
  EXPECT_THROW(Cursor::spheres({}), std::invalid_argument);
  EXPECT_THROW(Cursor::spheres({{origin, -1e-3}}), std::invalid_argument);
  EXPECT_THROW(Cursor::spheres({{origin, 0.1}, {origin, nan}}), std::invalid_argument);
  EXPECT_THROW(Cursor::capsule(origin, {nan, 0, 0}, 0.1), std::invalid_argument);
  EXPECT_THROW(Cursor::taperedCapsule({origin, 0.1}, {origin, infinity}), std::invalid_argument);
  EXPECT_NO_THROW(Cursor::spheres({{origin, 0.0}}));
}

TEST(Cursor, MessageNamesTheValueAndWhatIsAllowed) {
  try {
    Cursor::spheres({{Vector3d::Zero(), -0.25}});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "radius of a cursor -0.25 m: must be from 0 to 1e+09 m");
  }
}

}  // namespace
}  // namespace haptex::proximity::test_triangle_distance
