#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "../refusal.h"
#include "exact_distance.h"
#include "haptex/base/workload.h"
#include "haptex/proximity/rigid_obstacle.h"

namespace haptex::proximity::test_rigid_obstacle {
namespace {

using test::refusalOf;

using Eigen::Vector3d;
using Triangles = std::vector<std::array<int, 3>>;

// Rounding of coordinates of up to 3 m is 4e-16 m; a change of frame and the distance add up some.
// The promise is 1e-9 m.
constexpr double kRounding = 2e-14;  // m

// A convex body within `radius` of the hull of some points, in its own frame.
struct Hull {
  RigidObstacle obstacle;
  std::vector<Vector3d> points;
  double radius;
};

std::vector<Vector3d> boxCorners(const Vector3d& sides) {
  std::vector<Vector3d> corners;
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      for (const double z : {-0.5, 0.5}) corners.push_back(Vector3d(x, y, z).cwiseProduct(sides));
    }
  }
  return corners;
}

Hull randomSphere(RandomTriangles& random) {
  const double radius = random.magnitude(-3, 0);
  return {RigidObstacle::sphere(radius), {Vector3d::Zero()}, radius};
}

Hull randomCapsule(RandomTriangles& random) {
  const double radius = random.magnitude(-3, 0), length = random.magnitude(-3, 0);
  return {
      RigidObstacle::capsule(radius, length), {{0, 0, -length / 2}, {0, 0, length / 2}}, radius};
}

Hull randomBox(RandomTriangles& random) {
  const Vector3d sides(random.magnitude(-3, 0), random.magnitude(-3, 0), random.magnitude(-3, 0));
  return {RigidObstacle::box(sides), boxCorners(sides), 0.0};
}

std::vector<Vector3d> transformed(const Eigen::Isometry3d& pose, std::vector<Vector3d> points) {
  for (Vector3d& point : points) point = pose * point;
  return points;
}

void expectExact(const Hull& hull, const Triangle& triangle) {
  const std::vector<Vector3d> points = transformed(hull.obstacle.pose(), hull.points);
  const TrianglePoint point = hull.obstacle.closestPoint(triangle);
  const auto from_hull = [&](const std::vector<Vector3d>& corners) {
    return std::max(0.0, exactDistance<long double>(points, corners) - hull.radius);
  };
  const double exact = from_hull(cornersOf(triangle));
  EXPECT_NEAR(point.distance, exact, kRounding);
  if (exact == 0.0) {
    EXPECT_EQ(point.distance, 0.0);
  }
  EXPECT_GE(point.barycentric.minCoeff(), 0.0);
  EXPECT_LE(point.barycentric.maxCoeff(), 1.0);
  EXPECT_NEAR(point.barycentric.sum(), 1.0, 1e-15);
  EXPECT_NEAR(from_hull({point.on(triangle)}), exact, kRounding)
      << "the point has another distance";
}

