// Bending as a part of the cloth that is stepped.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "derivatives.h"
#include "fixtures.h"
#include "force_fixtures.h"
#include "haptex/cloth/dynamics/integrator.h"

namespace haptex::cloth::test_bending_cloth {
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

// Curved both ways and twisted at random. The forces are of linear hinges and of curvatures.
TEST(BendingCloth, ARestCurvatureHasTheForceOfItsEnergyAndItsExactJacobian) {
  for (BendingModel model : {BendingModel::kLinear, BendingModel::kQuadratic}) {
    ModelledEffects effects = bendingAnd(Vector3d::Zero());
    effects.bending_settings = {model, {30.0, -12.0}};
    material::Fabric limp;  // bending alone
    limp.areal_density = 0.1;
    limp.bending = {2.0 * kRigidity, kRigidity};
    const Cloth cloth(square(4), limp, effects);
    const ClothState state = randomState(cloth, 4e-3, 0.0);
    expectExactDerivatives(cloth, state, {0, 7, 12});
  }
}

TEST(BendingCloth, ARestCurvatureTurnsWithTheSheet) {
  ModelledEffects effects = bendingAnd(Vector3d::Zero());
  effects.bending_settings.rest_curvature << 30.0, -12.0;
  const Cloth cloth(square(4), stiffFabric(), effects);
  const ClothState state = randomState(cloth, 2e-3, 0.0);
  ClothState turned = state;
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(2.0, Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  for (Vector3d& place : turned.positions) place = rotation * place + Vector3d(0.3, -1.0, 2.0);
  std::vector<Vector3d> forces, turned_forces;
  cloth.computeForces(state, forces);
  cloth.computeForces(turned, turned_forces);
  Vector3d sum = Vector3d::Zero(), moment = Vector3d::Zero();
  double scale = 0.0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    scale = std::max(scale, forces[i].norm());
    sum += forces[i];
    moment += state.positions[i].cross(forces[i]);
  }
  for (std::size_t i = 0; i < forces.size(); ++i) {
    EXPECT_LT((turned_forces[i] - rotation * forces[i]).norm(), 1e-10 * scale);
  }
  EXPECT_LT(sum.norm(), 1e-12 * scale);
  EXPECT_LT(moment.norm(), 1e-12 * scale);
  const double energy = cloth.potentialEnergy(state);
  EXPECT_NEAR(cloth.potentialEnergy(turned), energy, 1e-10 * energy);
}

// On a cylinder of the rest curvature hardly any energy is left, on its mirror image four times
// that of the flat sheet.
TEST(BendingCloth, ACylinderOfTheRestCurvatureIsAtRest) {
  constexpr double kCurvature = 5.0;  // 1/m: an angle of 0.06 per cell
  for (BendingModel model : {BendingModel::kLinear, BendingModel::kQuadratic}) {
    ModelledEffects effects = bendingAnd(Vector3d::Zero());
    effects.bending_settings = {model, {kCurvature, 0.0}};
    const Cloth cloth(square(8), stiffFabric(), effects);
    const auto energy_of = [&](double curvature) {
      ClothState state = cloth.initialState();
      for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
        const Eigen::Vector2d& rest = cloth.mesh().rest_coordinates[i];
        const double angle = curvature * rest.x();  // the normal, weft x warp, points to +x
        state.positions[i] = {(1.0 - std::cos(angle)) / curvature, std::sin(angle) / curvature,
                              rest.y()};
      }
      return cloth.forces().find<Bending>()->energy(state.ofForces());
    };
    const double flat = energy_of(1e-9);
    // Across a free edge nothing is resisted: half a cell along both has no energy.
    EXPECT_NEAR(flat, 0.5 * kRigidity * kCurvature * kCurvature * 0.1 * 0.1 * 7.0 / 8.0,
                1e-6 * flat);
    // Second order in that angle: a normal that is turned by half of it against the bending vector.
    EXPECT_LT(energy_of(kCurvature), 1e-3 * flat);
    EXPECT_NEAR(energy_of(-kCurvature), 4.0 * flat, 0.01 * flat);
  }
}

TEST(BendingCloth, ARestCurvatureThatIsNotGivenIsNotThere) {
  const Cloth flat(square(4), stiffFabric(), bendingAnd(Vector3d::Zero()));
  EXPECT_EQ(flat.forces().find<Bending>()->restCurvature(), nullptr);
  ModelledEffects effects = bendingAnd(Vector3d::Zero());
  effects.bending_settings.rest_curvature.x() = std::nan("");
  EXPECT_THROW(Cloth(square(4), stiffFabric(), effects), std::invalid_argument);
}

// A strip clamped along two rows of particles and bent by its weight: for small loads the tip of a
// beam of length L drops by w g L^4 / (8 B) (Euler and Bernoulli).
TEST(BendingCloth, AShortStripDropsAsABeamDoes) {
  constexpr int kCells = 20;
  constexpr double kCell = 0.005, kWidth = 0.02;
  mesh::ClothMesh mesh =
      mesh::makeRectangle(kCell * kCells, kWidth, kCells, 4, mesh::Triangulation::kAlternating);
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
}  // namespace haptex::cloth::test_bending_cloth
