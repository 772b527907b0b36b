// Steps that end by their error, and rates of strain taken from strains.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "fixtures.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/material/fabric_file.h"
#include "integrator_fixtures.h"

namespace haptex::cloth::test_step_error {
namespace {

using Eigen::Vector3d;

/// Turned about the y axis.
Positions turned(Positions positions, double angle) {
  for (Vector3d& place : positions) place = Eigen::AngleAxisd(angle, Vector3d::UnitY()) * place;
  return positions;
}

double largest(const std::vector<Vector3d>& vectors) {
  double most = 0.0;
  for (const Vector3d& vector : vectors) most = std::max(most, vector.norm());
  return most;
}

/// Let go from 0.5 rad, after steps of 12.5 ms.
struct Swing {
  Swing(IntegrationMethod method, double error, int steps)
      : cloth(square(8), stiffeningFabric(), effects()), state(cloth.initialState()) {
    state.positions = turned(state.positions, -0.5);
    attachTop(cloth, state.positions);
    StepSettings settings = settingsOf(method, 50);
    settings.newton_error = error;
    Integrator integrator(cloth, settings);
    for (int i = 0; i < steps; ++i) {
      const StepReport report = integrator.step(cloth, state, 0.0125);
      converged = converged && report.newton_converged;
      solves += report.newton_iterations;
    }
  }

  static ModelledEffects effects() {
    ModelledEffects effects;
    effects.gravity = {0.0, 0.0, -9.81};
    effects.viscosity = true;
    return effects;
  }

  static void attachTop(Cloth& cloth, const Positions& places) {
    for (int particle : mesh::sideParticles(cloth.mesh(), mesh::Side::kTop)) {
      AttachmentPath path;
      path.start = places[particle];
      cloth.attach(particle, path);
    }
  }

  Cloth cloth;
  ClothState state;
  int solves = 0;
  bool converged = true;
};

TEST(StrainPast, SeesNoRateInARigidMotion) {
  for (const Elasticity elasticity : {Elasticity::kGreenLagrange, Elasticity::kBilinear,
                                      Elasticity::kMassSpring, Elasticity::kCorotational}) {
    ModelledEffects effects;
    effects.viscosity = true;
    effects.elasticity = elasticity;
    const Cloth cloth(square(4), stiffeningFabric(), effects);
    const Positions start = cloth.initialState().positions;
    const Positions before = turned(start, 0.1), middle = turned(start, 0.2);
    StrainPast past{0.01};
    past.add(middle, 4.0 / 3.0);
    past.add(before, -1.0 / 3.0);
    const Positions end = turned(start, 0.3);
    Velocities velocities(end.size());
    for (std::size_t i = 0; i < end.size(); ++i) {
      velocities[i] = (end[i] - 4.0 / 3.0 * middle[i] + 1.0 / 3.0 * before[i]) / 0.01;
    }
    std::vector<Vector3d> forces(end.size(), Vector3d::Zero()), of_velocities = forces;
    ForceState state{end, velocities};
    cloth.forces().addForces(state, of_velocities);
    state.past = &past;
    cloth.forces().addForces(state, forces);
    EXPECT_GT(largest(of_velocities), 1e-6) << static_cast<int>(elasticity);
    EXPECT_LT(largest(forces), 1e-9 * largest(of_velocities)) << static_cast<int>(elasticity);
  }
}

TEST(StepError, EndsNewtonIterationsNearTheConvergedMotion) {
  for (const IntegrationMethod method :
       {IntegrationMethod::kBackwardEuler, IntegrationMethod::kBdf2, IntegrationMethod::kTrBdf2}) {
    const Swing exact(method, 0.0, 20), close(method, 1e-4, 20), rough(method, 1e-2, 20);
    EXPECT_TRUE(close.converged) << nameOf(method);
    EXPECT_LT(close.solves, exact.solves) << nameOf(method);
    EXPECT_LE(rough.solves, close.solves) << nameOf(method);
    double apart = 0.0;
    for (std::size_t i = 0; i < exact.state.positions.size(); ++i) {
      apart = std::max(apart, (exact.state.positions[i] - close.state.positions[i]).norm());
    }
    EXPECT_LT(apart, 1e-5) << nameOf(method);  // m
  }
}

TEST(StepError, IsRefusedOutsideItsRange) {
  const Cloth cloth(square(2), linearFabric(), {});
  for (const double error : {-1e-3, 1.0, std::numeric_limits<double>::quiet_NaN()}) {
    StepSettings settings;
    settings.newton_error = error;
    EXPECT_THROW(Integrator(cloth, settings), std::invalid_argument) << error;
  }
  EXPECT_EQ(StepSettings{}.newton_error, 0.0);
}

/// Cloth that collides with itself is not left short of its error, or its layers hook into each
/// other; but not for ever either.
TEST(StepError, IsSoughtBeyondTheIterationsOfClothThatCollidesWithItself) {
  const material::Fabric wool = material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml");
  for (const bool self_collision : {false, true}) {
    ModelledEffects effects;
    effects.self_collision = self_collision;
    const Cloth cloth(square(8), wool, effects);
    ClothState state = randomState(cloth, 1e-3, 1.0);
    StepSettings settings = settingsOf(IntegrationMethod::kBackwardEuler, 2);
    settings.newton_error = 1e-9;
    const StepReport report = Integrator(cloth, settings).step(cloth, state, 0.0125);
    ASSERT_FALSE(report.taken_anew);
    if (self_collision) {
      EXPECT_GT(report.newton_iterations, 5);
      EXPECT_LE(report.newton_iterations, 42);
    } else {
      EXPECT_EQ(report.newton_iterations, 2);
    }
  }
}

}  // namespace
}  // namespace haptex::cloth::test_step_error