void expectExactForAllKinds(Hull (*make)(RandomTriangles&), int cases) {
  RandomTriangles random;
  int overlaps = 0;
  for (int i = 0; i < cases; ++i) {
    Hull hull = make(random);
    hull.obstacle.setPose(random.pose(random.magnitude(-3, 0)));
    const Triangle triangle = random.triangle(i % RandomTriangles::kKinds);
    SCOPED_TRACE(i);
    expectExact(hull, triangle);
    overlaps += hull.obstacle.closestPoint(triangle).distance == 0.0;
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(overlaps, cases / 20) << "hardly any case overlaps";
  EXPECT_LT(overlaps, cases * 19 / 20) << "hardly any case is apart";
}

TEST(RigidObstacle, SphereHasTheDistanceOfItsCentreLessItsRadius) {
  expectExactForAllKinds(randomSphere, 20000);
}

TEST(RigidObstacle, CapsuleHasTheDistanceOfItsSegmentLessItsRadius) {
  expectExactForAllKinds(randomCapsule, 20000);
}

TEST(RigidObstacle, BoxHasTheDistanceOfTheHullOfItsCorners) {
  expectExactForAllKinds(randomBox, 1200);
}

// The cloth of the shipped scenes and a table are parallel to the axes and to each other.
TEST(RigidObstacle, BoxParallelToTheTriangleIsExact) {
  RandomTriangles random;
  const Hull box = {RigidObstacle::box({0.5, 0.5, 0.25}), boxCorners({0.5, 0.5, 0.25}), 0.0};
  for (int i = 0; i < 600; ++i) {
    Triangle triangle;
    for (Vector3d& corner : triangle) {
      corner = Vector3d(random.index(5) - 2, random.index(5) - 2, random.index(5) - 2) / 8.0;
    }
    SCOPED_TRACE(i);
    expectExact(box, triangle);
  }
}

TEST(RigidObstacle, TrianglesAtKnownPlacesHaveTheirDistance) {
  const Triangle triangle = {Vector3d(0, 0, 1), Vector3d(2, 0, 1), Vector3d(0, 2, 1)};
  RigidObstacle sphere = RigidObstacle::sphere(0.25);
  sphere.setPose(Eigen::Isometry3d(Eigen::Translation3d(0.5, 0.5, 0)));
  EXPECT_DOUBLE_EQ(sphere.closestPoint(triangle).distance, 0.75);
  EXPECT_TRUE(sphere.closestPoint(triangle).barycentric.isApprox(Vector3d(0.5, 0.25, 0.25)));

  RigidObstacle capsule = RigidObstacle::capsule(0.25, 1.0);  // upright, beside the corner 2
  capsule.setPose(Eigen::Isometry3d(Eigen::Translation3d(0, 3, 1)));
  EXPECT_DOUBLE_EQ(capsule.closestPoint(triangle).distance, 0.75);
  EXPECT_TRUE(capsule.closestPoint(triangle).barycentric.isApprox(Vector3d(0, 0, 1)));

  // Turned by 45 degrees about x, so that its highest edge lies at (y, z) = (0.25, 0.75 - 1)
  // sqrt(2).
  RigidObstacle box = RigidObstacle::box({2, 2, 1});
  Eigen::Isometry3d pose(Eigen::Translation3d(1, 0, -std::sqrt(2.0)));
  pose.rotate(Eigen::AngleAxisd(std::atan(1.0), Vector3d::UnitX()));
  box.setPose(pose);
  EXPECT_NEAR(box.closestPoint(triangle).distance, 1.0 + 0.25 * std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(box.closestPoint(triangle).on(triangle).y(), 0.25 * std::sqrt(2.0), 1e-15);
}

TEST(RigidObstacle, TouchingTriangleHasDistanceZero) {
  const Triangle above = {Vector3d(-1, -1, 0.1), Vector3d(1, -1, 0.1), Vector3d(0, 1, 0.1)};
  EXPECT_EQ(RigidObstacle::sphere(0.1).closestPoint(above).distance, 0.0);
  EXPECT_EQ(RigidObstacle::box({1, 1, 0.2}).closestPoint(above).distance, 0.0);
  EXPECT_EQ(RigidObstacle::capsule(0.05, 0.1).closestPoint(above).distance, 0.0);
  const RigidObstacle mesh =
      RigidObstacle::mesh({{0, 0, 0.1}, {0.3, 0, 2}, {0, 0.3, 2}}, {{0, 1, 2}});
  EXPECT_EQ(mesh.closestPoint(above).distance, 0.0);
}

TEST(RigidObstacle, TouchingIsZeroInAnyPose) {
  RandomTriangles random;
  const RigidObstacle mesh =
      RigidObstacle::mesh({{0, 0, 0.1}, {0.3, 0, 2}, {0, 0.3, 2}}, {{0, 1, 2}});
  for (RigidObstacle obstacle : {RigidObstacle::sphere(0.1), RigidObstacle::box({1, 1, 0.2}),
                                 RigidObstacle::capsule(0.05, 0.1), mesh}) {
    for (int i = 0; i < 300; ++i) {
      const Eigen::Isometry3d pose = random.pose(10.0);
      obstacle.setPose(pose);
      const Triangle touching = {pose * Vector3d(-1, -1, 0.1), pose * Vector3d(1, -1, 0.1),
                                 pose * Vector3d(0, 1, 0.1)};
      EXPECT_EQ(obstacle.closestPoint(touching).distance, 0.0) << i;
    }
  }
}

TEST(RigidObstacle, SolidsContainATriangleInsideOfThem) {
  const Triangle inside = {Vector3d(0.01, 0, 0), Vector3d(0, 0.01, 0), Vector3d(0, 0, 0.01)};
  EXPECT_EQ(RigidObstacle::sphere(0.1).closestPoint(inside).distance, 0.0);
  EXPECT_EQ(RigidObstacle::box({0.2, 0.2, 0.2}).closestPoint(inside).distance, 0.0);
  EXPECT_EQ(RigidObstacle::capsule(0.05, 0.1).closestPoint(inside).distance, 0.0);
}

TEST(RigidObstacle, AClosedMeshIsNotFilled) {
  const RigidObstacle tetrahedron = RigidObstacle::mesh(
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  const Vector3d place(0.2, 0.1, 0.3);
  EXPECT_DOUBLE_EQ(tetrahedron.closestPoint({place, place, place}).distance, 0.1);
}

TEST(RigidObstacle, FarAwayIsExactToRounding) {
  const Vector3d place(3000, 4000, 0);
  const TrianglePoint point = RigidObstacle::sphere(0.5).closestPoint({place, place, place});
  EXPECT_DOUBLE_EQ(point.distance, 4999.5);
}

// A wavy surface with some triangles without area.
struct Surface {
  std::vector<Vector3d> vertices;
  Triangles triangles;
};

Surface wavySurface(int cells) {
  Surface surface;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const double x = double(i) / cells, y = double(j) / cells;
      surface.vertices.emplace_back(x, y, 0.1 * std::sin(9 * x) * std::cos(7 * y));
    }
  }
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const int corner = j * (cells + 1) + i, above = corner + cells + 1;
      surface.triangles.push_back({corner, corner + 1, above + 1});
      surface.triangles.push_back({corner, above + 1, above});
    }
  }
  surface.triangles.push_back({0, 0, 0});
  surface.triangles.push_back({3, 4, 4});
  return surface;
}

