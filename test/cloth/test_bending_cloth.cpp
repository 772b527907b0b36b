// Bending as a part of the cloth that is stepped.
#include <gtest/gtest.h>

#include <cmath>

#include "fixtures.h"
#include "haptex/cloth/integrator.h"

namespace haptex::cloth {
namespace {

using Eigen::Vector3d;

constexpr double kRigidity = 1e-4;  // N.m

ModelledEffects bendingAnd(const Vector3d& gravity) {
  ModelledEffects effects;
  effects.gravity = gravity;
  effects.bending = true;
  return effects;
}

material::Fabric stiffFabric() {
  material::Fabric fabric = linearFabric();
  fabric.bending = {kRigidity, kRigidity};
  return fabric;
}

TEST(BendingCloth, ForceIsTheGradientOfTheEnergyAndTheJacobianThatOfTheForce) {
  const Cloth cloth(square(4), stiffFabric(), bendingAnd(Vector3d(0.0, 0.0, -9.8)));
  const ClothState state = randomState(cloth, 2e-3, 0.0);
  std::vector<Vector3d> forces, before, after;
  cloth.computeForces(state, forces);
  constexpr double kStep = 1e-6;  // m: errors of central differences near 1e-9 of the values
  for (int particle : {0, 6, 12}) {
    for (int axis = 0; axis < 3; ++axis) {
      ClothState moved = state;
      moved.positions[particle][axis] += kStep;
      const double above = cloth.potentialEnergy(moved);
      cloth.computeForces(moved, after);
      moved.positions[particle][axis] -= 2.0 * kStep;
      EXPECT_NEAR(-(above - cloth.potentialEnergy(moved)) / (2.0 * kStep), forces[particle][axis],
                  1e-5);
      cloth.computeForces(moved, before);
      for (int row : {5, 6, 7, 12}) {
        const Vector3d difference = (after[row] - before[row]) / (2.0 * kStep);
        Vector3d exact = Vector3d::Zero();
        for (const JacobianBlock& block : cloth.jacobian(state, {row})) {
          if (block.column == particle) exact = block.by_position.col(axis);
        }
        EXPECT_LT((difference - exact).norm(), 1e-4) << row << ' ' << particle << ' ' << axis;
      }
    }
  }
}

// A strip clamped along two rows of particles and bent by its weight: for small loads the tip of a
// beam of length L drops by w g L^4 / (8 B) (Euler and Bernoulli).
TEST(BendingCloth, AShortStripDropsAsABeamDoes) {
  constexpr int kCells = 20;
  constexpr double kCell = 0.005, kWidth = 0.02;
  ClothMesh mesh = makeRectangle(kCell * kCells, kWidth, kCells, 4, Triangulation::kAlternating);
  for (std::size_t i = 0; i < mesh.rest_coordinates.size(); ++i) {
    mesh.initial_positions[i] << mesh.rest_coordinates[i], 0.0;
  }
  material::Fabric fabric = stiffFabric();
  fabric.weft.elastic = fabric.warp.elastic = material::StrainStressCurve::linear(1e4);
  const Vector3d gravity(0.0, 0.0, -0.5);
  Cloth cloth(mesh, fabric, bendingAnd(gravity));
  ClothState state = cloth.initialState();
  for (std::size_t i = 0; i < mesh.rest_coordinates.size(); ++i) {
    if (mesh.rest_coordinates[i].x() > 1.5 * kCell) continue;
    AttachmentPath path;
    path.start = state.positions[i];
    cloth.attach(static_cast<int>(i), path);
  }
  StepSettings settings;
  settings.newton_iterations = 10;
  Integrator integrator(cloth, settings);
  for (int step = 0; step < 60; ++step) {
    ASSERT_TRUE(integrator.step(cloth, state, 1.0).accepted);
  }
  // The clamp ends half way between its two rows (docs/mechanics.md).
  const double length = kCell * kCells - 0.5 * kCell;
  const double exact = 0.1 * 0.5 * std::pow(length, 4) / (8.0 * kRigidity);
  ASSERT_LT(exact, 0.1 * length);  // small
  EXPECT_NEAR(-state.positions[kCells].z(), exact, 0.02 * exact);
}

TEST(BendingCloth, RefusesAFabricWithoutRigidity) {
  try {
    const Cloth cloth(square(2), linearFabric(), bendingAnd(Vector3d::Zero()));
    FAIL() << "not refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "bending is modelled and fabric 'linear' has no bending rigidity: add the key "
                 "bending");
  }
  Cloth cloth(square(2), stiffFabric(), bendingAnd(Vector3d::Zero()));
  EXPECT_THROW(cloth.setFabric(linearFabric()), std::invalid_argument);
  EXPECT_TRUE(cloth.fabric().bending);
}

TEST(BendingCloth, AnIntegratorOfAnotherPatternIsRefused) {
  const Cloth bending(square(4), stiffFabric(), bendingAnd(Vector3d::Zero()));
  const Cloth limp(square(4), stiffFabric(), ModelledEffects());
  Integrator integrator(limp, StepSettings());
  ClothState state = bending.initialState();
  EXPECT_THROW(integrator.step(bending, state, 0.01), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::cloth
