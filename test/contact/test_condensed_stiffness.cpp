#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "fixtures.h"

namespace haptex::contact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kStep = 1e-3;  // s

/// Two fingertips that pinch the middle of the small sample, settled, their stiffness known.
class CondensedStiffnessTest : public testing::Test {
 protected:
  CondensedStiffnessTest()
      : motion_(mesh_.rest_coordinates.size()),
        patch_(mesh_,
               cutAndRefine(mesh_, topology_, trianglesAround(mesh_, {0.02, 0.02}, 0.01),
                            nothingAttached(mesh_), 2),
               fabric_, {true, Vector3d::Zero()}, law_) {
    motion_.receive(mesh_.initial_positions, 0.02);
    patch_.start(motion_);
    tips_[0] = pressing(law_, kSmallSampleMiddle, 3e-4);
    tips_[1] = tips_[0];
    tips_[1].position.x() *= -1.0;
    for (int i = 0; i < 300; ++i) {
      patch_.advance(motion_, {&tips_[0], &tips_[1]}, kStep);
      stiffness_.update(patch_, kStep);
    }
  }

  /// The cloth's force on a fingertip one step later, if the fingertips have moved then.
  Vector3d forceAfter(int fingertip, const Vector3d& displacement_0,
                      const Vector3d& displacement_1) const {
    Patch patch = patch_;
    PerFingertip<Fingertip> moved = tips_;
    moved[0].position += displacement_0;
    moved[1].position += displacement_1;
    EXPECT_TRUE(patch.advance(motion_, {&moved[0], &moved[1]}, kStep));
    Vector3d force = Vector3d::Zero();
    for (const TouchedParticle& touched : patch.contact(fingertip).touched()) {
      force -= touched.force();
    }
    return force;
  }

  /// -d force / d position, of one fingertip alone, by central differences.
  Matrix3d differences(int fingertip) const {
    constexpr double kDisplacement = 1e-7;
    Matrix3d result;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d step = kDisplacement * Vector3d::Unit(axis);
      const auto at = [&](double sign) {
        return forceAfter(fingertip, fingertip == 0 ? Vector3d(sign * step) : Vector3d(0, 0, 0),
                          fingertip == 1 ? Vector3d(sign * step) : Vector3d(0, 0, 0));
      };
      result.col(axis) = (at(-1.0) - at(1.0)) / (2.0 * kDisplacement);
    }
    return result;
  }

  const mesh::ClothMesh mesh_ = smallSample();
  const MeshTopology topology_{mesh_};
  const material::Fabric fabric_ = wool();
  const ContactLaw law_{fabric_, {PulpSettings().stiffness, 1e-6}};  // no damping
  LargeScaleMotion motion_;
  Patch patch_;
  PerFingertip<Fingertip> tips_;
  CondensedStiffness stiffness_;
};

// What it leaves out: normals that turn (force over radius), and the change of the cloth's own
// stiffness within the step.
constexpr double kLeftOut = 0.05;

TEST_F(CondensedStiffnessTest, IsTheForceThatAMovementOfOneFingertipCausesWithinAStep) {
  for (int f = 0; f < kFingertips; ++f) {
    const Matrix3d exact = differences(f);
    ASSERT_GT(exact.norm(), 10.0);
    EXPECT_LT((stiffness_.of(f) - exact).norm(), kLeftOut * exact.norm()) << exact;
  }
}

TEST_F(CondensedStiffnessTest, IsSymmetricAndPositiveSemidefinite) {
  for (int f = 0; f < kFingertips; ++f) {
    const Matrix3d matrix = stiffness_.of(f);
    EXPECT_LT((matrix - matrix.transpose()).norm(), 1e-12 * matrix.norm());
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(matrix);
    EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-12 * matrix.norm());
  }
}

TEST_F(CondensedStiffnessTest, IsZeroAsSoonAsAFingertipTouchesNoMore) {
  patch_.advance(motion_, {&tips_[0], nullptr}, kStep);
  stiffness_.update(patch_, kStep);
  EXPECT_EQ(stiffness_.of(1), Matrix3d::Zero());
  EXPECT_GT(stiffness_.of(0).norm(), 1.0);
  stiffness_.clear();
  EXPECT_EQ(stiffness_.of(0), Matrix3d::Zero());
}

}  // namespace
}  // namespace haptex::contact
