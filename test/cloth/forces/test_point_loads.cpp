#include <gtest/gtest.h>

#include <limits>

#include "../../refusal.h"
#include "fixtures.h"
#include "force_fixtures.h"
#include "haptex/cloth/dynamics/integrator.h"

namespace haptex::cloth::test_point_loads {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Stiff across a random direction of a plane and soft along it, as a fingertip is.
PointLoad load(int triangle, double stiffness = 300.0) {
  const Vector3d normal = Vector3d(3.0, 1.0, -2.0).normalized();
  PointLoad result;
  result.triangle = triangle;
  result.weights = {0.2, 0.5, 0.3};
  result.position = {0.01, 0.02, -0.05};
  result.force = {0.3, -0.1, 0.2};
  result.stiffness = stiffness * (normal * normal.transpose() + 0.1 * Matrix3d::Identity());
  return result;
}

Vector3d pointOf(const Cloth& cloth, const PointLoad& load, const Positions& positions) {
  Vector3d point = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    point += load.weights[i] * positions[cloth.mesh().triangles[load.triangle][i]];
  }
  return point;
}

void attachTop(Cloth& cloth) {
  for (int particle : mesh::sideParticles(cloth.mesh(), mesh::Side::kTop)) {
    AttachmentPath path;
    path.start = cloth.mesh().initial_positions[particle];
    cloth.attach(particle, path);
  }
}

ModelledEffects loadedEffects() {
  ModelledEffects effects;
  effects.point_loads = true;
  return effects;
}

Cloth hangingCloth(int cells = 4) {
  ModelledEffects effects = loadedEffects();
  effects.gravity = {0.0, 0.0, -9.81};
  Cloth cloth(square(cells), linearFabric(), effects);
  attachTop(cloth);
  return cloth;
}

TEST(PointLoads, WithoutStiffnessAreExternalForcesOnTheCorners) {
  for (int newton_iterations : {1, 20}) {
    Cloth loaded = hangingCloth();
    Cloth pushed = hangingCloth();
    PointLoad push = load(5);
    push.stiffness.setZero();
    push.force *= 0.01;
    loaded.setPointLoads({push, push});
    for (int i = 0; i < 3; ++i) {
      pushed.setExternalForce(pushed.mesh().triangles[5][i], 2.0 * push.weights[i] * push.force);
    }
    StepSettings settings;
    settings.newton_iterations = newton_iterations;
    settings.tolerance = 1e-12;
    ClothState a = loaded.initialState(), b = pushed.initialState();
    Integrator stepper_a(loaded, settings), stepper_b(pushed, settings);
    for (int i = 0; i < 20; ++i) {
      stepper_a.step(loaded, a, 0.01);
      stepper_b.step(pushed, b, 0.01);
    }
    std::vector<Vector3d> forces_a, forces_b;
    loaded.computeForces(a, forces_a);
    pushed.computeForces(a, forces_b);
    for (std::size_t i = 0; i < loaded.particleCount(); ++i) {
      EXPECT_LT((a.positions[i] - b.positions[i]).norm(), 1e-9);
      EXPECT_LT((forces_a[i] - forces_b[i]).norm(), 1e-14);
    }
  }
}

