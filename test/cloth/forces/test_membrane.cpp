#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <functional>
#include <limits>
#include <numeric>

#include "fixtures.h"
#include "force_fixtures.h"
#include "haptex/cloth/forces/membrane.h"
#include "membrane_fixtures.h"

namespace haptex::cloth::test_membrane {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

ModelledEffects viscous() {
  ModelledEffects effects;
  effects.viscosity = true;
  return effects;
}

std::vector<Vector3d> membraneForces(const Cloth& cloth, const ClothState& state) {
  std::vector<Vector3d> forces(cloth.particleCount(), Vector3d::Zero());
  membraneOf(cloth).addForces(state.ofForces(), forces);
  return forces;
}

TEST(Membrane, RestHasNoForceAndNoEnergy) {
  const Cloth cloth(square(5), stiffeningFabric(), viscous());
  const ClothState state = cloth.initialState();
  for (const Vector3d& force : membraneForces(cloth, state)) EXPECT_LT(force.norm(), 1e-13);
  EXPECT_LT(membraneOf(cloth).energy(state.ofForces()), 1e-25);
}

TEST(Membrane, RigidMotionHasNoForce) {
  const Cloth cloth(square(5), stiffeningFabric(), viscous());
  ClothState state = cloth.initialState();
  const Matrix3d rotation =
      Eigen::AngleAxisd(2.0, Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  const Vector3d spin(3.0, -1.0, 2.0);
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    state.positions[i] = rotation * state.positions[i] + Vector3d(1.0, 2.0, -3.0);
    state.velocities[i] = spin.cross(state.positions[i]) + Vector3d(5.0, 0.0, 1.0);
  }
  // Coordinates of a few metres are rounded to 4e-16 m, cells are 0.02 m: strain to 1e-13.
  for (const Vector3d& force : membraneForces(cloth, state)) EXPECT_LT(force.norm(), 1e-11);
}

TEST(Membrane, ElasticForceIsTheNegativeGradientOfTheEnergy) {
  const Cloth cloth(square(3), stiffeningFabric(), {});
  ClothState state = randomState(cloth, 0.003, 0.0);
  const std::vector<Vector3d> forces = membraneForces(cloth, state);
  const double step = 1e-7;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double middle = state.positions[i][axis];
      state.positions[i][axis] = middle + step;
      const double above = membraneOf(cloth).energy(state.ofForces());
      state.positions[i][axis] = middle - step;
      const double below = membraneOf(cloth).energy(state.ofForces());
      state.positions[i][axis] = middle;
      EXPECT_NEAR(forces[i][axis], -(above - below) / (2.0 * step), 1e-7);  // forces near 1 N
    }
  }
}

TEST(Membrane, ForcesAndTheirMomentsSumToZero) {
  const Cloth cloth(square(6), stiffeningFabric(), viscous());
  const ClothState state = randomState(cloth, 0.003, 1.0);
  const std::vector<Vector3d> forces = membraneForces(cloth, state);
  Vector3d sum = Vector3d::Zero(), moment = Vector3d::Zero();
  double largest = 0.0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    sum += forces[i];
    moment += state.positions[i].cross(forces[i]);
    largest = std::max(largest, forces[i].norm());
  }
  EXPECT_GT(largest, 0.01);
  EXPECT_LT(sum.norm(), 1e-13 * largest);
  EXPECT_LT(moment.norm(), 1e-14 * largest);
}

TEST(Membrane, ViscosityOnlyTakesEnergyOut) {
  const Cloth with(square(5), stiffeningFabric(), viscous());
  const Cloth without(square(5), stiffeningFabric(), {});
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const ClothState state = randomState(with, 0.003, 2.0, seed);
    const std::vector<Vector3d> all = membraneForces(with, state);
    const std::vector<Vector3d> elastic = membraneForces(without, state);
    double power = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      power += (all[i] - elastic[i]).dot(state.velocities[i]);
    }
    EXPECT_LT(power, -1e-3);
  }
}

TEST(Membrane, ForceFollowsTheCurveUnderUniaxialStretchInEveryDirection) {
  // One cell of 0.1 m stretched by 8 %: half the force on each of the two particles of an end.
  const material::Fabric fabric = stiffeningFabric();
  const Cloth cloth(square(1), fabric, {});
  const double stretch = 1.08, strain = 0.5 * (stretch * stretch - 1.0);
  for (int axis : {1, 2}) {  // weft along y, warp along z
    ClothState state = cloth.initialState();
    for (Vector3d& position : state.positions) position[axis] *= stretch;
    const auto& curve = axis == 1 ? fabric.weft.elastic : fabric.warp.elastic;
    const double exact = 0.1 * stretch * curve.evaluate(strain).stress;
    const std::vector<Vector3d> forces = membraneForces(cloth, state);
    double pull = 0.0;
    for (const Vector3d& force : forces) pull += 0.5 * std::abs(force[axis]);
    EXPECT_NEAR(pull, exact, 1e-12 * exact);
  }
}

