// Elements in parts that threads share, beside the same by one thread.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "elasticity_fixtures.h"
#include "fixtures.h"
#include "force_fixtures.h"
#include "haptex/cloth/forces/batches/batch_list.h"

namespace haptex::cloth::test_batch_list {
namespace {

constexpr double kStep = 0.002;  // s

TEST(BatchList, PartsOfAPhaseHaveNoParticleInCommon) {
  std::mt19937 random(1);
  for (const int spread : {10, 100, 2000}) {
    std::vector<kernels::Part> parts;
    for (int p = 0; p < 40; ++p) {
      const int lowest = std::uniform_int_distribution<int>(20 * p, 20 * p + spread)(random);
      const int highest = std::uniform_int_distribution<int>(lowest, lowest + spread)(random);
      parts.push_back({p, 1, lowest, highest});
    }
    const kernels::Phases phases = kernels::phasesOf(parts);
    ASSERT_EQ(phases.parts.size(), parts.size());
    std::vector<int> seen(parts.size(), 0);
    int begin = 0;
    for (const int end : phases.ends) {
      for (int i = begin; i < end; ++i) {
        ++seen[phases.parts[i].first];
        for (int j = begin; j < i; ++j) {
          EXPECT_TRUE(phases.parts[i].highest < phases.parts[j].lowest ||
                      phases.parts[j].highest < phases.parts[i].lowest);
        }
      }
      begin = end;
    }
    EXPECT_EQ(begin, static_cast<int>(parts.size()));
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<long>(parts.size()));
  }
}

/// What a cloth's elements add to systems, and their potential.
struct Sums {
  Sums(const Cloth& cloth, const ClothState& state, linear::ThreadPool* pool)
      : step(cloth.pattern()),
        newton(step),
        step_rhs(linear::BlockVector::Zero(3, step.size())),
        newton_rhs(step_rhs) {
    const Force& force = elasticityOf(cloth);
    const ForceState at = state.ofForces(pool);
    const std::vector<Eigen::Vector3d> held = heldBefore(force, at, kStep);
    force.assembleLinearised(at, {kStep, kStep}, step, step_rhs);
    force.assembleNewton(at, held.data(), kStep, Hessian::kProjected, newton, newton_rhs);
    potential = force.incrementalPotential(at, held.data(), kStep);
  }

  linear::SymmetricBlockMatrix step, newton;
  linear::BlockVector step_rhs, newton_rhs;
  double potential;
};

void expectNear(const linear::SymmetricBlockMatrix& matrix,
                const linear::SymmetricBlockMatrix& other, double tolerance) {
  for (int i = 0; i < matrix.size(); ++i) {
    EXPECT_LE((matrix.diagonal(i) - other.diagonal(i)).norm(),
              tolerance * other.diagonal(i).norm());
  }
  for (int s = 0; s < matrix.lowerCount(); ++s) {
    EXPECT_LE((matrix.lower(s) - other.lower(s)).norm(), tolerance * other.lower(s).norm());
  }
}

class SharedElements : public testing::TestWithParam<Elasticity> {};
INSTANTIATE_TEST_SUITE_P(Elasticities, SharedElements,
                         testing::Values(Elasticity::kGreenLagrange, Elasticity::kBilinear));

TEST_P(SharedElements, HaveTheSameSumsWithAnyNumberOfThreads) {
  for (const bool viscosity : {false, true}) {
    // 9522 cells: some parts of each kind of element.
    const Cloth cloth(square(138), stiffeningFabric(), effectsOf(GetParam(), viscosity));
    const ClothState state = randomState(cloth, 3e-5, 0.3);
    const Sums alone(cloth, state, nullptr);
    for (const int threads : {2, 3}) {
      linear::ThreadPool pool(threads);
      const Sums shared(cloth, state, &pool);
      expectNear(shared.step, alone.step, 0.0);
      expectNear(shared.newton, alone.newton, 0.0);
      EXPECT_EQ(shared.step_rhs, alone.step_rhs);
      EXPECT_EQ(shared.newton_rhs, alone.newton_rhs);
      EXPECT_EQ(shared.potential, alone.potential);
    }
  }
}

TEST(SharedTriangles, AreAllAddedWhereverTheirParticlesStandInTheList) {
  const mesh::ClothMesh ordered = square(70);
  mesh::ClothMesh shuffled = ordered;
  std::vector<int> place(ordered.rest_coordinates.size());
  std::iota(place.begin(), place.end(), 0);
  std::shuffle(place.begin(), place.end(), std::mt19937(1));
  for (std::size_t i = 0; i < place.size(); ++i) {
    shuffled.rest_coordinates[place[i]] = ordered.rest_coordinates[i];
    shuffled.initial_positions[place[i]] = ordered.initial_positions[i];
  }
  for (auto& triangle : shuffled.triangles) {
    for (int& particle : triangle) particle = place[particle];
  }
  const Cloth first(ordered, stiffeningFabric(), {}), second(shuffled, stiffeningFabric(), {});
  const ClothState state = randomState(first, 3e-5, 0.3);
  ClothState moved = state;
  for (std::size_t i = 0; i < place.size(); ++i) {
    moved.positions[place[i]] = state.positions[i];
    moved.velocities[place[i]] = state.velocities[i];
  }
  linear::ThreadPool pool(2);
  const Sums expected(first, state, nullptr), found(second, moved, &pool);
  EXPECT_NEAR(found.potential, expected.potential, 1e-12 * expected.potential);
  const double size = expected.step_rhs.cwiseAbs().maxCoeff();
  for (std::size_t i = 0; i < place.size(); ++i) {
    const int other = place[i];
    EXPECT_LE((found.step_rhs.col(other) - expected.step_rhs.col(i)).norm(), 1e-12 * size);
    EXPECT_LE((found.step.diagonal(other) - expected.step.diagonal(i)).norm(),
              1e-12 * expected.step.diagonal(i).norm());
  }
}

}  // namespace
}  // namespace haptex::cloth::test_batch_list
