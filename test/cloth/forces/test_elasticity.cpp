// What every model of stretch and shear promises. Their integration in time is tested in
// test_integrators.cpp.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <limits>
#include <numeric>

#include "derivatives.h"
#include "elasticity_fixtures.h"
#include "force_fixtures.h"
#include "haptex/cloth/dynamics/cloth.h"

namespace haptex::cloth::test_elasticity {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

Cloth clothOf(Elasticity elasticity, bool viscosity) {
  // Cells of 20 x 30 mm, and bend springs where there are any.
  return Cloth(mesh::makeRectangle(0.06, 0.09, 3, 3, mesh::Triangulation::kAlternating),
               fabricWithRigidity(),
               effectsOf(elasticity, viscosity, elasticity == Elasticity::kMassSpring));
}

std::vector<int> allParticles(const Cloth& cloth) {
  std::vector<int> particles(cloth.particleCount());
  std::iota(particles.begin(), particles.end(), 0);
  return particles;
}

class EveryElasticity : public testing::TestWithParam<Elasticity> {};
INSTANTIATE_TEST_SUITE_P(Models, EveryElasticity,
                         testing::Values(Elasticity::kGreenLagrange, Elasticity::kBilinear,
                                         Elasticity::kMassSpring, Elasticity::kCorotational),
                         [](const auto& info) {
                           return info.param == Elasticity::kMassSpring     ? "mass_spring"
                                  : info.param == Elasticity::kBilinear     ? "bilinear"
                                  : info.param == Elasticity::kCorotational ? "corotational"
                                                                            : "green_lagrange";
                         });

TEST_P(EveryElasticity, RigidMotionCostsNothing) {
  const Cloth cloth = clothOf(GetParam(), true);
  ClothState state = cloth.initialState();
  const Matrix3d rotation =
      Eigen::AngleAxisd(2.0, Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    state.positions[i] = rotation * state.positions[i] + Vector3d(1.0, 2.0, -3.0);
    state.velocities[i] =
        Vector3d(3.0, -1.0, 2.0).cross(state.positions[i]) + Vector3d(5.0, 0.0, 1.0);
  }
  // Coordinates of a few metres are rounded to 4e-16 m, cells are 0.02 m: strain to 1e-13.
  EXPECT_LT(largest(forcesOf(cloth, state)), 1e-11);
  EXPECT_LT(cloth.potentialEnergy(state),
            1e-18);  // J; curves are integrated from knots beside zero
}

TEST_P(EveryElasticity, ForcesTurnWithTheCloth) {
  const Cloth cloth = clothOf(GetParam(), true);
  ClothState state = randomState(cloth, 0.004, 1.0);
  const std::vector<Vector3d> before = forcesOf(cloth, state);
  const Matrix3d rotation =
      Eigen::AngleAxisd(1.0, Vector3d(2.0, 1.0, -0.5).normalized()).toRotationMatrix();
  for (Vector3d& position : state.positions) position = rotation * position;
  for (Vector3d& velocity : state.velocities) velocity = rotation * velocity;
  const std::vector<Vector3d> after = forcesOf(cloth, state);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_LT((after[i] - rotation * before[i]).norm(), 1e-12 * largest(before));
  }
}

TEST_P(EveryElasticity, ElasticForceIsTheNegativeGradientOfTheEnergy) {
  const Cloth cloth = clothOf(GetParam(), false);
  for (unsigned seed = 1; seed <= 4; ++seed) {
    ClothState state = randomState(cloth, 0.001 * seed, 0.0, seed);
    const auto energy = [&](const ClothState& at) { return cloth.potentialEnergy(at); };
    expectGradient(forcesOf(cloth, state), state, energy, 1e-7, 1e-7);
  }
}

TEST_P(EveryElasticity, ForcesAndTheirMomentsSumToZero) {
  const Cloth cloth = clothOf(GetParam(), true);
  const ClothState state = randomState(cloth, 0.005, 1.0);
  const std::vector<Vector3d> forces = forcesOf(cloth, state);
  Vector3d sum = Vector3d::Zero(), moment = Vector3d::Zero();
  for (std::size_t i = 0; i < forces.size(); ++i) {
    sum += forces[i];
    moment += state.positions[i].cross(forces[i]);
  }
  EXPECT_GT(largest(forces), 0.01);
  EXPECT_LT(sum.norm(), 1e-13 * largest(forces));
  EXPECT_LT(moment.norm(), 1e-14 * largest(forces));
}

TEST_P(EveryElasticity, ViscosityOnlyTakesEnergyOut) {
  const Cloth with = clothOf(GetParam(), true), without = clothOf(GetParam(), false);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const ClothState state = randomState(with, 0.003, 2.0, seed);
    const std::vector<Vector3d> all = forcesOf(with, state), elastic = forcesOf(without, state);
    double power = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      power += (all[i] - elastic[i]).dot(state.velocities[i]);
    }
    EXPECT_LT(power, -1e-3);
  }
}

