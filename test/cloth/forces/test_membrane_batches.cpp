// The triangles that are added some at a time, beside the same triangles one by one.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "fixtures.h"
#include "force_fixtures.h"
#include "haptex/cloth/forces/membrane.h"
#include "membrane_fixtures.h"

namespace haptex::cloth::test_membrane_batches {
namespace {

using Eigen::Vector3d;

/// What is added for all triangles, each as a mesh of its own: too few to be added in batches.
MembraneSystem sumOfEachAlone(
    const Cloth& cloth, const material::Fabric& fabric,
    const std::function<void(const Membrane&, std::size_t triangle, linear::SymmetricBlockMatrix&,
                             linear::BlockVector&)>& add) {
  MembraneSystem sum(cloth);
  for (std::size_t t = 0; t < cloth.mesh().triangles.size(); ++t) {
    mesh::ClothMesh mesh = cloth.mesh();
    mesh.triangles = {mesh.triangles[t]};
    Membrane membrane(restElements(mesh), fabric, cloth.effects().viscosity,
                      cloth.effects().contraction);
    linear::SymmetricBlockMatrix matrix(sum.matrix.size(), mesh.triangles);
    membrane.bind(matrix);
    add(membrane, t, matrix, sum.rhs);
    for (int i = 0; i < matrix.size(); ++i) {
      sum.matrix.diagonal(i) += matrix.diagonal(i);
      for (int s = matrix.rowBegin(i); s < matrix.rowBegin(i + 1); ++s) {
        sum.matrix.lower(sum.matrix.slot(i, matrix.column(s))) += matrix.lower(s);
      }
    }
  }
  return sum;
}

class StepInBatches : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Viscosity, StepInBatches, testing::Bool());

TEST_P(StepInBatches, IsTheSumOfTheStepsOfTheTrianglesAlone) {
  ModelledEffects effects;
  effects.viscosity = GetParam();
  // 18, 32 and 50 triangles, so that two remain after the last whole batch of four, or none.
  for (int cells : {3, 4, 5}) {
    const Cloth cloth(square(cells), stiffeningFabric(), effects);
    for (unsigned seed = 1; seed <= 9; ++seed) {
      // Stretch, shear and compression on every branch of the curves and of projectStress().
      ClothState state = randomState(cloth, seed % 3 == 0 ? 0.03 : 0.003, 3.0, seed);
      if (seed % 2 == 0) {
        for (Vector3d& position : state.positions) position *= 0.7;
      }
      const StageTimes times{0.002, std::array{0.002, 0.0, 0.003}[seed % 3]};
      const MembraneSystem exact =
          sumOfEachAlone(cloth, stiffeningFabric(),
                         [&](const Membrane& membrane, std::size_t,
                             linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) {
                           membrane.assembleLinearised(state.ofForces(), times, matrix, rhs);
                         });
      MembraneSystem system(cloth);
      membraneOf(cloth).assembleLinearised(state.ofForces(), times, system.matrix, system.rhs);
      // The sums have the same order; what differs is the rounding within an element.
      EXPECT_LT((dense(system.matrix) - dense(exact.matrix)).norm(),
                1e-13 * dense(exact.matrix).norm());
      EXPECT_LT((system.rhs - exact.rhs).norm(), 1e-13 * exact.rhs.norm());
    }
  }
}

TEST_P(StepInBatches, HasTheNewtonSystemAndThePotentialOfTheTrianglesAlone) {
  constexpr double kStep = 0.002;
  material::Fabric fabric = stiffeningFabric();
  for (double contraction : {0.0, 0.3}) {
    fabric.contraction = contraction;
    ModelledEffects effects;
    effects.viscosity = GetParam();
    effects.contraction = contraction > 0.0;
    for (int cells : {3, 4, 5}) {
      const Cloth cloth(square(cells), fabric, effects);
      const Membrane& membrane = membraneOf(cloth);
      for (unsigned seed = 1; seed <= 8; ++seed) {
        ClothState state = randomState(cloth, seed % 3 == 0 ? 0.03 : 0.003, 3.0, seed);
        if (seed % 2 == 0) {
          for (Vector3d& position : state.positions) position *= 0.7;
        }
        const auto begin = heldBefore(membrane, state.ofForces(), kStep);
        double potential = 0.0;
        for (const auto hessian : {Hessian::kExact, Hessian::kProjected}) {
          potential = 0.0;
          const MembraneSystem exact = sumOfEachAlone(
              cloth, fabric,
              [&](const Membrane& one, std::size_t t, linear::SymmetricBlockMatrix& matrix,
                  linear::BlockVector& rhs) {
                one.assembleNewton(state.ofForces(), &begin[t], kStep, hessian, matrix, rhs);
                potential += one.incrementalPotential(state.ofForces(), &begin[t], kStep);
              });
          MembraneSystem system(cloth);
          membrane.assembleNewton(state.ofForces(), begin.data(), kStep, hessian, system.matrix,
                                  system.rhs);
          EXPECT_LT((dense(system.matrix) - dense(exact.matrix)).norm(),
                    1e-13 * dense(exact.matrix).norm());
          EXPECT_LT((system.rhs - exact.rhs).norm(), 1e-13 * exact.rhs.norm());
        }
        EXPECT_NEAR(membrane.incrementalPotential(state.ofForces(), begin.data(), kStep), potential,
                    1e-13 * std::abs(potential));
      }
    }
  }
}

TEST_P(StepInBatches, IsExactlyTheSameEveryTime) {
  ModelledEffects effects;
  effects.viscosity = GetParam();
  const Cloth cloth(square(5), stiffeningFabric(), effects);
  const ClothState state = randomState(cloth, 0.01, 1.0);
  MembraneSystem first(cloth), second(cloth);
  membraneOf(cloth).assembleLinearised(state.ofForces(), {0.001, 0.001}, first.matrix, first.rhs);
  membraneOf(cloth).assembleLinearised(state.ofForces(), {0.001, 0.001}, second.matrix, second.rhs);
  EXPECT_EQ(dense(first.matrix), dense(second.matrix));
  EXPECT_EQ(first.rhs, second.rhs);
}

TEST_P(StepInBatches, HidesNoNumberThatIsNotFinite) {
  ModelledEffects effects;
  effects.viscosity = GetParam();
  const Cloth cloth(square(3), stiffeningFabric(), effects);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (double bad : {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity}) {
    for (std::size_t particle = 0; particle < cloth.particleCount(); ++particle) {
      for (int axis = 0; axis < 3; ++axis) {
        for (bool moving : {false, true}) {
          ClothState state = randomState(cloth, 1e-3, 0.1);
          (moving ? state.velocities : state.positions)[particle][axis] = bad;
          MembraneSystem system(cloth);
          membraneOf(cloth).assembleLinearised(state.ofForces(), {0.001, 0.001}, system.matrix,
                                               system.rhs);
          EXPECT_FALSE(system.rhs.allFinite());
          if (moving) continue;
          const std::vector<MembraneStrain> begin(cloth.mesh().triangles.size(),
                                                  MembraneStrain::Zero());
          MembraneSystem newton(cloth);
          membraneOf(cloth).assembleNewton(state.ofForces(), begin.data(), 0.001,
                                           Hessian::kProjected, newton.matrix, newton.rhs);
          EXPECT_FALSE(newton.rhs.allFinite());
          EXPECT_FALSE(std::isfinite(
              membraneOf(cloth).incrementalPotential(state.ofForces(), begin.data(), 0.001)));
        }
      }
    }
  }
}

}  // namespace
}  // namespace haptex::cloth::test_membrane_batches