TEST(ProjectStress, IsTheNearestPositiveSemidefiniteTensor) {
  for (int k = 0; k < 1000; ++k) {
    const Vector3d stress = 100.0 * Vector3d::Random();
    Eigen::Matrix2d tensor;
    tensor << stress[0], stress[2], stress[2], stress[1];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(tensor);
    const Eigen::Matrix2d exact = eigen.eigenvectors() *
                                  eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
                                  eigen.eigenvectors().transpose();
    const Vector3d projected = projectStress(stress);
    EXPECT_NEAR(projected[0], exact(0, 0), 1e-12);
    EXPECT_NEAR(projected[1], exact(1, 1), 1e-12);
    EXPECT_NEAR(projected[2], exact(0, 1), 1e-12);
  }
  EXPECT_TRUE(projectStress(Vector3d::Zero()).isZero());
  EXPECT_TRUE(projectStress({-1.0, -2.0, 0.5}).isZero());
  EXPECT_EQ(projectStress({3.0, 2.0, 0.5}), Vector3d(3.0, 2.0, 0.5));
}

TEST(Membrane, StepMatrixIsPositiveSemidefiniteForEveryState) {
  const Cloth cloth(square(3), stiffeningFabric(), viscous());
  for (unsigned seed = 1; seed <= 30; ++seed) {
    // Up to crumpled beyond recognition: displacements of three cells, and in compression.
    ClothState state = randomState(cloth, seed % 3 == 0 ? 0.1 : 0.01, 10.0, seed);
    if (seed % 5 == 0) {
      for (Vector3d& position : state.positions) position *= 0.3;
    }
    MembraneSystem system(cloth);
    membraneOf(cloth).assembleLinearised(state.ofForces(), {0.0125, 0.0125}, system.matrix,
                                         system.rhs);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(dense(system.matrix));
    EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-13 * eigen.eigenvalues().maxCoeff());
  }
}

TEST(Membrane, StepMatrixIsTheExactJacobianWhereNothingNeedsProjection) {
  // Stretched in both directions without shear: stress and slopes are positive. Without velocity
  // the viscous part of dF/dP vanishes.
  const Cloth cloth(square(3), stiffeningFabric(), viscous());
  ClothState state = randomState(cloth, 1e-4, 0.0);
  for (Vector3d& position : state.positions) position *= 1.06;
  const double h = 0.01;
  MembraneSystem system(cloth);
  membraneOf(cloth).assembleLinearised(state.ofForces(), {h, h}, system.matrix, system.rhs);
  const Eigen::MatrixXd assembled = dense(system.matrix);
  std::vector<int> particles(cloth.particleCount());
  for (std::size_t i = 0; i < particles.size(); ++i) particles[i] = static_cast<int>(i);
  for (const JacobianBlock& block : cloth.jacobian(state, particles)) {
    const Matrix3d exact = -h * h * block.by_position - h * block.by_velocity;
    EXPECT_LT((assembled.block<3, 3>(3 * block.row, 3 * block.column) - exact).norm(),
              1e-12 * assembled.norm());
  }
}

class StepRightHandSide : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Viscosity, StepRightHandSide, testing::Bool());

TEST_P(StepRightHandSide, IsForceAndElasticStiffnessTimesVelocity) {
  ModelledEffects effects;
  effects.viscosity = GetParam();
  const Cloth cloth(square(3), stiffeningFabric(), effects);
  ClothState state = randomState(cloth, 1e-4, 1.0);
  for (Vector3d& position : state.positions) position *= 1.06;
  const double h = 0.01;
  MembraneSystem system(cloth);
  membraneOf(cloth).assembleLinearised(state.ofForces(), {h, h}, system.matrix, system.rhs);
  linear::BlockVector velocity(3, cloth.particleCount()),
      stiffness_times_velocity(3, cloth.particleCount());
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) velocity.col(i) = state.velocities[i];
  system.matrix.multiply(velocity, stiffness_times_velocity);  // -h D v - h^2 K v
  std::vector<int> particles(cloth.particleCount());
  std::iota(particles.begin(), particles.end(), 0);
  for (const JacobianBlock& block : cloth.jacobian(state, particles)) {
    stiffness_times_velocity.col(block.row) += h * block.by_velocity * velocity.col(block.column);
  }
  const std::vector<Vector3d> forces = membraneForces(cloth, state);
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    const Vector3d exact = h * forces[i] - stiffness_times_velocity.col(i);
    EXPECT_LT((system.rhs.col(i) - exact).norm(), 1e-12 * system.rhs.norm());
  }
}

