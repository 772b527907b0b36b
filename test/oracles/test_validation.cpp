#include <gtest/gtest.h>

#include <set>

#include "haptex/base/workload.h"
#include "haptex/kes/equilibrium.h"
#include "haptex/kes/virtual_test.h"
#include "haptex/material/linear_fabric.h"
#include "haptex/oracles/checks/contact_oracles.h"
#include "haptex/oracles/checks/validation.h"
#include "haptex/oracles/experiments/cloth_swing.h"
#include "haptex/oracles/experiments/hanging_strip.h"

namespace haptex::oracles::test_validation {
namespace {

TEST(ClothSwing, IsBackAfterASecondAndOppositeAfterHalfOfIt) {
  constexpr double kAmplitude = 0.005;  // small, so that the period does not depend on it
  const ClothSwing swing(material::linearFabric(1000.0), 32, kAmplitude);
  cloth::StepSettings settings;
  settings.method = cloth::IntegrationMethod::kTrBdf2;
  settings.newton_iterations = 2;
  // 1 % for the mesh, which is a chain of 32 links, and for what the fabric stretches.
  EXPECT_NEAR(swing.start().positions[0].x(), kAmplitude, 1e-12);
  EXPECT_NEAR(swing.swing(settings, 0.5, 200).end.positions[0].x(), -kAmplitude, 0.01 * kAmplitude);
  EXPECT_NEAR(swing.swing(settings, 1.0, 400).end.positions[0].x(), kAmplitude, 0.01 * kAmplitude);
}

TEST(ClothSwing, HasNoEnergyWhereItHangs) {
  const ClothSwing hanging(material::linearFabric(1000.0), 16, 0.0),
      swinging(material::linearFabric(1000.0), 16, 0.05);
  EXPECT_EQ(hanging.energy(hanging.start()), 0.0);
  std::vector<Eigen::Vector3d> forces;
  hanging.cloth().computeForces(hanging.start(), forces);
  for (std::size_t row = 0; row < 16; ++row) {
    const Eigen::Vector3d sum = forces[3 * row] + forces[3 * row + 1] + forces[3 * row + 2];
    EXPECT_LT(sum.norm(), 1e-9) << row;  // of about 2e-3 N of weight; stretches near 1e-4
  }
  // Within a row the weights differ and the load does not, which leaves a little to come to rest.
  const cloth::ClothState rest = hanging.swing({}, 10.0, 200).end;
  EXPECT_NEAR(hanging.energy(rest), 0.0, 1e-5 * swinging.energy(swinging.start()));
}

TEST(ClothSwing, RefusesWhatItCannotBeMadeOf) {
  EXPECT_THROW(ClothSwing(material::linearFabric(1000.0), 0, 0.01), std::invalid_argument);
  EXPECT_THROW(ClothSwing(material::linearFabric(1000.0), 8, 0.11), std::invalid_argument);
  EXPECT_THROW(ClothSwing(material::linearFabric(1000.0), 8, std::nan("")), std::invalid_argument);
}

TEST(Equilibrium, IsStaticWhereViscosityCouldBalanceForAWhile) {
  const material::Fabric fabric = material::linearFabric(1000.0, 1000.0);
  cloth::ModelledEffects effects;
  effects.viscosity = true;
  effects.gravity = {0.0, 0.0, -9.81};
  cloth::Cloth cloth(mesh::makeRectangle(0.1, 0.1, 4, 4, mesh::Triangulation::kAlternating), fabric,
                     effects);
  cloth::ClothState state = cloth.initialState();
  for (int particle : sideParticles(cloth.mesh(), mesh::Side::kTop)) {
    cloth.attach(particle, {state.positions[particle], Eigen::Vector3d::Zero(), 0.0, 0.0});
  }
  kes::Equilibrium equilibrium(cloth);
  equilibrium.settle(cloth, state, 0.01);
  std::vector<Eigen::Vector3d> forces;
  cloth.computeForces(state, forces);
  double held = 0.0;
  for (int particle : sideParticles(cloth.mesh(), mesh::Side::kTop)) held -= forces[particle].z();
  const double weight = 0.1 * 0.01 * 9.81;
  EXPECT_NEAR(held, weight, 1e-8 * weight);
}

TEST(HangingStrip, ExactElongationIsThePublishedOne) {
  EXPECT_NEAR(exactElongation({0.5, 100.0, 0.1, 9.81}), 0.2440587e-2, 0.5e-9);
  EXPECT_NEAR(exactElongation({0.5, 10.0, 0.1, 9.81}), 2.342682e-2, 0.5e-8);
}

TEST(HangingStrip, ExactElongationIntegratesTheStretchOfEveryHeight) {
  const HangingStrip strip{0.7, 3.0, 0.2, 9.81};
  double sum = 0.0;
  constexpr int kParts = 20000;
  for (int i = 0; i < kParts; ++i) {
    const double below = strip.length * (i + 0.5) / kParts;
    const double right = 2.0 * strip.areal_density * strip.gravity * below / strip.modulus;
    double low = 1.0, high = 3.0;  // l^3 - l - right grows on this interval
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (middle * middle * middle - middle < right ? low : high) = middle;
    }
    sum += (low - 1.0) / kParts;
  }
  EXPECT_NEAR(exactElongation(strip), sum, 1e-9);  // the midpoint rule's own error
}

TEST(VirtualTest, IrregularMeshHasNoTwoTrianglesAlikeAndNoDefect) {
  const mesh::ClothMesh mesh = kes::irregularRectangle(0.2, 0.1, 50, 25, 2);
  EXPECT_EQ(mesh.triangles.size(), 2500u);
  EXPECT_TRUE(findDefects(mesh).none());
  std::set<double> perimeters;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector2d ab = mesh.rest_coordinates[t[1]] - mesh.rest_coordinates[t[0]];
    const Eigen::Vector2d ac = mesh.rest_coordinates[t[2]] - mesh.rest_coordinates[t[0]];
    perimeters.insert(ab.norm() + ac.norm() + (ac - ab).norm());
  }
  EXPECT_GE(perimeters.size(), 2500u - 3u);  // but for corner cells, with all corners on the rim
}

