// The cells that are added some at a time, beside the same cells one by one.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "fixtures.h"
#include "haptex/cloth/forces/cells/bilinear_cells.h"

namespace haptex::cloth::test_bilinear_batches {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// No cell is a parallelogram, and the threads are along none of their sides.
mesh::ClothMesh irregular(int cells) {
  mesh::ClothMesh mesh = square(cells);
  for (std::size_t i = 0; i < mesh.rest_coordinates.size(); ++i) {
    const double angle = static_cast<double>(i);
    mesh.rest_coordinates[i] +=
        0.015 / cells * Vector2d(std::sin(1.7 * angle), std::cos(2.9 * angle));
  }
  mesh.panels = {{0, 0.4}};
  return mesh;
}

struct System {
  linear::SymmetricBlockMatrix matrix;
  linear::BlockVector rhs;
  System(std::size_t particles, const BilinearCells& cells)
      : matrix(static_cast<int>(particles), {}, cells.pairs()),
        rhs(linear::BlockVector::Zero(3, static_cast<Eigen::Index>(particles))) {}
};

struct Sample {
  std::vector<TrianglePair> pairs;
  material::Fabric fabric = stiffeningFabric();
  bool viscosity;
  std::size_t particles;
  BilinearCells cells;

  Sample(const mesh::ClothMesh& mesh, bool with_viscosity)
      : pairs(pairTriangles(mesh, 0).pairs),
        viscosity(with_viscosity),
        particles(mesh.rest_coordinates.size()),
        cells(pairs, fabric, viscosity) {
    cells.bind(System(particles, cells).matrix);
  }

  /// What is added for all cells, each alone: too few to be added in batches.
  System sumOfEachAlone(
      const std::function<void(const BilinearCells&, std::size_t, System&)>& add) const {
    System sum(particles, cells);
    for (std::size_t c = 0; c < pairs.size(); ++c) {
      BilinearCells one({pairs[c]}, fabric, viscosity);
      System system(particles, one);
      one.bind(system.matrix);
      add(one, c, system);
      sum.rhs += system.rhs;
      for (int i = 0; i < system.matrix.size(); ++i) {
        sum.matrix.diagonal(i) += system.matrix.diagonal(i);
        for (int s = system.matrix.rowBegin(i); s < system.matrix.rowBegin(i + 1); ++s) {
          sum.matrix.lower(sum.matrix.slot(i, system.matrix.column(s))) += system.matrix.lower(s);
        }
      }
    }
    return sum;
  }
};

/// Stretch, shear and compression on every branch of the curves and of the projection.
ClothState stateOf(const Cloth& cloth, unsigned seed) {
  ClothState state = randomState(cloth, seed % 3 == 0 ? 0.03 : 0.003, 3.0, seed);
  if (seed % 2 == 0) {
    for (Vector3d& position : state.positions) position *= 0.7;
  }
  return state;
}

void expectEqual(const System& system, const System& exact) {
  // The sums have the same order; what differs is the rounding within a cell.
  EXPECT_LT((dense(system.matrix) - dense(exact.matrix)).norm(),
            1e-13 * dense(exact.matrix).norm());
  EXPECT_LT((system.rhs - exact.rhs).norm(), 1e-13 * exact.rhs.norm());
}

class CellsInBatches : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Viscosity, CellsInBatches, testing::Bool());

TEST_P(CellsInBatches, AreTheSumOfTheStepsOfTheCellsAlone) {
  // 9, 16 and about 25 cells, so that some remain after the last whole batch of four, or none.
  for (const mesh::ClothMesh& mesh : {square(3), square(4), irregular(5)}) {
    const Cloth cloth(mesh, stiffeningFabric(), ModelledEffects());
    const Sample sample(mesh, GetParam());
    for (unsigned seed = 1; seed <= 9; ++seed) {
      const ClothState state = stateOf(cloth, seed);
      const StageTimes times{0.002, std::array{0.002, 0.0, 0.003}[seed % 3]};
      const System exact =
          sample.sumOfEachAlone([&](const BilinearCells& one, std::size_t, System& system) {
            one.assembleLinearised(state.ofForces(), times, system.matrix, system.rhs);
          });
      System system(sample.particles, sample.cells);
      sample.cells.assembleLinearised(state.ofForces(), times, system.matrix, system.rhs);
      expectEqual(system, exact);
    }
  }
}