TEST(PointLoads, ForceIsTheGradientOfTheEnergyAndTheJacobianThatOfTheForce) {
  Cloth cloth(square(3), linearFabric(), loadedEffects());
  ClothState state = randomState(cloth, 0.002, 0.0);
  std::vector<int> all(cloth.particleCount());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  // Differences to the unloaded cloth leave what the loads do: exactly quadratic in the positions,
  // so that central differences are exact but for rounding.
  const std::vector<JacobianBlock> bare = cloth.jacobian(state, all);
  std::vector<Vector3d> bare_forces, forces, beyond, before;
  const auto load_energy = [&](const ClothState& at) {
    return cloth.forces().find<PointLoads>()->energy(at.ofForces());
  };
  const auto load_forces = [&](const ClothState& at, std::vector<Vector3d>& result) {
    result.assign(cloth.particleCount(), Vector3d::Zero());
    cloth.forces().find<PointLoads>()->addForces(at.ofForces(), result);
  };
  cloth.computeForces(state, bare_forces);
  const double bare_energy = cloth.potentialEnergy(state);
  cloth.setPointLoads({load(0), load(1), load(11, 50.0)});
  cloth.computeForces(state, forces);
  load_forces(state, beyond);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_LT((forces[i] - bare_forces[i] - beyond[i]).norm(), 1e-12);
  }
  EXPECT_NEAR(cloth.potentialEnergy(state) - bare_energy, load_energy(state), 1e-12);

  const std::vector<JacobianBlock> loaded = cloth.jacobian(state, all);
  ASSERT_EQ(loaded.size(), bare.size());
  Eigen::MatrixXd exact = Eigen::MatrixXd::Zero(3 * all.size(), 3 * all.size());
  for (std::size_t i = 0; i < loaded.size(); ++i) {
    exact.block<3, 3>(3 * loaded[i].row, 3 * loaded[i].column) =
        loaded[i].by_position - bare[i].by_position;
    EXPECT_EQ(loaded[i].by_velocity, bare[i].by_velocity);
  }
  EXPECT_GT(exact.norm(), 100.0);  // there is something to compare
  const double step = 1e-3;
  const std::vector<Vector3d> here = beyond;
  for (std::size_t particle = 0; particle < all.size(); ++particle) {
    for (int axis = 0; axis < 3; ++axis) {
      ClothState moved = state;
      moved.positions[particle][axis] += step;
      load_forces(moved, beyond);
      const double energy_beyond = load_energy(moved);
      moved.positions[particle][axis] -= 2.0 * step;
      load_forces(moved, before);
      const double slope = (energy_beyond - load_energy(moved)) / (2.0 * step);
      EXPECT_NEAR(here[particle][axis], -slope, 1e-10);
      for (std::size_t i = 0; i < all.size(); ++i) {
        const Vector3d column = (beyond[i] - before[i]) / (2.0 * step);
        EXPECT_LT((column - exact.block<3, 1>(3 * i, 3 * particle + axis)).norm(), 1e-10);
      }
    }
  }
}

TEST(PointLoads, HoldAClothWhereTheirForceIsItsWeight) {
  Cloth cloth = hangingCloth();
  cloth.releaseAll();  // held by the loads alone
  std::vector<PointLoad> loads;
  for (int triangle : {25, 28, 31}) {
    PointLoad hold = load(triangle);
    hold.position = pointOf(cloth, hold, cloth.mesh().initial_positions);
    hold.force.setZero();
    loads.push_back(hold);
  }
  cloth.setPointLoads(loads);
  ClothState state = cloth.initialState();
  Integrator integrator(cloth, {});
  for (int i = 0; i < 3000; ++i) integrator.step(cloth, state, 0.04);
  Vector3d sum = Vector3d::Zero();
  for (const PointLoad& hold : loads) {
    sum += hold.force - hold.stiffness * (pointOf(cloth, hold, state.positions) - hold.position);
  }
  // Weight 9.81 mN; what is left is the pendulum's decay.
  EXPECT_LT((sum - Vector3d(0.0, 0.0, 0.1 * 0.01 * 9.81)).norm(), 1e-9);
  std::vector<Vector3d> forces;
  cloth.computeForces(state, forces);
  for (const Vector3d& force : forces) EXPECT_LT(force.norm(), 1e-9);
}

