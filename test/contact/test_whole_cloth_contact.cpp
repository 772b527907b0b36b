#include <gtest/gtest.h>

#include "fixtures.h"

namespace haptex::contact::test_whole_cloth_contact {
namespace {

using base::Finger;
using Eigen::Matrix3d;
using Eigen::Vector3d;

class WholeClothContactTest : public testing::Test {
 protected:
  const mesh::ClothMesh mesh_ = smallSample();
  const std::vector<material::Fabric> fabrics_ = {wool()};
  const std::vector<ContactLaw> laws_ = {ContactLaw(fabrics_.front())};
  WholeClothContact contact_{mesh_, fabrics_, laws_};
  const Fingertip fingertip_ = pressing(laws_.front(), kSmallSampleMiddle, 2e-4);
};

TEST_F(WholeClothContactTest, TouchesTheParticlesOfTheStateWithTheForcesOfTheLaw) {
  contact_.receive(mesh_.initial_positions, atRest(mesh_), 1e-3);
  contact_.step({&fingertip_, nullptr});
  // 2e-4 m deep reaches 1.7 mm along the plane: the particle in the middle alone.
  ASSERT_EQ(contact_.contact(Finger::kIndex).touched().size(), 1u);
  const TouchedParticle& touched = contact_.contact(Finger::kIndex).touched().front();
  const double area = contact_.particles().areas[touched.particle];
  EXPECT_EQ(mesh_.rest_coordinates[touched.particle], Eigen::Vector2d(0.02, 0.02));
  EXPECT_NEAR(touched.normal_force, area * laws_.front().pressure(2e-4).stress, 1e-9);
  EXPECT_TRUE(contact_.contact(Finger::kThumb).touched().empty());
}

TEST_F(WholeClothContactTest, MovesParticlesOnByTheirVelocities) {
  std::vector<Vector3d> velocities = atRest(mesh_);
  for (Vector3d& velocity : velocities) velocity = {-0.1, 0.0, 0.0};
  contact_.receive(mesh_.initial_positions, velocities, 1e-3);
  contact_.step({&fingertip_, nullptr});
  ASSERT_EQ(contact_.contact(Finger::kIndex).touched().size(), 1u);
  EXPECT_NEAR(contact_.contact(Finger::kIndex).touched().front().depth, 1e-4, 1e-15);
}

TEST_F(WholeClothContactTest, ItsAreasSumToThatOfTheSample) {
  double sum = 0.0;
  for (double area : contact_.particles().areas) sum += area;
  EXPECT_NEAR(sum, 0.04 * 0.04, 1e-15);
}

TEST_F(WholeClothContactTest, EveryParticleIsTheNamedCornerOfItsTriangle) {
  for (int i = 0; i < static_cast<int>(mesh_.rest_coordinates.size()); ++i) {
    EXPECT_EQ(mesh_.triangles[contact_.triangleOf(i)][contact_.cornerOf(i)], i);
  }
}

/// Spring k in series with the inertia m / h^2 of its particle: k m / (h^2 k + m) along the normal.
TEST_F(WholeClothContactTest, StiffnessIsThatOfTheSpringsInSeriesWithTheInertia) {
  contact_.receive(mesh_.initial_positions, atRest(mesh_), 1e-3);
  contact_.step({&fingertip_, nullptr});
  const double area =
      contact_.particles().areas[contact_.contact(Finger::kIndex).touched().front().particle];
  const double mass = area * fabrics_.front().areal_density;
  const double k = area * laws_.front().pressure(2e-4).slope;
  for (double h : {1e-3, 1e-2}) {
    EXPECT_NEAR(contact_.stiffness(Finger::kIndex, h)(0, 0), k * mass / (h * h * k + mass),
                1e-9 * k);
  }
  EXPECT_EQ(contact_.stiffness(Finger::kThumb, 1e-3), Matrix3d::Zero());
}

TEST_F(WholeClothContactTest, ForgetsTheContactOfAnAbsentFingertip) {
  contact_.receive(mesh_.initial_positions, atRest(mesh_), 1e-3);
  contact_.step({&fingertip_, nullptr});
  contact_.step({nullptr, nullptr});
  EXPECT_TRUE(contact_.contact(Finger::kIndex).touched().empty());
}

}  // namespace
}  // namespace haptex::contact::test_whole_cloth_contact