TEST(Membrane, TheWayAheadAddsTheMatrixTimesTheVelocities) {
  // Without viscosity the matrix is -a^2 K, and rhs grows by a ahead K v.
  const Cloth cloth(square(3), stiffeningFabric(), {});
  const ClothState state = randomState(cloth, 0.003, 3.0);
  const double a = 0.002, ahead = 0.003;
  MembraneSystem there(cloth), ahead_of(cloth);
  membraneOf(cloth).assembleLinearised(state.ofForces(), {a, 0.0}, there.matrix, there.rhs);
  membraneOf(cloth).assembleLinearised(state.ofForces(), {a, ahead}, ahead_of.matrix, ahead_of.rhs);
  linear::BlockVector velocities(3, cloth.particleCount()), product(3, cloth.particleCount());
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) velocities.col(i) = state.velocities[i];
  there.matrix.multiply(velocities, product);
  const linear::BlockVector growth = ahead_of.rhs - there.rhs;
  EXPECT_LT((growth + ahead / a * product).norm(), 1e-12 * growth.norm());
  EXPECT_EQ(dense(ahead_of.matrix), dense(there.matrix));
}

TEST(Membrane, NewtonGradientIsThatOfTheIncrementalPotential) {
  const Cloth cloth(square(2), stiffeningFabric(), viscous());
  const double h = 0.01;
  const auto begin_strains =
      heldSince(membraneOf(cloth), randomState(cloth, 0.001, 0.0, 9).positions);
  ClothState state = randomState(cloth, 0.002, 0.0, 4);
  MembraneSystem system(cloth);
  membraneOf(cloth).assembleNewton(state.ofForces(), begin_strains.data(), h, Hessian::kProjected,
                                   system.matrix, system.rhs);
  const double step = 1e-7;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double middle = state.positions[i][axis];
      const auto potential = [&](double coordinate) {
        state.positions[i][axis] = coordinate;
        return membraneOf(cloth).incrementalPotential(state.ofForces(), begin_strains.data(), h);
      };
      const double gradient = (potential(middle + step) - potential(middle - step)) / (2.0 * step);
      state.positions[i][axis] = middle;
      EXPECT_NEAR(system.rhs(axis, i), -h * gradient, 1e-6 * h);  // gradients near 10 N
    }
  }
}

TEST(Membrane, ExactNewtonHessianIsTheDerivativeOfItsGradient) {
  const Cloth cloth(square(2), stiffeningFabric(), viscous());
  const double h = 0.01, step = 1e-8;
  const auto begin_strains =
      heldSince(membraneOf(cloth), randomState(cloth, 0.001, 0.0, 9).positions);
  ClothState state = randomState(cloth, 0.002, 0.0, 4);
  const auto system = [&] {
    MembraneSystem result(cloth);
    membraneOf(cloth).assembleNewton(state.ofForces(), begin_strains.data(), h, Hessian::kExact,
                                     result.matrix, result.rhs);
    return result;
  };
  const Eigen::MatrixXd hessian = dense(system().matrix);
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double middle = state.positions[i][axis];
      state.positions[i][axis] = middle + step;
      const Eigen::VectorXd above = stacked(system().rhs);
      state.positions[i][axis] = middle - step;
      const Eigen::VectorXd below = stacked(system().rhs);
      state.positions[i][axis] = middle;
      // rhs is -h times the gradient, the matrix h^2 times the Hessian.
      const Eigen::VectorXd column = -h * (above - below) / (2.0 * step);
      EXPECT_LT((hessian.col(3 * i + axis) - column).norm(), 1e-6 * hessian.norm());
    }
  }
}

TEST(Membrane, NewtonFeelsNoViscosityInARigidRotation) {
  const Cloth cloth(square(3), stiffeningFabric(), viscous());
  const ClothState state = cloth.initialState();
  const auto begin_strains = heldSince(membraneOf(cloth), state.positions);
  Positions turned = state.positions;
  for (Vector3d& position : turned) {
    position = Eigen::AngleAxisd(1.5, Vector3d::UnitX()) * position;
  }
  MembraneSystem system(cloth);
  membraneOf(cloth).assembleNewton(resting(turned), begin_strains.data(), 0.01, Hessian::kProjected,
                                   system.matrix, system.rhs);
  EXPECT_LT(system.rhs.cwiseAbs().maxCoeff(), 1e-13);
}

}  // namespace
}  // namespace haptex::cloth::test_membrane
