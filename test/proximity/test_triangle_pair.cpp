#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "exact_distance.h"
#include "haptex/proximity/triangle_pair.h"

namespace haptex::proximity::test_triangle_pair {
namespace {

using Eigen::Vector3d;

// Rounding of coordinates of up to 2 m is 4e-16 m, and a few such add up.
constexpr double kRounding = 5e-15;  // m

void expectPointOf(const Triangle& triangle, const Triangle& other, const TrianglePoint& point) {
  EXPECT_GE(point.barycentric.minCoeff(), 0.0);
  EXPECT_LE(point.barycentric.maxCoeff(), 1.0);
  EXPECT_NEAR(point.barycentric.sum(), 1.0, 1e-15);
  EXPECT_NEAR(exactDistance<long double>({point.on(triangle)}, cornersOf(other)), point.distance,
              kRounding);
}

TEST(TrianglePair, DistanceIsThatOfAllSimplicesOfDifferences) {
  RandomTriangles random;
  for (int i = 0; i < 20000; ++i) {
    const Triangle first = random.triangle(random.index(RandomTriangles::kKinds));
    Triangle second = random.triangle(random.index(RandomTriangles::kKinds));
    if (random.index(4) == 0) second[0] = first[1];
    SCOPED_TRACE(i);
    const TrianglePoint point = closestPoint(first, second);
    EXPECT_NEAR(point.distance, exactDistance<long double>(cornersOf(first), cornersOf(second)),
                kRounding);
    expectPointOf(first, second, point);
    EXPECT_NEAR(closestPoint(second, first).distance, point.distance, kRounding);
    if (HasFailure()) return;
  }
}

// Where solving through determinants loses all digits: FCL's own distance is off by 79 um here.
TEST(TrianglePair, NearlyParallelEdgesAndFacesThatNearlyTouchLoseNoDigits) {
  RandomTriangles random;
  for (int i = 0; i < 1000; ++i) {
    Triangle first, second;
    for (Vector3d& corner : first) corner = random.vector();
    const Vector3d way = first[1] - first[0];
    second[0] = first[0] + random.number(0, 1) * way + random.magnitude(-16, -1) * random.vector();
    second[1] =
        second[0] + random.number(-1, 1) * way + random.magnitude(-16, -1) * random.vector();
    second[2] = random.index(2) == 0
                    ? random.vector()
                    : Vector3d(first[2] + random.magnitude(-16, -1) * random.vector());
    SCOPED_TRACE(i);
    EXPECT_NEAR(closestPoint(first, second).distance,
                exactDistance<__float128>(cornersOf(first), cornersOf(second)), kRounding);
    if (HasFailure()) return;
  }
}

// FCL takes triangles of less than about 0.2 mm for segments: their faces are then missed.
TEST(TrianglePair, FindsTheFaceOfATinyTriangle) {
  const double size = 1e-5;
  const Triangle tiny = {Vector3d(0, 0, 0), Vector3d(size, 0, 0), Vector3d(0, size, 0)};
  const Triangle spike = {Vector3d(size / 4, size / 4, size), Vector3d(1, 0, 1), Vector3d(0, 1, 1)};
  const TrianglePoint point = closestPoint(tiny, spike);
  EXPECT_NEAR(point.distance, size, 1e-20);
  EXPECT_TRUE(point.barycentric.isApprox(Vector3d(0.5, 0.25, 0.25), 1e-14));
}

TEST(TrianglePair, TrianglesThatPierceEachOtherHaveNoDistance) {
  RandomTriangles random;
  for (int i = 0; i < 5000; ++i) {
    Triangle first = random.triangle(0), second = random.triangle(0);
    const Vector3d a = 0.3 * first[0] + 0.4 * first[1] + 0.3 * first[2];
    const Vector3d b = 0.2 * second[0] + 0.5 * second[1] + 0.3 * second[2];
    for (Vector3d& corner : second) corner += a - b;
    EXPECT_NEAR(closestPoint(first, second).distance, 0.0, kRounding) << i;
  }
}

}  // namespace
}  // namespace haptex::proximity::test_triangle_pair