TEST(RigidObstacle, MeshHasTheLeastDistanceOfAllItsTriangles) {
  const Surface surface = wavySurface(8);
  RigidObstacle mesh = RigidObstacle::mesh(surface.vertices, surface.triangles);
  RandomTriangles random;
  for (int i = 0; i < base::unlessSanitized(600, 150); ++i) {
    mesh.setPose(random.pose(0.5));
    const std::vector<Vector3d> vertices = transformed(mesh.pose(), surface.vertices);
    const Triangle triangle = random.triangle(i % RandomTriangles::kKinds);
    double least = std::numeric_limits<double>::infinity(), least_of_point = least;
    const TrianglePoint point = mesh.closestPoint(triangle);
    for (const auto& [a, b, c] : surface.triangles) {
      const std::vector<Vector3d> corners = {vertices[a], vertices[b], vertices[c]};
      least = std::min(least, exactDistance<long double>(corners, cornersOf(triangle)));
      least_of_point =
          std::min(least_of_point, exactDistance<long double>(corners, {point.on(triangle)}));
    }
    EXPECT_NEAR(point.distance, least, kRounding) << i;
    EXPECT_NEAR(least_of_point, least, kRounding) << i;
  }
}

// Outside the distance of a triangle that is a point; inside the way out, which ends on the
// surface.
TEST(RigidObstacle, DistanceOfAPlaceLeadsToTheSurfaceFromBothSides) {
  std::vector<RigidObstacle> obstacles = {
      RigidObstacle::sphere(0.3), RigidObstacle::capsule(0.2, 0.5),
      RigidObstacle::box({0.4, 0.7, 0.2}),
      RigidObstacle::mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5}}, {{0, 1, 2}})};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-0.6, 0.6);
  int inside = 0;
  for (RigidObstacle& obstacle : obstacles) {
    Eigen::Isometry3d pose(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
    pose.translation() = Eigen::Vector3d(0.1, -0.05, 0.02);
    obstacle.setPose(pose);
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector3d place(coordinate(random), coordinate(random), coordinate(random));
      const SurfaceDistance found = obstacle.distance(place);
      EXPECT_NEAR(found.normal.norm(), 1.0, 1e-14);
      const double from_triangle = obstacle.closestPoint({place, place, place}).distance;
      EXPECT_NEAR(std::max(0.0, found.distance), from_triangle, 1e-12);
      if (found.distance < 0.0) ++inside;
      const Eigen::Vector3d surface = place - found.distance * found.normal;
      EXPECT_NEAR(obstacle.distance(surface).distance, 0.0, 1e-14);
    }
    EXPECT_LE(obstacle.support(Eigen::Vector3d::UnitX()) - pose.translation().x(),
              obstacle.boundingRadius() + 1e-15);
  }
  EXPECT_GT(inside, 50);
}

TEST(RigidObstacle, SupportIsTheFarthestPointAlongADirection) {
  RandomTriangles random;
  const Surface surface = wavySurface(4);
  const Vector3d sides(0.1, 0.2, 0.4);
  RigidObstacle sphere = RigidObstacle::sphere(0.3), box = RigidObstacle::box(sides),
                capsule = RigidObstacle::capsule(0.1, 0.6),
                mesh = RigidObstacle::mesh(surface.vertices, surface.triangles);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Isometry3d pose = random.pose(1.0);
    const Eigen::Matrix3d& axes = pose.linear();
    const Vector3d d = 2.0 * random.vector();
    for (RigidObstacle* obstacle : {&sphere, &box, &capsule, &mesh}) obstacle->setPose(pose);
    const double centre = d.dot(pose.translation());
    EXPECT_NEAR(sphere.support(d), centre + 0.3 * d.norm(), 1e-14);
    EXPECT_NEAR(box.support(d), centre + 0.5 * sides.dot((axes.transpose() * d).cwiseAbs()), 1e-14);
    EXPECT_NEAR(capsule.support(d), centre + 0.3 * std::abs(d.dot(axes.col(2))) + 0.1 * d.norm(),
                1e-14);
    double farthest = -std::numeric_limits<double>::infinity();
    for (const Vector3d& vertex : surface.vertices)
      farthest = std::max(farthest, d.dot(pose * vertex));
    EXPECT_NEAR(mesh.support(d), farthest, 1e-14);
  }
}