TEST(PointLoads, StayStableHoweverStiffTheyAre) {
  // 1e5 N/m on particles of 1.6e-5 kg: explicitly stable below 0.03 ms only.
  for (double h : {0.04, 0.001}) {
    Cloth cloth = hangingCloth(8);
    PointLoad press = load(60);
    press.stiffness = 1e5 * Matrix3d::Identity();
    press.position =
        pointOf(cloth, press, cloth.mesh().initial_positions) + Vector3d(0.005, 0.0, 0.0);
    press.force = {0.02, 0.0, 0.0};
    cloth.setPointLoads({press});
    ClothState state = cloth.initialState();
    Integrator integrator(cloth, {});
    double fastest = 0.0;
    for (int i = 0; i < 800; ++i) {
      const StepReport report = integrator.step(cloth, state, h);
      ASSERT_TRUE(report.accepted);
      EXPECT_TRUE(report.linear_converged);
      fastest = 0.0;
      for (const Vector3d& velocity : state.velocities) {
        fastest = std::max(fastest, velocity.norm());
      }
    }
    // At rest, or at 1 ms, which damps little, still swinging from the 5 mm jump.
    EXPECT_LT(fastest, h == 0.04 ? 1e-9 : 0.5);
    // The fabric pulls back with some 10 mN, which moves the point by 0.1 um.
    EXPECT_LT((pointOf(cloth, press, state.positions) - press.position).norm(), 1e-5);
  }
}

TEST(PointLoads, TheStepIsTheLinearisationOfTheLoad) {
  // A load on a free triangle without stress: (M + h^2 w w^T K) dv = h w (f - K (x + h v - p)).
  Cloth cloth(mesh::makeRectangle(0.1, 0.1, 1, 1, mesh::Triangulation::kOneWay), linearFabric(),
              loadedEffects());
  const PointLoad press = load(1);
  cloth.setPointLoads({press});
  material::Fabric limp = linearFabric();
  limp.weft.elastic = limp.warp.elastic = limp.shear.elastic =
      material::StrainStressCurve::linear(0.0);
  cloth.setFabric(limp);
  const ClothState begin = randomState(cloth, 0.0, 0.3);
  const double h = 0.02;
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(12, 3);
  for (int i = 0; i < 3; ++i) {
    weights.block<3, 3>(3 * cloth.mesh().triangles[1][i], 0) =
        press.weights[i] * Matrix3d::Identity();
  }
  Eigen::VectorXd position(12), velocity(12), mass(12);
  for (int i = 0; i < 4; ++i) {
    position.segment<3>(3 * i) = begin.positions[i];
    velocity.segment<3>(3 * i) = begin.velocities[i];
    mass.segment<3>(3 * i).setConstant(cloth.masses()[i]);
  }
  Eigen::MatrixXd matrix = h * h * weights * press.stiffness * weights.transpose();
  matrix.diagonal() += mass;
  const Vector3d ahead = weights.transpose() * (position + h * velocity);
  const Eigen::VectorXd change =
      matrix.llt().solve(h * weights * (press.force - press.stiffness * (ahead - press.position)));
  for (int newton_iterations : {1, 10}) {  // a linear system: Newton has nothing to add
    StepSettings settings;
    settings.tolerance = 1e-12;
    settings.newton_iterations = newton_iterations;
    ClothState end = begin;
    const StepReport report = Integrator(cloth, settings).step(cloth, end, h);
    EXPECT_TRUE(report.newton_converged);
    for (int i = 0; i < 4; ++i) {
      EXPECT_LT((end.velocities[i] - begin.velocities[i] - change.segment<3>(3 * i)).norm(),
                1e-9 * change.norm());
    }
  }
}

TEST(PointLoads, NewtonFindsTheMinimumWithThem) {
  ModelledEffects effects;
  effects.viscosity = effects.point_loads = true;
  Cloth cloth(square(5), stiffeningFabric(), effects);
  attachTop(cloth);
  PointLoad press = load(20, 2000.0);
  cloth.setPointLoads({press});
  ClothState state = randomState(cloth, 0.001, 1.0);
  StepSettings settings;
  settings.newton_iterations = 200;  // it takes about 100
  settings.tolerance = 1e-10;
  const StepReport report = Integrator(cloth, settings).step(cloth, state, 0.01);
  EXPECT_TRUE(report.newton_converged);
  EXPECT_LE(report.newton_residual, 1e-8);
}

TEST(PointLoads, DoNotMoveAttachedParticles) {
  Cloth cloth = hangingCloth();
  PointLoad pull = load(31);
  const int particle = cloth.mesh().triangles[31][2];
  ASSERT_TRUE(cloth.isAttached(particle));
  pull.weights = {0.0, 0.0, 1.0};
  cloth.setPointLoads({pull});
  ClothState state = cloth.initialState();
  Integrator(cloth, {}).step(cloth, state, 0.01);
  EXPECT_EQ(state.positions[particle], cloth.mesh().initial_positions[particle]);
}

