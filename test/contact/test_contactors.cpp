#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "haptex/contact/contactors.h"

namespace haptex::contact::test_contactors {
namespace {

using tactile::ArrayPlacement;
using tactile::kContactorColumns;
using tactile::kContactorRows;
using tactile::kContactors;
using Forces = tactile::PerContactor<double>;

// In the array's frame (m): where a contactor stands.
Eigen::Vector3d contactorPosition(int row, int column) {
  return {(column - 2.5) * 2e-3, (row - 1.5) * 2e-3, 0.0};
}

// Somewhere in space, turned about no special axis.
Fingertip someFingertip() {
  Fingertip fingertip;
  fingertip.position = {0.1, -0.2, 0.3};
  fingertip.orientation = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -3).normalized());
  fingertip.radius = 0.008;
  return fingertip;
}

// On the pad, 8 mm below the centre; z out of the pad.
Eigen::Isometry3d someArray() {
  Eigen::Isometry3d array = Eigen::Isometry3d::Identity();
  array.rotate(Eigen::AngleAxisd(0.4, Eigen::Vector3d(2, 1, 1).normalized()));
  array.pretranslate(Eigen::Vector3d(0.002, 0.001, -0.008));
  return array;
}

// A contact point given in the array's frame.
ContactPoint pointAt(const Fingertip& fingertip, const Eigen::Vector3d& local, double force) {
  ContactPoint point;
  point.position = fingertip.position + fingertip.orientation * (someArray() * local);
  point.normal = Eigen::Vector3d::UnitZ();
  point.normal_force = force;
  point.tangential_force = Eigen::Vector3d(0.5, 0.0, 0.0);  // does not count
  return point;
}

Forces forcesOf(const Eigen::Vector3d& local, double force) {
  const Fingertip fingertip = someFingertip();
  FingertipContact contact;
  contact.points = {pointAt(fingertip, local, force)};
  return contactorForces(contact, fingertip, someArray());
}

double sum(const Forces& forces) { return std::accumulate(forces.begin(), forces.end(), 0.0); }

TEST(Contactors, CarryNothingWithoutContactPoints) {
  EXPECT_EQ(contactorForces({}, someFingertip(), someArray()), Forces{});
}

TEST(Contactors, CarryAllOfAPointOnThem) {
  for (int row = 0; row < kContactorRows; ++row) {
    for (int column = 0; column < kContactorColumns; ++column) {
      const Forces forces = forcesOf(contactorPosition(row, column), 0.7);
      for (int i = 0; i < kContactors; ++i) {
        EXPECT_NEAR(forces[i], i == 6 * row + column ? 0.7 : 0.0, 1e-12) << row << ' ' << column;
      }
    }
  }
}

TEST(Contactors, ShareAPointBetweenThemBilinearly) {
  // A quarter of a spacing from contactor (1, 2) along x, half of one along y; 3 mm above the
  // plane, which the projection takes away.
  const Forces forces =
      forcesOf(contactorPosition(1, 2) + Eigen::Vector3d(0.5e-3, 1e-3, 3e-3), 8.0);
  EXPECT_NEAR(forces[6 * 1 + 2], 3.0, 1e-11);
  EXPECT_NEAR(forces[6 * 1 + 3], 1.0, 1e-11);
  EXPECT_NEAR(forces[6 * 2 + 2], 3.0, 1e-11);
  EXPECT_NEAR(forces[6 * 2 + 3], 1.0, 1e-11);
  EXPECT_NEAR(sum(forces), 8.0, 1e-11);
}

TEST(Contactors, SumToTheNormalForceOfThePointsWithinTheArray) {
  const Fingertip fingertip = someFingertip();
  FingertipContact contact;
  double total = 0.0;
  for (double x = -4.9e-3; x <= 5e-3; x += 0.7e-3) {
    for (double y = -2.9e-3; y <= 3e-3; y += 0.6e-3) {
      const double force = 0.01 + x * x * 1e3 + y;
      contact.points.push_back(pointAt(fingertip, {x, y, -x}, force));
      total += force;
    }
  }
  EXPECT_NEAR(sum(contactorForces(contact, fingertip, someArray())), total, 1e-12 * total);
}

TEST(Contactors, FadeWithinOneSpacingBeyondTheOutermost) {
  const Eigen::Vector3d corner = contactorPosition(3, 5);
  EXPECT_NEAR(forcesOf(corner + Eigen::Vector3d(0.5e-3, 0, 0), 1.0)[23], 0.75, 1e-11);
  EXPECT_NEAR(forcesOf(corner + Eigen::Vector3d(0.5e-3, 1e-3, 0), 1.0)[23], 0.375, 1e-11);
  EXPECT_EQ(forcesOf(corner + Eigen::Vector3d(2.01e-3, 0, 0), 1.0), Forces{});
  EXPECT_EQ(forcesOf(corner + Eigen::Vector3d(0, 2.01e-3, 0), 1.0), Forces{});
  EXPECT_EQ(forcesOf({1e6, 1e6, 0}, 1.0), Forces{});
  const Eigen::Vector3d first = contactorPosition(0, 0);
  EXPECT_NEAR(forcesOf(first - Eigen::Vector3d(1e-3, 1e-3, 0), 1.0)[0], 0.25, 1e-11);
  EXPECT_EQ(forcesOf(first - Eigen::Vector3d(2.01e-3, 0, 0), 1.0), Forces{});
}

