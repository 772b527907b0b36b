// Transverse contraction: weft and warp coupled in the membrane.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "fixtures.h"
#include "force_fixtures.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/material/contraction.h"

namespace haptex::cloth::test_contraction {
namespace {

using Eigen::Vector3d;

ModelledEffects contracting(bool viscosity = false) {
  ModelledEffects effects;
  effects.contraction = true;
  effects.viscosity = viscosity;
  return effects;
}

material::Fabric contractingFabric(double contraction = 0.4) {
  material::Fabric fabric = stiffeningFabric();
  fabric.contraction = contraction;
  return fabric;
}

/// A fabric that gives way beyond a strain of 0.1, so that the material part has to be projected.
material::Fabric yieldingFabric() {
  material::Fabric fabric = contractingFabric(0.9);
  fabric.weft.elastic = material::StrainStressCurve::fit({{0.005, 5.0}, {0.03, 6.0}, {0.1, 7.0}},
                                                         material::NegativeBranch::kLinear);
  fabric.warp.elastic = fabric.weft.elastic;
  return fabric;
}

TEST(Contraction, ForceIsTheGradientOfTheEnergyAndTheJacobianThatOfTheForce) {
  const Cloth cloth(square(2), contractingFabric(), contracting(true));
  ClothState state = randomState(cloth, 2e-3, 0.1);
  std::vector<Vector3d> forces, above, below;
  Cloth elastic(square(2), contractingFabric(), contracting());
  elastic.computeForces(state, forces);
  std::vector<int> particles;
  for (int i = 0; i < static_cast<int>(cloth.particleCount()); ++i) particles.push_back(i);
  const std::vector<JacobianBlock> blocks = cloth.jacobian(state, particles);
  double largest = 0.0;
  for (const JacobianBlock& block : blocks) {
    largest = std::max(largest, block.by_position.cwiseAbs().maxCoeff());
  }
  constexpr double kStep = 1e-8;  // m: the curves bend within 1e-4 m
  for (int column : particles) {
    for (int axis = 0; axis < 3; ++axis) {
      double& coordinate = state.positions[column][axis];
      const double middle = coordinate;
      coordinate = middle + kStep;
      const double energy_above = elastic.potentialEnergy(state);
      cloth.computeForces(state, above);
      coordinate = middle - kStep;
      const double energy_below = elastic.potentialEnergy(state);
      cloth.computeForces(state, below);
      coordinate = middle;
      EXPECT_NEAR(-(energy_above - energy_below) / (2.0 * kStep), forces[column][axis], 1e-6);
      for (const JacobianBlock& block : blocks) {
        if (block.column != column) continue;
        const Vector3d difference = (above[block.row] - below[block.row]) / (2.0 * kStep);
        EXPECT_LT((difference - block.by_position.col(axis)).norm(), 1e-6 * largest);
      }
    }
  }
}

TEST(Contraction, CurvesStayAsMeasuredWhereTheTransverseStretchIsHeld) {
  const material::Fabric fabric = contractingFabric();
  const Cloth with(square(4), fabric, contracting()), without(square(4), fabric, {});
  for (double stretch : {0.9, 1.0, 1.1}) {
    for (int axis : {1, 2}) {  // weft lies along y, warp along z
      ClothState state = with.initialState();
      for (Vector3d& position : state.positions) position[axis] *= stretch;
      std::vector<Vector3d> coupled, uncoupled;
      with.computeForces(state, coupled);
      without.computeForces(state, uncoupled);
      for (std::size_t i = 0; i < coupled.size(); ++i) {
        EXPECT_NEAR(coupled[i][axis], uncoupled[i][axis], 1e-14);  // of up to 2 N
      }
    }
  }
}

/// matrix and rhs of a linearised stage by the membrane of a cloth.
struct System {
  System(const Cloth& cloth, const ClothState& state, const StageTimes& times)
      : matrix(cloth.pattern()), rhs(linear::BlockVector::Zero(3, cloth.particleCount())) {
    matrix.setZero();
    membraneOf(cloth).assembleLinearised(state.ofForces(), times, matrix, rhs);
  }
  linear::SymmetricBlockMatrix matrix;
  linear::BlockVector rhs;
};

TEST(Contraction, BatchesAddWhatTrianglesAloneAdd) {
  for (const material::Fabric& fabric : {contractingFabric(), yieldingFabric()}) {
    for (bool viscosity : {false, true}) {
      const Cloth cloth(square(4), fabric, contracting(viscosity));  // 32 triangles, batches of 4
      for (unsigned seed = 1; seed <= 4; ++seed) {
        const ClothState state = randomState(cloth, 2e-3 * seed, 1.0, seed);
        const StageTimes times{0.002, 0.003};
        const System batched(cloth, state, times);
        linear::SymmetricBlockMatrix matrix = cloth.pattern();
        matrix.setZero();
        linear::BlockVector rhs = linear::BlockVector::Zero(3, cloth.particleCount());
        for (const std::array<int, 3>& triangle : cloth.mesh().triangles) {
          mesh::ClothMesh one = cloth.mesh();
          one.triangles = {triangle};
          Membrane membrane(restElements(one), fabric, viscosity, true);
          membrane.bind(matrix);
          membrane.assembleLinearised(state.ofForces(), times, matrix, rhs);
        }
        EXPECT_LT((dense(batched.matrix) - dense(matrix)).norm(), 1e-13 * dense(matrix).norm());
        EXPECT_LT((batched.rhs - rhs).norm(), 1e-13 * rhs.norm());
      }
    }
  }
}

TEST(Contraction, TheStepsMatrixIsSemidefiniteWhateverTheTangentIs) {
  int indefinite = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Cloth cloth(square(2), yieldingFabric(), contracting());
    const ClothState state = randomState(cloth, 4e-3, 0.0, seed);
    const auto least = [](const Eigen::MatrixXd& matrix) {
      const Eigen::VectorXd values =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues();
      return values.minCoeff() / values.maxCoeff();
    };
    EXPECT_GT(least(dense(System(cloth, state, {0.01, 0.0}).matrix)), -1e-13);
    linear::SymmetricBlockMatrix exact = cloth.pattern();
    exact.setZero();
    linear::BlockVector rhs = linear::BlockVector::Zero(3, cloth.particleCount());
    const auto strains = heldSince(membraneOf(cloth), state.positions);
    membraneOf(cloth).assembleNewton(state.ofForces(), strains.data(), 0.01, Hessian::kExact, exact,
                                     rhs);
    indefinite += least(dense(exact)) < -1e-3;
    exact.setZero();
    membraneOf(cloth).assembleNewton(state.ofForces(), strains.data(), 0.01, Hessian::kProjected,
                                     exact, rhs);
    EXPECT_GT(least(dense(exact)), -1e-13);
  }
  EXPECT_GT(indefinite, 5);
}

TEST(Contraction, OfALinearFabricIsItsPoissonRatio) {
  material::Fabric fabric = linearFabric();
  fabric.contraction = 0.3;
  EXPECT_DOUBLE_EQ(material::contractionModulus(fabric), 30.0);
  EXPECT_DOUBLE_EQ(material::largestContraction(fabric), 1.0);
  fabric.contraction.reset();
  EXPECT_EQ(material::contractionModulus(fabric), 0.0);
  fabric.weft.elastic = material::StrainStressCurve::fit({{0.1, 10.0}, {0.2, 5.0}, {0.3, 20.0}},
                                                         material::NegativeBranch::kLinear);
  EXPECT_EQ(material::largestContraction(fabric), 0.0);
}

TEST(Contraction, EnergyOfASwingInItIsKept) {
  ModelledEffects effects = contracting();
  effects.gravity = {0.0, 0.0, -9.81};
  Cloth cloth(square(4), contractingFabric(), effects);
  for (int particle : mesh::sideParticles(cloth.mesh(), mesh::Side::kTop)) {
    AttachmentPath path;
    path.start = cloth.mesh().initial_positions[particle];
    cloth.attach(particle, path);
  }
  ClothState state = cloth.initialState();
  StepSettings settings;
  settings.method = IntegrationMethod::kTrBdf2;
  settings.newton_iterations = 20;
  Integrator integrator(cloth, settings);
  const double begin = cloth.potentialEnergy(state);
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(integrator.step(cloth, state, 2e-4).accepted);
    // It bounces on its threads by 1e-5 J.
    EXPECT_NEAR(cloth.potentialEnergy(state) + cloth.kineticEnergy(state), begin, 1e-7);
  }
}

TEST(Contraction, IsRefusedWhereTheFabricHasNone) {
  try {
    const Cloth refused(square(2), linearFabric(), contracting());
    FAIL() << "not refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "contraction is modelled and fabric 'linear' has none: add the key contraction");
  }
  Cloth cloth(square(2), contractingFabric(), contracting());
  EXPECT_THROW(cloth.setFabric(linearFabric()), std::invalid_argument);
  EXPECT_TRUE(cloth.fabric().contraction);
}

}  // namespace
}  // namespace haptex::cloth::test_contraction
