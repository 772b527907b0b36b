#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <memory>

#include "fixtures.h"

namespace haptex::contact::test_condensed_stiffness {
namespace {

using base::Finger;
using base::kFingers;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kStep = 1e-3;  // s

/// Two fingertips that pinch the middle of the small sample, settled, their stiffness known.
class CondensedStiffnessTest : public testing::Test {
 protected:
  CondensedStiffnessTest() : motion_(mesh_.rest_coordinates.size()) {
    motion_.receive(mesh_.initial_positions, 0.02);
    tips_[Finger::kIndex] = pressing(laws_.front(), kSmallSampleMiddle, 3e-4);
    tips_[Finger::kThumb] = tips_[Finger::kIndex];
    tips_[Finger::kThumb].position.x() *= -1.0;
    patch_ = settled(stiffness_);
  }

  /// The same in every run.
  std::unique_ptr<Patch> settled(CondensedStiffness& stiffness) const {
    auto patch = std::make_unique<Patch>(
        mesh_,
        cutAndRefine(mesh_, topology_, trianglesAround(mesh_, {0.02, 0.02}, 0.01),
                     nothingAttached(mesh_), 2),
        fabrics_, cloth::ModelledEffects{true, Vector3d::Zero()}, laws_);
    patch->start(motion_);
    for (int i = 0; i < 300; ++i) {
      patch->advance(motion_, {&tips_[Finger::kIndex], &tips_[Finger::kThumb]}, kStep);
      stiffness.update(*patch, kStep);
    }
    return patch;
  }

  /// The cloth's force on a fingertip one step later, if the fingertips have moved then.
  Vector3d forceAfter(Finger finger, const Vector3d& of_index, const Vector3d& of_thumb) const {
    CondensedStiffness unused;
    const std::unique_ptr<Patch> patch = settled(unused);
    base::PerFinger<Fingertip> moved = tips_;
    moved[Finger::kIndex].position += of_index;
    moved[Finger::kThumb].position += of_thumb;
    EXPECT_TRUE(patch->advance(motion_, {&moved[Finger::kIndex], &moved[Finger::kThumb]}, kStep));
    Vector3d force = Vector3d::Zero();
    for (const TouchedParticle& touched : patch->contact(finger).touched()) {
      force -= touched.force();
    }
    return force;
  }

  /// -d force / d position, of one fingertip alone, by central differences.
  Matrix3d differences(Finger finger) const {
    constexpr double kDisplacement = 1e-7;
    Matrix3d result;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d step = kDisplacement * Vector3d::Unit(axis);
      const auto at = [&](double sign) {
        return forceAfter(finger,
                          finger == Finger::kIndex ? Vector3d(sign * step) : Vector3d(0, 0, 0),
                          finger == Finger::kThumb ? Vector3d(sign * step) : Vector3d(0, 0, 0));
      };
      result.col(axis) = (at(-1.0) - at(1.0)) / (2.0 * kDisplacement);
    }
    return result;
  }

  const mesh::ClothMesh mesh_ = smallSample();
  const MeshTopology topology_{mesh_};
  const std::vector<material::Fabric> fabrics_ = {wool()};
  const std::vector<ContactLaw> laws_ = {
      ContactLaw(fabrics_.front(), {PulpSettings().stiffness, 1e-6})};  // no damping
  LargeScaleMotion motion_;
  std::unique_ptr<Patch> patch_;
  base::PerFinger<Fingertip> tips_;
  CondensedStiffness stiffness_;
};

// What it leaves out: normals that turn (force over radius), and the change of the cloth's own
// stiffness within the step.
constexpr double kLeftOut = 0.05;

TEST_F(CondensedStiffnessTest, IsTheForceThatAMovementOfOneFingertipCausesWithinAStep) {
  for (const Finger finger : kFingers) {
    const Matrix3d exact = differences(finger);
    ASSERT_GT(exact.norm(), 10.0);
    EXPECT_LT((stiffness_.of(finger) - exact).norm(), kLeftOut * exact.norm()) << exact;
  }
}

TEST_F(CondensedStiffnessTest, IsSymmetricAndPositiveSemidefinite) {
  for (const Finger finger : kFingers) {
    const Matrix3d matrix = stiffness_.of(finger);
    EXPECT_LT((matrix - matrix.transpose()).norm(), 1e-12 * matrix.norm());
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(matrix);
    EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-12 * matrix.norm());
  }
}

TEST_F(CondensedStiffnessTest, IsZeroAsSoonAsAFingertipTouchesNoMore) {
  patch_->advance(motion_, {&tips_[Finger::kIndex], nullptr}, kStep);
  stiffness_.update(*patch_, kStep);
  EXPECT_EQ(stiffness_.of(Finger::kThumb), Matrix3d::Zero());
  EXPECT_GT(stiffness_.of(Finger::kIndex).norm(), 1.0);
  stiffness_.clear();
  EXPECT_EQ(stiffness_.of(Finger::kIndex), Matrix3d::Zero());
}

}  // namespace
}  // namespace haptex::contact::test_condensed_stiffness
