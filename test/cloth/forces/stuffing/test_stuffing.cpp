// The pressure of what a closed cloth is stuffed with.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "../../../refusal.h"
#include "../linear/coupled_system.h"
#include "derivatives.h"
#include "fixtures.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/cloth/forces/stuffing/stuffing.h"

namespace haptex::cloth::test_stuffing {
namespace {

using Eigen::Vector3d;

/// A box of 1 x 1 x 1 tenths of a metre whose triangles are as they are in space.
mesh::ClothMesh box() {
  mesh::ClothMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.initial_positions.emplace_back(0.1 * (i & 1), 0.1 * ((i >> 1) & 1), 0.1 * (i >> 2));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  mesh::cutAsInSpace(mesh);
  return mesh;
}

ModelledEffects stuffed(double volume, double modulus = 300.0) {
  ModelledEffects effects;
  effects.stuffing = StuffingMass{volume, modulus};
  return effects;
}

ClothState crumpled(const Cloth& cloth, unsigned seed) {
  ClothState state = cloth.initialState();
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-0.02, 0.02);
  for (Vector3d& place : state.positions) {
    place += Vector3d(any(random), any(random), any(random)) + Vector3d(3.0, -5.0, 2.0);
  }
  return state;
}

TEST(StuffingPressure, FollowsVanWyksLawAndIsTheDerivativeOfItsEnergy) {
  const StuffingMass mass{0.01, 300.0};
  EXPECT_EQ(pressureOf(mass, 0.01).pressure, 0.0);
  EXPECT_EQ(pressureOf(mass, 0.02).energy, 0.0);
  EXPECT_DOUBLE_EQ(pressureOf(mass, 0.005).pressure, 300.0 * 7.0);
  for (const double share : {0.9, 0.3, 0.021, 0.019, -0.1}) {
    const double volume = share * mass.volume, step = 1e-8;
    const auto above = pressureOf(mass, volume + step), below = pressureOf(mass, volume - step);
    const auto at = pressureOf(mass, volume);
    EXPECT_NEAR(at.pressure, (below.energy - above.energy) / (2.0 * step), 1e-5 * at.pressure);
    EXPECT_NEAR(at.slope, (below.pressure - above.pressure) / (2.0 * step), 1e-3 * at.slope);
  }
}

TEST(Stuffing, PressesOnTheWallsOfABox) {
  const Cloth cloth(box(), linearFabric(), stuffed(0.002));
  const ClothState state = cloth.initialState();
  EXPECT_NEAR(enclosedVolume(cloth.mesh().triangles, state.positions), 1e-3, 1e-15);
  std::vector<Vector3d> forces;
  cloth.computeForces(state, forces);
  double on_top = 0.0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    if (state.positions[i].z() > 0.05) on_top += forces[i].z();
  }
  // Side walls add nothing along z.
  EXPECT_NEAR(on_top, 300.0 * 7.0 * 0.01, 1e-9);
}

TEST(Stuffing, ForcesSumUpToNothingAndTurnNothing) {
  const Cloth cloth(box(), linearFabric(), stuffed(0.002));
  const ClothState state = crumpled(cloth, 3);
  std::vector<Vector3d> forces(cloth.particleCount(), Vector3d::Zero());
  Stuffing(box(), {0.002, 300.0}).addForces(state.ofForces(), forces);
  Vector3d sum = Vector3d::Zero(), moment = Vector3d::Zero();
  double scale = 0.0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    sum += forces[i];
    moment += state.positions[i].cross(forces[i]);
    scale += forces[i].norm();
  }
  ASSERT_GT(scale, 1.0);
  EXPECT_LT(sum.norm(), 1e-12 * scale);
  EXPECT_LT(moment.norm(), 1e-11 * scale);
}

TEST(Stuffing, HasExactDerivatives) {
  const Cloth cloth(box(), linearFabric(), stuffed(0.002));
  for (unsigned seed = 1; seed <= 3; ++seed) {
    expectExactDerivatives(cloth, crumpled(cloth, seed), {0, 1, 2, 3, 4, 5, 6, 7});
  }
}

/// Dense form of what it adds to a Newton iteration, over a^2.
Eigen::MatrixXd hessianOf(const Cloth& cloth, const ClothState& state, Hessian hessian) {
  Stuffing stuffing(box(), {0.002, 300.0});
  linear::SymmetricBlockMatrix matrix = cloth.pattern();
  matrix.setZero();
  stuffing.bind(matrix);
  const int size = matrix.size();
  linear::BlockVector rhs = linear::BlockVector::Zero(3, size);
  stuffing.assembleNewton(state.ofForces(), nullptr, 1.0, hessian, matrix, rhs);
  return linear::denseWithCouplings(matrix);
}

TEST(Stuffing, AssemblesTheJacobianForNewtonAndAPositiveSemidefinitePartOfIt) {
  const Cloth cloth(box(), linearFabric(), stuffed(0.002));
  const ClothState state = crumpled(cloth, 5);
  std::vector<int> all(cloth.particleCount());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  JacobianRows rows(all);
  Stuffing(box(), {0.002, 300.0}).addJacobian(state.ofForces(), rows);
  const int size = static_cast<int>(all.size());
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(3 * size, 3 * size);
  for (const JacobianBlock& block : rows.blocks()) {
    jacobian.block<3, 3>(3 * block.row, 3 * block.column) = block.by_position;
  }
  const Eigen::MatrixXd exact = hessianOf(cloth, state, Hessian::kExact);
  EXPECT_LT((exact + jacobian).norm(), 1e-12 * jacobian.norm());
  const Eigen::MatrixXd projected = hessianOf(cloth, state, Hessian::kProjected);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(projected);
  EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-12 * eigen.eigenvalues().maxCoeff());
  EXPECT_GT(eigen.eigenvalues().maxCoeff(), 0.0);
}

TEST(Stuffing, RefusesWhatIsNotOneClosedCloth) {
  const auto refusal = [](const mesh::ClothMesh& mesh, const StuffingMass& mass) -> std::string {
    return test::refusalOf([&] { Stuffing(mesh, mass); });
  };
  const auto expect = [](const std::string& message, const char* part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  expect(refusal(box(), {NAN, 300.0}), "volume");
  expect(refusal(box(), {0.002, 0.0}), "modulus");
  mesh::ClothMesh open = box();
  open.triangles.pop_back();
  expect(refusal(open, {0.002, 300.0}), "has one triangle");
  mesh::ClothMesh turned = box();
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  expect(refusal(turned, {0.002, 300.0}), "run through the same way by two triangles");
  mesh::ClothMesh inside_out = box();
  for (auto& triangle : inside_out.triangles) std::swap(triangle[0], triangle[1]);
  expect(refusal(inside_out, {0.002, 300.0}), "counter-clockwise");
  expect(refusal(box(), {0.02, 300.0}), "encloses 0.001 m^3 at the start");
  mesh::ClothMesh two = box();
  for (const auto& [a, b, c] : box().triangles) two.triangles.push_back({a + 8, b + 8, c + 8});
  for (const Vector3d& place : box().initial_positions) {
    two.initial_positions.push_back(place + Vector3d(1.0, 0.0, 0.0));
  }
  expect(refusal(two, {0.002, 300.0}), "of another one");
}

TEST(Stuffing, NeedsCollisionWithObstaclesByItself) {
  ModelledEffects effects = stuffed(0.002);
  effects.contacts = true;
  EXPECT_THROW(Cloth(box(), linearFabric(), effects), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::cloth::test_stuffing