TEST(VirtualTest, IrregularMeshTurnsNoTriangleOver) {
  // In cells of 1 m; without a look at them every hundredth of these meshes has one.
  for (unsigned seed = 1; seed <= base::unlessSanitized(2000u, 100u); ++seed) {
    const mesh::ClothMesh mesh = kes::irregularRectangle(24.0, 12.0, 24, 12, seed);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto corners = mesh.restCorners(t);
      const Eigen::Vector2d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
      ASSERT_GE(ab.x() * ac.y() - ab.y() * ac.x(), 0.02) << seed;
    }
  }
}

TEST(HangingStrip, RefusesCellsThatAreNotAMultipleOfFive) {
  EXPECT_THROW(simulatedElongation({0.5, 100.0, 0.1, 9.81}, 7, 0.01), std::invalid_argument);
  EXPECT_THROW(simulatedElongation({0.5, 100.0, 0.1, 9.81}, 0, 0.01), std::invalid_argument);
}

void expectPass(const base::Quantity& quantity) {
  EXPECT_TRUE(quantity.pass()) << quantity.name << ": error " << quantity.error << " above "
                               << quantity.tolerance;
}

class RoomValidation : public testing::TestWithParam<Validation> {};

TEST_P(RoomValidation, EveryQuantityPasses) {
  int quantities = 0;
  GetParam().run(HAPTEX_CONFIG_DIRECTORY, [&](const base::Quantity& quantity) {
    ++quantities;
    expectPass(quantity);
    EXPECT_EQ(quantity.name.rfind(GetParam().room + "/", 0), 0u) << quantity.name;
  });
  EXPECT_GT(quantities, base::unlessSanitized(10, 2));
}

/// That of contact takes minutes; its obstacles are tested below.
std::vector<Validation> allButContact() {
  std::vector<Validation> rooms;
  for (const Validation& validation : validations()) {
    if (validation.room != "contact") rooms.push_back(validation);
  }
  return rooms;
}

INSTANTIATE_TEST_SUITE_P(Rooms, RoomValidation, testing::ValuesIn(allButContact()),
                         [](const auto& info) { return info.param.room; });

TEST(Validation, KnowsEveryRoomThatHasOracles) { EXPECT_EQ(validations().size(), 13u); }

TEST(Validation, EveryQuantityOfObstaclesPasses) {
  int quantities = 0;
  validateContactObstacles([&](const base::Quantity& quantity) {
    ++quantities;
    expectPass(quantity);
  });
  EXPECT_EQ(quantities, base::unlessSanitized(47, 41));
}

TEST(Validation, ExoskeletonNamesTheUrdfThatItCannotRead) {
  const std::string nowhere = HAPTEX_CONFIG_DIRECTORY "/fabrics";
  try {
    validateExoskeleton(nowhere, [](const base::Quantity&) {});
    FAIL() << "read";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(error.what(), nowhere + "/../urdf/hand_exoskeleton.urdf: cannot be read");
  }
}

}  // namespace
}  // namespace haptex::oracles::test_validation
