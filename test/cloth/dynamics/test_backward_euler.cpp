#include <gtest/gtest.h>

#include <limits>

#include "fixtures.h"
#include "force_fixtures.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/cloth/dynamics/stages/stage_solver.h"

namespace haptex::cloth::test_backward_euler {
namespace {

using Eigen::Vector3d;

ModelledEffects gravity(double g = 9.81) {
  ModelledEffects effects;
  effects.gravity = {0.0, 0.0, -g};
  return effects;
}

void attachTop(Cloth& cloth) {
  for (int particle : mesh::sideParticles(cloth.mesh(), mesh::Side::kTop)) {
    AttachmentPath path;
    path.start = cloth.mesh().initial_positions[particle];
    cloth.attach(particle, path);
  }
}

TEST(BackwardEuler, FreeFallIsThatOfBackwardEulerForNonUniformSteps) {
  Cloth cloth(square(4), linearFabric(), gravity(10.0));
  ClothState state = cloth.initialState();
  Integrator integrator(cloth, {});
  double speed = 0.0, height = 0.0;
  for (double h : {0.001, 0.04, 1e-6, 0.5, 0.0125}) {
    integrator.step(cloth, state, h);
    speed -= 10.0 * h;
    height += h * speed;
  }
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    EXPECT_NEAR(state.velocities[i].z(), speed, 1e-6 * std::abs(speed));
    EXPECT_NEAR(state.positions[i].z() - cloth.mesh().initial_positions[i].z(), height,
                1e-6 * std::abs(height));
  }
  EXPECT_NEAR(state.time, 0.5535010, 1e-12);
}

TEST(BackwardEuler, SolvesTheSystemOfTheDesign) {
  // (M - h D - h^2 K) dv = h (F + h K v) with the exact Jacobian, where nothing is projected.
  Cloth cloth(square(3), linearFabric(), gravity());
  ClothState state = randomState(cloth, 1e-4, 0.1);
  for (Vector3d& position : state.positions) position *= 1.05;
  const double h = 0.01;
  const Eigen::Index n = 3 * static_cast<Eigen::Index>(cloth.particleCount());
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(n, n), matrix = Eigen::MatrixXd::Zero(n, n);
  std::vector<int> particles(cloth.particleCount());
  for (std::size_t i = 0; i < particles.size(); ++i) particles[i] = static_cast<int>(i);
  for (const JacobianBlock& block : cloth.jacobian(state, particles)) {
    stiffness.block<3, 3>(3 * block.row, 3 * block.column) = block.by_position;
  }
  Eigen::VectorXd force(n), velocity(n);
  std::vector<Vector3d> forces;
  cloth.computeForces(state, forces);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    force.segment<3>(3 * i) = forces[i];
    velocity.segment<3>(3 * i) = state.velocities[i];
    matrix.block<3, 3>(3 * i, 3 * i).diagonal().setConstant(cloth.masses()[i]);
  }
  matrix -= h * h * stiffness;
  const Eigen::VectorXd change = matrix.llt().solve(h * (force + h * stiffness * velocity));

  StepSettings settings;
  settings.tolerance = 1e-12;
  ClothState end = state;
  Integrator(cloth, settings).step(cloth, end, h);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    EXPECT_LT((end.velocities[i] - state.velocities[i] - change.segment<3>(3 * i)).norm(),
              1e-9 * change.norm());
    EXPECT_LT((end.positions[i] - state.positions[i] - h * end.velocities[i]).norm(), 1e-15);
  }
}

TEST(BackwardEuler, AttachedParticlesAreExactlyAtTheirPlaceAfterEveryStep) {
  Cloth cloth(square(4), stiffeningFabric(), gravity());
  attachTop(cloth);
  AttachmentPath path;
  path.start = cloth.mesh().initial_positions[0];
  path.displacement = {0.05, -0.02, 0.03};
  path.start_time = 0.1;
  path.duration = 0.5;
  cloth.attach(0, path);
  ClothState state = cloth.initialState();
  Integrator integrator(cloth, {});
  while (state.time < 0.8) {
    integrator.step(cloth, state, 0.0125);
    EXPECT_EQ(state.positions[0], path.position(state.time));
  }
  EXPECT_LT(state.velocities[0].norm(), 1e-12);
  cloth.release(0);
  integrator.step(cloth, state, 0.0125);
  EXPECT_GT((state.positions[0] - path.position(1.0)).norm(), 1e-9);
}