TEST_P(CellsInBatches, HaveTheNewtonSystemAndThePotentialOfTheCellsAlone) {
  constexpr double kStep = 0.002;
  for (const mesh::ClothMesh& mesh : {square(3), square(4), irregular(5)}) {
    const Cloth cloth(mesh, stiffeningFabric(), ModelledEffects());
    const Sample sample(mesh, GetParam());
    for (unsigned seed = 1; seed <= 9; ++seed) {
      const ClothState state = stateOf(cloth, seed);
      std::vector<Vector3d> held(sample.cells.heldSize());
      sample.cells.hold({state.positions, state.ofForces(), kStep, false}, held.data());
      double potential = 0.0, energy = 0.0;
      for (const Hessian hessian : {Hessian::kExact, Hessian::kProjected}) {
        potential = energy = 0.0;
        const System exact =
            sample.sumOfEachAlone([&](const BilinearCells& one, std::size_t c, System& system) {
              one.assembleNewton(state.ofForces(), &held[2 * c], kStep, hessian, system.matrix,
                                 system.rhs);
              potential += one.incrementalPotential(state.ofForces(), &held[2 * c], kStep);
              energy += one.energy(state.ofForces());
            });
        System system(sample.particles, sample.cells);
        sample.cells.assembleNewton(state.ofForces(), held.data(), kStep, hessian, system.matrix,
                                    system.rhs);
        expectEqual(system, exact);
      }
      EXPECT_NEAR(sample.cells.incrementalPotential(state.ofForces(), held.data(), kStep),
                  potential, 1e-13 * std::abs(potential));
      EXPECT_NEAR(sample.cells.energy(state.ofForces()), energy, 1e-13 * energy);
    }
  }
}

TEST_P(CellsInBatches, AreExactlyTheSameEveryTime) {
  const Cloth cloth(square(4), stiffeningFabric(), ModelledEffects());
  const Sample sample(square(4), GetParam());
  const ClothState state = randomState(cloth, 0.01, 1.0);
  System first(sample.particles, sample.cells), second(sample.particles, sample.cells);
  for (System* system : {&first, &second}) {
    sample.cells.assembleLinearised(state.ofForces(), {0.001, 0.001}, system->matrix, system->rhs);
  }
  EXPECT_EQ(dense(first.matrix), dense(second.matrix));
  EXPECT_EQ(first.rhs, second.rhs);
}

TEST_P(CellsInBatches, HideNoNumberThatIsNotFinite) {
  const Cloth cloth(square(4), stiffeningFabric(), ModelledEffects());
  const Sample sample(square(4), GetParam());
  const std::vector<Vector3d> held(sample.cells.heldSize(), Vector3d::Zero());
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (double bad : {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity}) {
    for (std::size_t particle = 0; particle < sample.particles; ++particle) {
      for (int axis = 0; axis < 3; ++axis) {
        for (bool moving : {false, true}) {
          ClothState state = randomState(cloth, 1e-3, 0.1);
          (moving ? state.velocities : state.positions)[particle][axis] = bad;
          System system(sample.particles, sample.cells);
          sample.cells.assembleLinearised(state.ofForces(), {0.001, 0.001}, system.matrix,
                                          system.rhs);
          EXPECT_FALSE(system.rhs.allFinite());
          if (moving) continue;
          System newton(sample.particles, sample.cells);
          sample.cells.assembleNewton(state.ofForces(), held.data(), 0.001, Hessian::kProjected,
                                      newton.matrix, newton.rhs);
          EXPECT_FALSE(newton.rhs.allFinite());
          EXPECT_FALSE(std::isfinite(
              sample.cells.incrementalPotential(state.ofForces(), held.data(), 0.001)));
        }
      }
    }
  }
}

}  // namespace
}  // namespace haptex::cloth::test_bilinear_batches