std::string refusal(Cloth& cloth, const std::vector<PointLoad>& loads) {
  return test::refusalOf([&] { cloth.setPointLoads(loads); });
}

TEST(PointLoads, AreRefusedByIndexAndReasonAndThenTheOldOnesStay) {
  Cloth cloth(square(2), linearFabric(), loadedEffects());
  cloth.setPointLoads({load(3)});
  const auto expect_refused = [&](const PointLoad& bad, const std::string& expected) {
    const std::string message = refusal(cloth, {load(0), bad});
    EXPECT_NE(message.find("point load 1: " + expected), std::string::npos) << message;
    ASSERT_EQ(loadsOf(cloth).size(), 1u);
    EXPECT_EQ(loadsOf(cloth)[0].triangle, 3);
  };
  expect_refused(load(8), "triangle 8 does not exist; the cloth has triangles 0 to 7");
  expect_refused(load(-1), "triangle -1 does not exist");
  for (double number : {kNaN, std::numeric_limits<double>::infinity()}) {
    for (int what = 0; what < 4; ++what) {
      PointLoad bad = load(0);
      (what == 0   ? bad.weights[1]
       : what == 1 ? bad.position[2]
       : what == 2 ? bad.force[0]
                   : bad.stiffness(2, 1)) = number;
      expect_refused(bad, "a number of its weights");
    }
  }
  PointLoad bad = load(0);
  bad.weights[0] += 2e-6;
  expect_refused(bad, "the weights sum to 1");
  bad = load(0);
  bad.stiffness(0, 1) += 1.0;
  expect_refused(bad, "the stiffness differs from its transpose");
  bad = load(0);
  bad.stiffness = Vector3d(100.0, -0.1, 0.0).asDiagonal();
  expect_refused(bad, "the stiffness has the eigenvalue -0.1");
  bad.stiffness = Vector3d(100.0, 100.0, 0.0).asDiagonal();
  bad.stiffness(0, 1) = bad.stiffness(1, 0) = 101.0;  // no negative diagonal, but indefinite
  expect_refused(bad, "the stiffness has the eigenvalue -1");
  const std::string message = refusal(cloth, std::vector<PointLoad>(PointLoads::kMax + 1, load(0)));
  EXPECT_EQ(message, "there are 4097 point loads; allowed are 4096");
  EXPECT_EQ(loadsOf(cloth).size(), 1u);
  EXPECT_EQ(refusal(cloth, std::vector<PointLoad>(PointLoads::kMax, load(0))), test::kNotRefused);
  EXPECT_EQ(refusal(cloth, {}), test::kNotRefused);
  EXPECT_TRUE(loadsOf(cloth).empty());
}

TEST(PointLoads, AreRefusedWhereNoneAreModelled) {
  Cloth cloth(square(4), linearFabric(), {});
  EXPECT_EQ(refusal(cloth, {load(0)}),
            "the cloth is modelled without point loads; none can be set");
  EXPECT_EQ(refusal(cloth, {}), test::kNotRefused);
  EXPECT_EQ(cloth.forces().find<PointLoads>(), nullptr);
}

TEST(PointLoads, KeepTheSystemDefiniteWithinTheTolerancesOfTheirStiffness) {
  Cloth cloth = hangingCloth();
  PointLoad press = load(5);
  // An eigenvalue of -1e-7 of the norm: h^2 times it is 160 times a particle's mass.
  press.stiffness = Vector3d(1e8, 1e8, -10.0).asDiagonal();
  press.position = pointOf(cloth, press, cloth.mesh().initial_positions);
  cloth.setPointLoads({press});
  ClothState state = cloth.initialState();
  StepSettings settings;
  settings.solver = linear::LinearSolverMethod::kCholesky;
  EXPECT_TRUE(Integrator(cloth, settings).step(cloth, state, 0.04).accepted);
}

}  // namespace
}  // namespace haptex::cloth::test_point_loads