TEST(BackwardEuler, EnergyNeverGrowsWithoutWork) {
  for (double h : {0.001, 0.0125, 0.1}) {
    Cloth cloth(square(6), linearFabric(0.1), gravity());
    attachTop(cloth);
    ClothState state = randomState(cloth, 0.002, 0.5);
    for (int particle : mesh::sideParticles(cloth.mesh(), mesh::Side::kTop)) {
      state.positions[particle] = cloth.mesh().initial_positions[particle];
      state.velocities[particle].setZero();
    }
    StepSettings settings;
    settings.newton_iterations = 30;
    Integrator integrator(cloth, settings);
    double energy = cloth.potentialEnergy(state) + cloth.kineticEnergy(state);
    for (int i = 0; i < 100; ++i) {
      integrator.step(cloth, state, h);
      const double next = cloth.potentialEnergy(state) + cloth.kineticEnergy(state);
      EXPECT_LE(next, energy + 1e-9) << "h " << h << " step " << i;  // energies near 1e-2 J
      energy = next;
    }
  }
}

TEST(BackwardEuler, ComesToRestWhereForcesVanish) {
  Cloth cloth(square(5), stiffeningFabric(), gravity());
  attachTop(cloth);
  ClothState state = cloth.initialState();
  Integrator integrator(cloth, {});
  for (int i = 0; i < 400; ++i) integrator.step(cloth, state, 0.04);
  std::vector<Vector3d> forces;
  cloth.computeForces(state, forces);
  Vector3d reaction = Vector3d::Zero();
  for (std::size_t i = 0; i < forces.size(); ++i) {
    if (cloth.isAttached(static_cast<int>(i))) {
      reaction -= forces[i];
    } else {
      EXPECT_LT(forces[i].norm(), 1e-9);
    }
  }
  EXPECT_NEAR(reaction.z(), 0.1 * 0.01 * 9.81, 1e-9);  // the bar carries the weight
}

TEST(BackwardEuler, NewtonReachesItsToleranceWhereOneSolveDoesNot) {
  ModelledEffects effects;
  effects.viscosity = true;
  Cloth cloth(square(5), stiffeningFabric(), effects);
  attachTop(cloth);
  const ClothState start = randomState(cloth, 0.002, 3.0);
  StepSettings settings;
  settings.newton_iterations = 100;
  settings.newton_tolerance = 1e-12;
  settings.tolerance = 1e-8;
  ClothState state = start;
  Integrator integrator(cloth, settings);
  const StepReport report = integrator.step(cloth, state, 0.01);
  EXPECT_TRUE(report.accepted);
  EXPECT_TRUE(report.newton_converged);
  EXPECT_LE(report.newton_residual, 1e-12);
  EXPECT_GT(report.newton_iterations, 2);
  // The state solves M (v - v0) = h F(x, rate) with the discrete strain rate.
  const auto begin = heldSince(membraneOf(cloth), start.positions);
  linear::SymmetricBlockMatrix unused(static_cast<int>(cloth.particleCount()),
                                      cloth.mesh().triangles);
  linear::BlockVector impulse = linear::BlockVector::Zero(3, cloth.particleCount());
  membraneOf(cloth).assembleNewton(state.ofForces(), begin.data(), 0.01, Hessian::kExact, unused,
                                   impulse);
  double scale = impulse.norm();
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (cloth.isAttached(static_cast<int>(i))) continue;
    const Vector3d change = cloth.masses()[i] * (state.velocities[i] - start.velocities[i]);
    EXPECT_LT((change - impulse.col(i)).norm(), 1e-7 * scale);
  }
}

TEST(BackwardEuler, ANewtonIterationNeverRaisesTheIncrementalPotential) {
  const Cloth cloth(square(4), stiffeningFabric(), {});
  const double h = 0.1;
  int changed = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    ClothState start = randomState(cloth, 0.02, 5.0, seed);
    for (Vector3d& position : start.positions) position *= 0.5;
    const auto begin = heldSince(membraneOf(cloth), start.positions);
    std::vector<double> potentials;
    for (int iterations : {1, 2}) {
      StepSettings settings;
      settings.newton_iterations = iterations;
      ClothState state = start;
      StepReport report;
      StageSolver(cloth, settings)
          .solve(cloth, {start, h, h, 1.0, StrainPast::since(start.positions, h)},
                 {start.positions, start.velocities, h}, state, report);
      double potential = membraneOf(cloth).incrementalPotential(state.ofForces(), begin.data(), h);
      for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
        potential +=
            0.5 * cloth.masses()[i] * (state.velocities[i] - start.velocities[i]).squaredNorm();
      }
      potentials.push_back(potential);
    }
    EXPECT_LE(potentials[1], potentials[0]) << seed;
    changed += potentials[1] < potentials[0];
  }
  EXPECT_GT(changed, 30);
}

TEST(BackwardEuler, DoesNotCallAFailedSolveConverged) {
  Cloth cloth(square(3), linearFabric(), gravity());
  ClothState state = cloth.initialState();
  state.velocities[5].x() = std::numeric_limits<double>::infinity();
  StepSettings settings;
  settings.newton_iterations = 5;
  const StepReport report = Integrator(cloth, settings).step(cloth, state, 0.01);
  EXPECT_FALSE(report.accepted);
  EXPECT_FALSE(report.linear_converged);
  EXPECT_FALSE(report.newton_converged);
}

