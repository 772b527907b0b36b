#include <gtest/gtest.h>

#include <cmath>

#include "../fixtures.h"
#include "haptex/contact/carry/carried_rim.h"

namespace haptex::contact::test_carried_rim {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kMass = 2e-3;  // kg

class CarriedRimTest : public testing::Test {
 protected:
  static linear::SymmetricBlockMatrix matrixOf(const RefinedCut& cut) {
    const int size = static_cast<int>(cut.supports.size());
    const linear::SymmetricBlockMatrix pattern(size, cut.mesh.triangles);
    return {size, cut.mesh.triangles, CarriedRim::pairs(cut, pattern)};
  }

  /// One step of a rim on which nothing but the fingers acts.
  void step(const Vector3d& fingers_force, double h) {
    matrix_.setZero();
    rhs_.setZero();
    rim_.addTo(matrix_, rhs_, fingers_force, h);
    const int first = cut_.free_count;
    rim_.advance(matrix_.diagonal(first).llt().solve(rhs_.col(first)), h);
  }

  const mesh::ClothMesh mesh_ = smallSample();
  const MeshTopology topology_{mesh_};
  const RefinedCut cut_ =
      cutAndRefine(mesh_, topology_, trianglesAround(mesh_, Eigen::Vector2d(0.02, 0.02), 0.01),
                   nothingAttached(mesh_), 1);
  linear::SymmetricBlockMatrix matrix_ = matrixOf(cut_);
  linear::BlockVector rhs_ = linear::BlockVector::Zero(3, matrix_.size());
  CarriedRim rim_{cut_, matrix_, kMass};
};

TEST_F(CarriedRimTest, ActsAsAllOfItsParticlesThatMoveTogether) {
  const linear::BlockVector values = linear::BlockVector::Random(3, matrix_.size());
  for (int i = 0; i < matrix_.size(); ++i) {
    matrix_.diagonal(i) = Matrix3d(values.col(i).asDiagonal());
    rhs_.col(i) = values.col(matrix_.size() - 1 - i);
  }
  const linear::SymmetricBlockMatrix pattern(matrix_.size(), cut_.mesh.triangles);
  for (int i = 0; i < matrix_.size(); ++i) {
    for (int s = pattern.rowBegin(i); s < pattern.rowBegin(i + 1); ++s)
      matrix_.lower(matrix_.slot(i, pattern.column(s))).setRandom();
  }
  linear::BlockVector moved = values, product(3, matrix_.size());
  const Vector3d together(0.3, -0.2, 0.5);
  for (int i = cut_.free_count; i < matrix_.size(); ++i) moved.col(i) = together;
  matrix_.multiply(moved, product);
  const double energy = moved.cwiseProduct(product).sum();
  const double work = moved.cwiseProduct(rhs_).sum();

  const double h = 1e-12;  // so that what holds the rim is its mass
  rim_.addTo(matrix_, rhs_, Vector3d::Zero(), h);
  for (int i = cut_.free_count + 1; i < matrix_.size(); ++i) moved.col(i).setZero();
  matrix_.multiply(moved, product);
  EXPECT_NEAR(moved.cwiseProduct(product).sum(), energy + kMass * together.squaredNorm(), 1e-9);
  EXPECT_NEAR(moved.cwiseProduct(rhs_).sum(), work, 1e-9);
}

TEST_F(CarriedRimTest, ABalancedRimStaysOnTheLargeScaleCloth) {
  const Vector3d force(0.1, 0.0, -0.3);
  const double h = 1e-3;
  matrix_.setZero();
  rhs_.setZero();
  rhs_.col(matrix_.size() - 1) = h * force;  // of the patch
  rim_.addTo(matrix_, rhs_, force, h);
  EXPECT_NEAR(rhs_.col(cut_.free_count).norm(), 0.0, 1e-16);
}

// m (q'' + 2 r q' + r^2 q) = -G from rest: q = -G / (m r^2) (1 - (1 + r t) exp(-r t)).
TEST_F(CarriedRimTest, GoesAlongWithItsInertiaAndASpringThatIsCriticallyDamped) {
  const Vector3d force(0.0, 0.02, 0.0);
  rim_.follow(2.0 * CarriedRim::kSpeed, 1e-3);
  const double h = 1e-5, r = CarriedRim::kRate;
  for (int i = 0; i < 2000; ++i) step(force, h);
  const double t = 2000 * h;
  const double exact = -force.y() / (kMass * r * r) * (1.0 - (1.0 + r * t) * std::exp(-r * t));
  EXPECT_NEAR(rim_.offset().y(), exact, 2.0 * r * h * std::abs(exact));
}

TEST_F(CarriedRimTest, IsHeldWhileTheHandRests) {
  const Vector3d force(0.0, 0.2, 0.0);
  const double h = 1e-3;
  for (int i = 0; i < 100; ++i) step(force, h);
  EXPECT_LT(rim_.offset().norm(), 1e-5) << "before the hand has moved";
  rim_.follow(2.0 * CarriedRim::kSpeed, h);
  const auto rest = [&](double seconds) {
    for (double t = 0.0; t < seconds; t += h) {
      rim_.follow(0.5 * CarriedRim::kSpeed, h);
      step(force, h);
    }
  };
  rest(0.5 * CarriedRim::kRest);
  EXPECT_GT(rim_.offset().norm(), 1e-2);
  rest(CarriedRim::kRest + 0.2);
  EXPECT_LT(rim_.offset().norm(), 1e-5);
}

TEST_F(CarriedRimTest, GoesOnAsFastAsItWasWhenTheLargeScaleClothDoesNot) {
  const Vector3d before(0.1, 0.0, 0.0), after(0.0, 0.0, 0.02);
  rim_.start(before);
  rim_.setClothVelocity(after);
  EXPECT_EQ(rim_.velocity() + after, before);
  rim_.setClothVelocity(after);
  EXPECT_EQ(rim_.velocity() + after, before) << "the same state again";
}

TEST(CarriedRim, HasTheMassOfTheClothNearbyAndNoMoreThanThereIs) {
  const mesh::ClothMesh mesh = smallSample();
  const MeshTopology topology(mesh);
  const RefinedCut cut = cutAndRefine(mesh, topology, {40, 41, 42, 43}, nothingAttached(mesh), 1);
  const material::Fabric fabric = wool();
  const double cell = 0.5 * 25e-6;  // m^2, of a triangle
  EXPECT_NEAR(massAround(mesh, cut, {fabric}), fabric.areal_density * (128 - 4) * cell, 1e-12)
      << "all of the sample but the patch";
}

TEST(CarriedRim, StaysWhereSomethingOfThePatchIsAttached) {
  const mesh::ClothMesh mesh = smallSample();
  const MeshTopology topology(mesh);
  std::vector<char> attached = nothingAttached(mesh);
  const RefinedCut cut = cutAndRefine(mesh, topology, {40, 41, 42, 43}, attached, 1);
  EXPECT_TRUE(canBeCarried(cut, attached));
  attached[mesh.triangles[41][0]] = 1;
  EXPECT_FALSE(canBeCarried(cut, attached));
}

}  // namespace
}  // namespace haptex::contact::test_carried_rim
