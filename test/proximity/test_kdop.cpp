#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "haptex/proximity/kdop.h"

namespace haptex::proximity::test_kdop {
namespace {

using Eigen::Vector3d;

/// The smallest volume of a kind around some points.
Kdop around(KdopKind kind, const std::vector<Vector3d>& points) {
  Kdop kdop;
  for (const Vector3d& axis : kdopAxes(kind)) {
    for (const Vector3d& normal : {Vector3d(axis), Vector3d(-axis)}) {
      double height = -INFINITY;
      for (const Vector3d& point : points) height = std::max(height, normal.dot(point));
      kdop.push_back({normal, height});
    }
  }
  return kdop;
}

std::vector<Vector3d> pointsOnSphere(int count, double radius) {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  std::vector<Vector3d> points;
  for (int i = 0; i < count; ++i) {
    points.push_back(
        radius * Vector3d(normal(generator), normal(generator), normal(generator)).normalized());
  }
  return points;
}

/// By the divergence theorem; faces seen from outside are counter-clockwise.
double volume(const std::vector<std::vector<Vector3d>>& faces) {
  double sum = 0.0;
  for (const auto& face : faces) {
    for (std::size_t i = 2; i < face.size(); ++i) {
      sum += face[0].dot(face[i - 1].cross(face[i])) / 6.0;
    }
  }
  return sum;
}

TEST(Kdop, EveryKindHasAsManyPlanesAsItsNameSays) {
  EXPECT_EQ(kdopAxes(KdopKind::k6).size(), 3u);
  EXPECT_EQ(kdopAxes(KdopKind::k14).size(), 7u);
  EXPECT_EQ(kdopAxes(KdopKind::k18).size(), 9u);
  EXPECT_EQ(kdopAxes(KdopKind::k26).size(), 13u);
}

TEST(Kdop, NoAxisOccursTwiceNorAsItsOpposite) {
  const auto& axes = kdopAxes(KdopKind::k26);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_GT(axes[i].cross(axes[j]).norm(), 0.5);
  }
}

TEST(Kdop, FacesOfABoxAreItsSides) {
  const auto faces = polytopeFaces(around(KdopKind::k6, {{1, 2, 3}, {2, 4, 6}}), 1e-9);
  ASSERT_EQ(faces.size(), 6u);
  EXPECT_NEAR(volume(faces), 6.0, 1e-12);
}

TEST(Kdop, MorePlanesAreTighterAroundASphere) {
  const auto points = pointsOnSphere(20000, 1.0);
  const double ball = 4.0 / 3.0 * M_PI;
  double last = 2.0 * ball;
  for (KdopKind kind : {KdopKind::k6, KdopKind::k14, KdopKind::k18, KdopKind::k26}) {
    const auto faces = polytopeFaces(around(kind, points), 1e-6);
    EXPECT_EQ(faces.size(), 2 * kdopAxes(kind).size());
    EXPECT_LT(volume(faces), last);
    last = volume(faces);
  }
  EXPECT_GT(last, 0.999 * ball);
  EXPECT_LT(last, 1.15 * ball);
}

TEST(Kdop, CornersOfFacesLieInTheVolume) {
  const Kdop kdop = around(KdopKind::k26, pointsOnSphere(30, 0.01));
  for (const auto& face : polytopeFaces(kdop, 1e-9)) {
    ASSERT_GE(face.size(), 3u);
    for (const Vector3d& corner : face) {
      for (const HalfSpace& half_space : kdop) {
        EXPECT_LE(half_space.normal.dot(corner), half_space.height + 5e-9);
      }
    }
  }
}

TEST(Kdop, FlatVolumeKeepsItsTwoFaces) {
  const auto faces =
      polytopeFaces(around(KdopKind::k26, {{0, 0, 5}, {1, 0, 5}, {1, 1, 5}, {0, 1, 5}}), 1e-6);
  ASSERT_EQ(faces.size(), 2u);
  for (const auto& face : faces) EXPECT_EQ(face.size(), 4u);
}

TEST(Kdop, VolumeOfAPointHasNoFaces) {
  EXPECT_TRUE(polytopeFaces(around(KdopKind::k26, {{1, 2, 3}}), 1e-6).empty());
}

}  // namespace
}  // namespace haptex::proximity::test_kdop