/// In tension, in compression and turned by noise.
std::vector<ClothState> variousStates(const Cloth& cloth) {
  std::vector<ClothState> states;
  for (double stretch : {1.06, 0.7, 1.0}) {
    states.push_back(randomState(cloth, stretch == 1.0 ? 0.01 : 0.001, 0.5));
    for (Vector3d& position : states.back().positions) position *= stretch;
  }
  return states;
}

TEST_P(EveryElasticity, JacobianIsTheDerivativeOfTheForces) {
  const Cloth cloth = clothOf(GetParam(), true);
  for (ClothState state : variousStates(cloth)) {
    const std::vector<JacobianBlock> blocks = cloth.jacobian(state, allParticles(cloth));
    double largest_position = 0.0, largest_velocity = 0.0;
    double position_error = 0.0, velocity_error = 0.0;
    const auto difference = [&](double& coordinate, double step, int row) {
      const double middle = coordinate;
      coordinate = middle + step;
      const Vector3d above = forcesOf(cloth, state)[row];
      coordinate = middle - step;
      const Vector3d below = forcesOf(cloth, state)[row];
      coordinate = middle;
      return Vector3d((above - below) / (2.0 * step));
    };
    for (const JacobianBlock& block : blocks) {
      for (int axis = 0; axis < 3; ++axis) {
        const Vector3d by_position =
            difference(state.positions[block.column][axis], 1e-8, block.row);
        const Vector3d by_velocity =
            difference(state.velocities[block.column][axis], 1e-3, block.row);
        position_error =
            std::max(position_error, (by_position - block.by_position.col(axis)).norm());
        velocity_error =
            std::max(velocity_error, (by_velocity - block.by_velocity.col(axis)).norm());
      }
      largest_position = std::max(largest_position, block.by_position.norm());
      largest_velocity = std::max(largest_velocity, block.by_velocity.norm());
    }
    // Rounding of the forces over the step, and its square; by velocity they are linear.
    EXPECT_LT(position_error, 1e-7 * largest_position);
    EXPECT_LT(velocity_error, 1e-9 * largest_velocity);
  }
}

struct System {
  explicit System(const Cloth& cloth)
      : matrix(cloth.pattern()), rhs(linear::BlockVector::Zero(3, cloth.particleCount())) {}
  linear::SymmetricBlockMatrix matrix;
  linear::BlockVector rhs;
};

TEST_P(EveryElasticity, StepMatrixIsPositiveSemidefiniteForEveryState) {
  const Cloth cloth = clothOf(GetParam(), true);
  for (unsigned seed = 1; seed <= 30; ++seed) {
    ClothState state = randomState(cloth, seed % 3 == 0 ? 0.1 : 0.01, 10.0, seed);
    if (seed % 5 == 0) {
      for (Vector3d& position : state.positions) position *= 0.3;
    }
    System step(cloth), newton(cloth);
    cloth.forces().assembleLinearised(state.ofForces(), {0.0125, 0.0125}, step.matrix, step.rhs);
    const auto held = heldSince(cloth.forces(), cloth.initialState().positions);
    cloth.forces().assembleNewton(state.ofForces(), held.data(), 0.0125, Hessian::kProjected,
                                  newton.matrix, newton.rhs);
    for (const System* system : {&step, &newton}) {
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(dense(system->matrix));
      EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-13 * eigen.eigenvalues().maxCoeff());
    }
  }
}

TEST_P(EveryElasticity, StepIsTheExactLinearisationInTension) {
  // Without velocity, so that the viscous part of dF/dP, which the step leaves out, vanishes from
  // the matrix; then with velocity and without viscosity for the right-hand side.
  const double h = 0.01;
  for (bool viscosity : {true, false}) {
    const Cloth cloth(square(3), stiffeningFabric(), effectsOf(GetParam(), viscosity));
    ClothState state = randomState(cloth, 1e-5, viscosity ? 0.0 : 1.0);
    for (Vector3d& position : state.positions) position *= 1.06;
    System system(cloth);
    cloth.forces().assembleLinearised(state.ofForces(), {h, h}, system.matrix, system.rhs);
    const Eigen::MatrixXd assembled = dense(system.matrix);
    linear::BlockVector rhs(3, cloth.particleCount());
    const std::vector<Vector3d> forces = forcesOf(cloth, state);
    for (std::size_t i = 0; i < forces.size(); ++i) rhs.col(i) = h * forces[i];
    for (const JacobianBlock& block : cloth.jacobian(state, allParticles(cloth))) {
      const Matrix3d exact = -h * h * block.by_position - h * block.by_velocity;
      EXPECT_LT((assembled.block<3, 3>(3 * block.row, 3 * block.column) - exact).norm(),
                1e-12 * assembled.norm());
      rhs.col(block.row) += h * h * block.by_position * state.velocities[block.column];
    }
    EXPECT_LT((system.rhs - rhs).norm(), 1e-12 * rhs.norm());
  }
}