TEST(RigidObstacle, VerticesInNoTriangleAreNoPartOfIt) {
  const RigidObstacle mesh =
      RigidObstacle::mesh({{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{1, 2, 3}});
  EXPECT_EQ(mesh.support(Vector3d::UnitX()), 1.0);
  const Vector3d place(9, 9, 9);
  EXPECT_NEAR(mesh.closestPoint({place, place, place}).distance,
              (place - Vector3d(0.5, 0.5, 0)).norm(), 1e-14);
}

TEST(RigidObstacle, CopiesHaveTheirOwnPose) {
  const RigidObstacle first = RigidObstacle::sphere(1.0);
  RigidObstacle second = first;
  second.setPose(Eigen::Isometry3d(Eigen::Translation3d(5, 0, 0)));
  EXPECT_EQ(first.support(Vector3d::UnitX()), 1.0);
  EXPECT_EQ(second.support(Vector3d::UnitX()), 6.0);
}

const double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(RigidObstacle, RefusesShapesNamingTheValue) {
  EXPECT_EQ(refusalOf([] { RigidObstacle::sphere(0.0); }),
            "the radius of a sphere is 0, must be > 0 and <= 1e9 m");
  EXPECT_EQ(refusalOf([] { RigidObstacle::sphere(kNan); }),
            "the radius of a sphere is nan, must be > 0 and <= 1e9 m");
  EXPECT_EQ(refusalOf([] {
              RigidObstacle::box({1, -1, 1});
            }),
            "side y of a box is -1, must be > 0 and <= 1e9 m");
  EXPECT_EQ(refusalOf([] {
              RigidObstacle::box({1, 1, 2e9});
            }),
            "side z of a box is 2e+09, must be > 0 and <= 1e9 m");
  EXPECT_EQ(refusalOf([] { RigidObstacle::capsule(-0.1, 1.0); }),
            "the radius of a capsule is -0.1, must be > 0 and <= 1e9 m");
  EXPECT_EQ(refusalOf([] { RigidObstacle::capsule(0.1, -1.0); }),
            "the length of a capsule is -1, must be >= 0 and <= 1e9 m");
  EXPECT_NO_THROW(RigidObstacle::capsule(0.1, 0.0));
}

TEST(RigidObstacle, RefusesMeshesNamingTheValue) {
  const std::vector<Vector3d> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(refusalOf([&] { RigidObstacle::mesh(corners, {}); }),
            "a mesh obstacle must have triangles");
  EXPECT_EQ(refusalOf([&] {
              RigidObstacle::mesh(corners, {{0, 1, 2}, {0, 1, 3}});
            }),
            "a vertex of triangle 1 is 3, must be from 0 to 2");
  EXPECT_EQ(refusalOf([&] {
              RigidObstacle::mesh(corners, {{-1, 1, 2}});
            }),
            "a vertex of triangle 0 is -1, must be from 0 to 2");
  EXPECT_EQ(refusalOf([&] {
              RigidObstacle::mesh({{0, 0, 0}, {1, kNan, 0}}, {{0, 1, 1}});
            }),
            "a coordinate of vertex 1 is nan, must be finite and at most 1e9 m");
}

TEST(RigidObstacle, RefusesPosesThatAreNotRigid) {
  RigidObstacle sphere = RigidObstacle::sphere(1.0);
  const auto refusal = [&](const Eigen::Matrix3d& linear, const Vector3d& place) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = linear;
    pose.translation() = place;
    return refusalOf([&] { sphere.setPose(pose); });
  };
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  EXPECT_EQ(refusal(identity, {0, kNan, 0}), "the pose of an obstacle is not finite");
  EXPECT_EQ(refusal(kNan * identity, {0, 0, 0}), "the pose of an obstacle is not finite");
  EXPECT_EQ(refusal(identity, {0, 2e9, 0}),
            "the place of an obstacle is 2e+09, must be at most 1e9 m away");
  EXPECT_EQ(refusal(2 * identity, {0, 0, 0}),
            "the scale or shear of a pose is 3, must be at most 1e-9");
  EXPECT_EQ(refusal(-identity, {0, 0, 0}),
            "the pose of an obstacle is a reflection, must be a rotation");
  EXPECT_TRUE(sphere.pose().isApprox(Eigen::Isometry3d::Identity(), 0.0));
}

}  // namespace
}  // namespace haptex::proximity::test_rigid_obstacle