TEST(Contactors, NeverJumpWhileAPointMoves) {
  // Across the whole array and beyond: a step of s changes no weight by more than the sum of the
  // steps along x and y in spacings.
  const double step = 5e-6;
  const Eigen::Vector3d direction = Eigen::Vector3d(2.0, 1.1, 0.0).normalized();
  const double most = step * (direction.x() + direction.y()) / 2e-3 * (1.0 + 1e-6);
  Forces before = forcesOf(-9e-3 * direction, 1.0);
  double largest = 0.0;
  for (double way = -9e-3; way < 9e-3; way += step) {
    const Forces forces = forcesOf((way + step) * direction, 1.0);
    for (int i = 0; i < kContactors; ++i) {
      ASSERT_LE(std::abs(forces[i] - before[i]), most) << way;
      largest = std::max(largest, forces[i]);
    }
    before = forces;
  }
  EXPECT_GT(largest, 0.5);  // it did cross the array
}

TEST(Contactors, DoNotDependOnWhereTheFingertipIsAndHowItIsTurned) {
  const Fingertip fingertip = someFingertip();
  FingertipContact contact;
  for (int i = 0; i < 20; ++i) {
    contact.points.push_back(
        pointAt(fingertip, {5e-3 * std::sin(1.0 * i), 3e-3 * std::cos(2.0 * i), 0.0}, 0.1 + i));
  }
  const Forces expected = contactorForces(contact, fingertip, someArray());
  const Eigen::Isometry3d motion = Eigen::Translation3d(1.0, 2.0, -0.5) *
                                   Eigen::AngleAxisd(2.2, Eigen::Vector3d(1, -1, 4).normalized());
  Fingertip moved = fingertip;
  moved.position = motion * fingertip.position;
  moved.orientation = Eigen::Quaterniond(motion.rotation()) * fingertip.orientation;
  for (ContactPoint& point : contact.points) point.position = motion * point.position;
  const Forces forces = contactorForces(contact, moved, someArray());
  for (int i = 0; i < kContactors; ++i) EXPECT_NEAR(forces[i], expected[i], 1e-10);
}

TEST(Contactors, TurnWithTheFingertip) {
  // Half a turn about the array's z axis exchanges the contactor i with the one opposite, 23 - i.
  const Fingertip fingertip = someFingertip();
  FingertipContact contact;
  for (int i = 0; i < 20; ++i) {
    contact.points.push_back(
        pointAt(fingertip, {5e-3 * std::sin(1.0 * i), 3e-3 * std::cos(2.0 * i), 0.0}, 0.1 + i));
  }
  const Eigen::Isometry3d turned = someArray() * Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ());
  const Forces before = contactorForces(contact, fingertip, someArray());
  const Forces after = contactorForces(contact, fingertip, turned);
  for (int i = 0; i < kContactors; ++i) EXPECT_NEAR(after[i], before[23 - i], 1e-10) << i;
}

// A cloth that is stretched by 1.25 along weft, whose weft and warp are directions in space.
FingertipContact contactOn(const Eigen::Vector3d& weft, const Eigen::Vector3d& warp) {
  FingertipContact contact;
  contact.touching = true;
  contact.centre = {0.4, -0.1, 0.2};
  contact.fabric_position = {0.05, 0.12};
  contact.to_fabric << weft.transpose() / 1.25, warp.transpose();
  return contact;
}

TEST(ArrayOnFabric, MapsEveryContactorToTheClothBelowIt) {
  const Fingertip fingertip = someFingertip();
  const Eigen::Matrix3d turn = (fingertip.orientation * someArray().linear()).matrix();
  const FingertipContact contact = contactOn(turn.col(1), -turn.col(0));
  const ArrayPlacement placement = arrayOnFabric(contact, fingertip, someArray());
  for (int i = 0; i < kContactors; ++i) {
    const Eigen::Vector3d local(tactile::contactorPlace(i).x(), tactile::contactorPlace(i).y(), 0);
    const Eigen::Vector3d place =
        fingertip.position + fingertip.orientation * (someArray() * local);
    const Eigen::Vector2d expected =
        contact.fabric_position + Eigen::Vector2d(turn.col(1).dot(place - contact.centre) / 1.25,
                                                  -turn.col(0).dot(place - contact.centre));
    EXPECT_NEAR((placement.placeOf(i) - expected).norm(), 0.0, 1e-15) << i;
  }
}

TEST(ArrayOnFabric, IsMirroredOnTheOtherFaceOfTheCloth) {
  // The same cloth touched from its other side: turned by half a turn about x, y goes backwards.
  const Fingertip fingertip = someFingertip();
  const Eigen::Matrix3d turn = (fingertip.orientation * someArray().linear()).matrix();
  const FingertipContact contact = contactOn(turn.col(0), turn.col(1));
  const Eigen::Isometry3d other = someArray() * Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX());
  const ArrayPlacement one = arrayOnFabric(contact, fingertip, someArray());
  const ArrayPlacement two = arrayOnFabric(contact, fingertip, other);
  EXPECT_NEAR((two.axes.col(0) - one.axes.col(0)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((two.axes.col(1) + one.axes.col(1)).norm(), 0.0, 1e-14);
  EXPECT_GT(one.axes.determinant(), 0.0);
}

TEST(ArrayOnFabric, IsZeroWithoutContact) {
  const ArrayPlacement placement = arrayOnFabric({}, someFingertip(), someArray());
  EXPECT_TRUE(placement.origin.isZero(0.0));
  EXPECT_TRUE(placement.axes.isZero(0.0));
}

}  // namespace
}  // namespace haptex::contact::test_contactors