TEST_P(EveryElasticity, NewtonsGradientAndHessianAreThoseOfTheIncrementalPotential) {
  const Cloth cloth = clothOf(GetParam(), true);
  ClothState state = randomState(cloth, 0.004, 0.5);
  const double h = 0.01;
  const auto begin = heldBefore(cloth.forces(), state.ofForces(), h);
  for (Vector3d& position : state.positions) position += 1e-4 * Vector3d(0.3, position.y() * 20, 1);
  const auto system_at = [&](const ClothState& at) {
    System system(cloth);
    cloth.forces().assembleNewton(at.ofForces(), begin.data(), h, Hessian::kExact, system.matrix,
                                  system.rhs);
    return system;
  };
  const System system = system_at(state);
  const Eigen::MatrixXd hessian = dense(system.matrix);
  constexpr double kStep = 1e-7;  // m
  for (int particle : {0, 5, 6, 15}) {
    for (int axis = 0; axis < 3; ++axis) {
      ClothState above = state, below = state;
      above.positions[particle][axis] += kStep;
      below.positions[particle][axis] -= kStep;
      const auto potential = [&](const ClothState& at) {
        return cloth.forces().incrementalPotential(at.ofForces(), begin.data(), h);
      };
      const double slope = (potential(above) - potential(below)) / (2.0 * kStep);
      EXPECT_NEAR(system.rhs(axis, particle), -h * slope, 1e-6 * system.rhs.norm());
      const Eigen::VectorXd column =
          -h * (stacked(system_at(above).rhs) - stacked(system_at(below).rhs)) / (2.0 * kStep);
      EXPECT_LT((hessian.col(3 * particle + axis) - column).norm(), 1e-6 * hessian.norm());
    }
  }
}

TEST_P(EveryElasticity, StrainsBeforeGoBackAtThePresentRate) {
  const Cloth cloth = clothOf(GetParam(), true);
  const ClothState state = randomState(cloth, 0.004, 0.5);
  constexpr double kInterval = 1e-6;  // s
  ClothState earlier = state;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    earlier.positions[i] -= kInterval * state.velocities[i];
  }
  const Force& elastic = elasticityOf(cloth);
  const auto before = heldBefore(elastic, state.ofForces(), kInterval);
  const auto exact = heldSince(elastic, earlier.positions);
  for (std::size_t t = 0; t + 1 < before.size(); ++t) {  // the last may have unused entries
    EXPECT_LT((before[t] - exact[t]).norm(), 1e-7);      // (speed interval / cell)^2
  }
}

TEST_P(EveryElasticity, CollapsedClothHasFiniteForcesAndSteps) {
  const Cloth cloth = clothOf(GetParam(), true);
  for (int kind : {0, 1, 2}) {  // a point, a line along weft, an oblique line
    ClothState state = cloth.initialState();
    for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
      const Vector2d& rest = cloth.mesh().rest_coordinates[i];
      if (kind == 0) state.positions[i].setZero();
      if (kind == 1) state.positions[i] = {0.0, rest.x(), 0.0};
      if (kind == 2) state.positions[i] = Vector3d(1.0, 2.0, 3.0) * (rest.x() - 0.3 * rest.y());
    }
    for (const Vector3d& force : forcesOf(cloth, state)) EXPECT_TRUE(force.allFinite());
    System system(cloth);
    cloth.forces().assembleLinearised(state.ofForces(), {0.01, 0.01}, system.matrix, system.rhs);
    EXPECT_TRUE(dense(system.matrix).allFinite());
    EXPECT_TRUE(system.rhs.allFinite());
  }
}

TEST_P(EveryElasticity, TakesTheCurvesOfAnotherFabric) {
  Cloth changed(square(3), linearFabric(), effectsOf(GetParam(), true));
  changed.setFabric(stiffeningFabric());
  const Cloth fresh(square(3), stiffeningFabric(), effectsOf(GetParam(), true));
  const ClothState state = randomState(fresh, 0.002, 1.0);
  const std::vector<Vector3d> forces = forcesOf(fresh, state), others = forcesOf(changed, state);
  for (std::size_t i = 0; i < forces.size(); ++i) EXPECT_EQ(forces[i], others[i]);
}

}  // namespace
}  // namespace haptex::cloth::test_elasticity