TEST(BackwardEuler, BothSolversGiveTheSameMotion) {
  std::vector<ClothState> ends;
  for (linear::LinearSolverMethod method :
       {linear::LinearSolverMethod::kConjugateGradient, linear::LinearSolverMethod::kCholesky}) {
    Cloth cloth(square(8), stiffeningFabric(), gravity());
    attachTop(cloth);
    StepSettings settings;
    settings.solver = method;
    settings.tolerance = 1e-11;
    Integrator integrator(cloth, settings);
    ClothState state = cloth.initialState();
    for (int i = 0; i < 40; ++i) {
      const StepReport report = integrator.step(cloth, state, 0.0125);
      EXPECT_EQ(report.solver, method);
      EXPECT_TRUE(report.linear_converged);
    }
    ends.push_back(state);
  }
  for (std::size_t i = 0; i < ends[0].positions.size(); ++i) {
    EXPECT_LT((ends[0].positions[i] - ends[1].positions[i]).norm(), 1e-8);
  }
}

TEST(BackwardEuler, AStateThatIsNotFiniteIsNotAcceptedAndNotTouched) {
  Cloth cloth(square(3), linearFabric(), gravity());
  ClothState state = cloth.initialState();
  state.velocities[5].x() = std::numeric_limits<double>::infinity();
  const ClothState before = state;
  Integrator integrator(cloth, {});
  EXPECT_FALSE(integrator.step(cloth, state, 0.01).accepted);
  EXPECT_EQ(state.positions, before.positions);
  EXPECT_EQ(state.velocities, before.velocities);
  EXPECT_EQ(state.time, before.time);
  state.velocities[5].setZero();  // and the integrator goes on
  EXPECT_TRUE(integrator.step(cloth, state, 0.01).accepted);
}

TEST(BackwardEuler, RefusesBadStepsAndSettings) {
  Cloth cloth(square(2), linearFabric(), {});
  ClothState state = cloth.initialState();
  Integrator integrator(cloth, {});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (double h : {0.0, -0.1, nan, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(integrator.step(cloth, state, h), std::invalid_argument);
  }
  ClothState other = state;
  other.velocities.pop_back();
  EXPECT_THROW(integrator.step(cloth, other, 0.01), std::invalid_argument);
  StepSettings settings;
  for (double tolerance : {0.0, 1.0, -1.0, nan}) {
    settings.tolerance = tolerance;
    EXPECT_THROW(Integrator(cloth, settings), std::invalid_argument);
  }
  settings = {};
  settings.newton_tolerance = nan;
  EXPECT_THROW(Integrator(cloth, settings), std::invalid_argument);
  const Cloth coarser(mesh::makeRectangle(0.1, 0.1, 2, 1, mesh::Triangulation::kOneWay),
                      linearFabric(), {});
  Integrator other_integrator(coarser, {});
  EXPECT_THROW(other_integrator.step(cloth, state, 0.01), std::invalid_argument);
  settings = {};
  settings.newton_iterations = 0;
  EXPECT_THROW(Integrator(cloth, settings), std::invalid_argument);
  for (int threads : {-1, 0, kMaxThreads + 1}) {
    settings = {};
    settings.threads = threads;
    EXPECT_THROW(Integrator(cloth, settings), std::invalid_argument);
  }
  EXPECT_EQ(state.time, 0.0);
}

TEST(BackwardEuler, ThreadsDoNotChangeTheMotion) {
  std::vector<ClothState> ends;
  for (int threads : {1, 2, 3}) {
    // Large enough for the work to be shared.
    Cloth cloth(square(70, 0.5), stiffeningFabric(), gravity());
    StepSettings settings;
    settings.threads = threads;
    Integrator integrator(cloth, settings);
    ClothState state = randomState(cloth, 1e-4, 0.1);
    for (int i = 0; i < 4; ++i) {
      EXPECT_TRUE(integrator.step(cloth, state, 0.0125).linear_converged);
    }
    ends.push_back(state);
  }
  for (int run : {1, 2}) {
    EXPECT_EQ(ends[run].positions, ends[0].positions);
    EXPECT_EQ(ends[run].velocities, ends[0].velocities);
  }
}

TEST(BackwardEuler, DocumentedDefaultsHold) {
  const StepSettings settings;
  EXPECT_EQ(settings.method, IntegrationMethod::kBackwardEuler);
  EXPECT_EQ(settings.solver, linear::LinearSolverMethod::kAutomatic);
  EXPECT_EQ(settings.tolerance, 1e-6);
  EXPECT_EQ(settings.newton_iterations, 1);
  EXPECT_EQ(settings.newton_tolerance, 1e-8);
  EXPECT_EQ(settings.threads, 1);
}

}  // namespace
}  // namespace haptex::cloth::test_backward_euler
