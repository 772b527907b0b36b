// What all integrators have in common, and what tells them apart. Backward Euler has tests of its
// own in test_backward_euler.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <map>

#include "fixtures.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "integrator_fixtures.h"

namespace haptex::cloth::test_integrators {
namespace {

using Eigen::Vector3d;
using Complex = std::complex<double>;
using Method = IntegrationMethod;

void attachTop(Cloth& cloth) {
  for (int particle : mesh::sideParticles(cloth.mesh(), mesh::Side::kTop)) {
    AttachmentPath path;
    path.start = cloth.mesh().initial_positions[particle];
    cloth.attach(particle, path);
  }
}

class EveryIntegrator : public testing::TestWithParam<NamedIntegrationMethod> {};
INSTANTIATE_TEST_SUITE_P(Methods, EveryIntegrator, testing::ValuesIn(kIntegrationMethods),
                         nameOfIntegrator);

// ---- The harmonic oscillator: every particle on a spring of its own, moving as one, so that the
// membrane has nothing to resist. With y = omega x + i v it is y' = -i omega y.

constexpr double kOmega = 2.0 * M_PI;  // 1 Hz

ModelledEffects loadedEffects() {
  ModelledEffects effects;
  effects.point_loads = true;
  return effects;
}

class Oscillator {
 public:
  explicit Oscillator(Method method)
      : cloth_(square(1), limpFabric(), loadedEffects()),
        state_(cloth_.initialState()),
        integrator_(cloth_, settingsOf(method)) {
    std::vector<PointLoad> springs;
    for (int i = 0; i < static_cast<int>(cloth_.particleCount()); ++i) {
      PointLoad spring{triangleOf(i), Vector3d::Zero(), state_.positions[i], Vector3d::Zero(),
                       cloth_.masses()[i] * kOmega * kOmega * Eigen::Matrix3d::Identity()};
      for (int corner = 0; corner < 3; ++corner) {
        spring.weights[corner] = cloth_.mesh().triangles[spring.triangle][corner] == i;
      }
      springs.push_back(spring);
      state_.positions[i].x() += kAmplitude;
    }
    cloth_.setPointLoads(springs);
  }

  StepReport step(double h) { return integrator_.step(cloth_, state_, h); }
  /// y over its value at the start, which is real.
  Complex amplitude() const {
    const double x = state_.positions[0].x() - cloth_.mesh().initial_positions[0].x();
    return Complex(x, state_.velocities[0].x() / kOmega) / kAmplitude;
  }
  double energy() const {
    return (cloth_.potentialEnergy(state_) + cloth_.kineticEnergy(state_)) /
           (0.5 * 0.1 * 0.01 * kOmega * kOmega * kAmplitude * kAmplitude);
  }

 private:
  static constexpr double kAmplitude = 0.02;  // m
  static material::Fabric limpFabric() {      // rounding must not make explicit steps unstable
    material::Fabric fabric;
    fabric.areal_density = 0.1;
    return fabric;
  }
  int triangleOf(int particle) const {
    for (std::size_t t = 0; t < cloth_.mesh().triangles.size(); ++t) {
      for (int corner : cloth_.mesh().triangles[t]) {
        if (corner == particle) return static_cast<int>(t);
      }
    }
    return -1;
  }

  Cloth cloth_;
  ClothState state_;
  Integrator integrator_;
};

/// The methods on y' = z y over one unit of time; BDF-2 remembers.
class ScalarMethod {
 public:
  explicit ScalarMethod(Method method) : method_(method) {}

  Complex step(Complex y, double h) {
    const Complex z = Complex(0.0, -kOmega * h);
    switch (method_) {
      case Method::kBackwardEuler:
        return y / (1.0 - z);
      case Method::kBackwardMidpoint:
        return y * (1.0 + 0.5 * z) / (1.0 - 0.5 * z);
      case Method::kTrBdf2:
        return trBdf2(y, z);
      case Method::kBdf2:
        return bdf2(y, z, h);
      case Method::kExplicitEuler:
        return y * (1.0 + z);
      case Method::kExplicitMidpoint:
        return y * (1.0 + z + z * z / 2.0);
      case Method::kRungeKutta4:
        return y * (1.0 + z + z * z / 2.0 + z * z * z / 6.0 + z * z * z * z / 24.0);
      case Method::kTwoStepEuler: {
        const double v = y.imag() - kOmega * h * y.real();
        return {y.real() + kOmega * h * v, v};
      }
    }
    return 0.0;
  }

 private:
  static Complex trBdf2(Complex y, Complex z) {
    const double gamma = 2.0 - std::sqrt(2.0);
    const Complex middle = y * (1.0 + 0.5 * gamma * z) / (1.0 - 0.5 * gamma * z);
    const double share = 1.0 - gamma;
    return (middle / gamma - share * share / gamma * y) / (2.0 - gamma - share * z);
  }
  Complex bdf2(Complex y, Complex z, double h) {
    const double ratio = last_step_ > 0.0 ? h / last_step_ : 10.0;
    const double divisor = 1.0 + 2.0 * ratio;
    const Complex next = ratio > 2.0
                             ? trBdf2(y, z)
                             : ((1.0 + ratio) * (1.0 + ratio) * y - ratio * ratio * before_) /
                                   (divisor - (1.0 + ratio) * z);
    before_ = y;
    last_step_ = h;
    return next;
  }

  Method method_;
  double last_step_ = 0.0;
  Complex before_;
};

TEST_P(EveryIntegrator, MovesAnOscillatorAsItsStabilityFunctionSaysForNonUniformSteps) {
  Oscillator oscillator(GetParam().method);
  ScalarMethod scalar(GetParam().method);
  Complex exact = 1.0;
  // The fourth step is more than twice the third.
  for (double h : {0.0125, 0.02, 0.005, 0.05, 0.04, 0.07, 0.001, 0.002, 0.0035}) {
    oscillator.step(h);
    exact = scalar.step(exact, h);
    EXPECT_LT(std::abs(oscillator.amplitude() - exact), 1e-10) << h;  // of the linear solves
  }
}

TEST_P(EveryIntegrator, KeepsOfTheEnergyOfA1HzOscillatorPerPeriodWhatItsTheorySays) {
  Oscillator oscillator(GetParam().method);
  ScalarMethod scalar(GetParam().method);
  Complex exact = 1.0;
  for (int i = 0; i < 80; ++i) {
    oscillator.step(0.0125);
    exact = scalar.step(exact, 0.0125);
  }
  EXPECT_NEAR(oscillator.energy(), std::norm(exact), 1e-9);
  const std::map<Method, double> stated = {
      {Method::kBackwardEuler, 0.6115},     // (1 + (omega h)^2)^-80
      {Method::kBackwardMidpoint, 1.0},     // |1 + i a| = |1 - i a|
      {Method::kBdf2, 0.9985},              // 1 - 80 (omega h)^4 / 2
      {Method::kTrBdf2, 0.9999},            //
      {Method::kExplicitEuler, 1.6355},     // (1 + (omega h)^2)^80
      {Method::kExplicitMidpoint, 1.0008},  // 1 + 80 (omega h)^4 / 4
      {Method::kRungeKutta4, 1.0},          // 1 - 80 (omega h)^6 / 72
      {Method::kTwoStepEuler, 1.0},         // symplectic; its period is a little short
  };
  EXPECT_NEAR(oscillator.energy(), stated.at(GetParam().method), 2e-4);
}

// ---- Orders of convergence.
TEST_P(EveryIntegrator, PutsAttachedParticlesExactlyOnTheirPath) {
  ModelledEffects effects;
  effects.gravity = {0.0, 0.0, -9.81};
  effects.viscosity = true;
  material::Fabric soft = linearFabric(0.002);  // stable in explicit steps
  soft.weft.elastic = soft.warp.elastic = material::StrainStressCurve::linear(1.0);
  soft.shear.elastic = material::StrainStressCurve::linear(0.5);
  Cloth cloth(square(3), soft, effects);
  attachTop(cloth);
  AttachmentPath path;
  path.start = cloth.mesh().initial_positions[12];
  path.displacement = {0.02, -0.01, 0.01};
  path.start_time = 0.01;
  path.duration = 0.05;
  cloth.attach(12, path);
  ClothState state = cloth.initialState();
  Integrator integrator(cloth, settingsOf(GetParam().method));
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(integrator.step(cloth, state, i % 3 == 0 ? 2e-4 : 5e-4).accepted);
    ASSERT_EQ(state.positions[12], path.position(state.time));
  }
  EXPECT_LT(state.velocities[12].norm(), 1e-11);  // differences of places over 2e-4 s
}

TEST_P(EveryIntegrator, KeepsTheMomentumOfAFreeCloth) {
  ModelledEffects effects;
  effects.viscosity = true;
  const Cloth cloth(square(3), linearFabric(0.01), effects);
  ClothState state = randomState(cloth, 1e-3, 0.1);
  const Vector3d begin = cloth.momentum(state);
  Integrator integrator(cloth, settingsOf(GetParam().method));
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(integrator.step(cloth, state, 1e-4).accepted);
  EXPECT_LT((cloth.momentum(state) - begin).norm(), 1e-9 * begin.norm());  // of the linear solves
}

TEST(BackwardMidpoint, EnergyNeverGrowsWithoutWork) {
  for (double h : {0.001, 0.0125, 0.1}) {
    ModelledEffects effects;
    effects.gravity = {0.0, 0.0, -9.81};
    Cloth cloth(square(6), stiffeningFabric(), effects);
    attachTop(cloth);
    ClothState state = randomState(cloth, 0.002, 0.5);
    for (int particle : mesh::sideParticles(cloth.mesh(), mesh::Side::kTop)) {
      state.positions[particle] = cloth.mesh().initial_positions[particle];
      state.velocities[particle].setZero();
    }
    Integrator integrator(cloth, settingsOf(Method::kBackwardMidpoint, 30));
    double energy = cloth.potentialEnergy(state) + cloth.kineticEnergy(state);
    int damped = 0;
    for (int i = 0; i < 100; ++i) {
      damped += integrator.step(cloth, state, h).blend > 0.0;
      const double next = cloth.potentialEnergy(state) + cloth.kineticEnergy(state);
      EXPECT_LE(next, energy + 1e-9) << "h " << h << " step " << i;  // energies near 1e-2 J
      energy = next;
    }
    EXPECT_GT(damped, 0) << h;
  }
}

TEST(BackwardMidpoint, DoesNotDampWhatCannotGrow) {
  Oscillator oscillator(Method::kBackwardMidpoint);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(oscillator.step(0.0125).blend, 0.0);
  const Cloth cloth(square(3), linearFabric(), {});  // at rest, moving as a whole
  ClothState state = cloth.initialState();
  for (Vector3d& velocity : state.velocities) velocity = {0.3, 0.2, -0.1};
  Integrator integrator(cloth, settingsOf(Method::kBackwardMidpoint));
  for (int i = 0; i < 100; ++i) EXPECT_EQ(integrator.step(cloth, state, 0.0125).blend, 0.0);
}

// ---- BDF-2 and its past.

TEST(Bdf2, StartsAnewFromAStateThatItDidNotLeave) {
  ModelledEffects effects;
  effects.gravity = {0.0, 0.0, -9.81};
  Cloth cloth(square(3), linearFabric(), effects);
  attachTop(cloth);
  const StepSettings settings = settingsOf(Method::kBdf2);
  const auto step_anew = [&](ClothState from) {
    Integrator(cloth, settings).step(cloth, from, 0.01);
    return from;
  };
  for (int change = 0; change < 4; ++change) {
    ClothState other = cloth.initialState();
    Integrator integrator(cloth, settings);
    for (int i = 0; i < 3; ++i) integrator.step(cloth, other, 0.01);
    if (change == 1) other.positions[0].x() += 1e-6;
    if (change == 2) other.velocities[0].x() += 1e-6;
    if (change == 3) other.time += 1.0;
    const ClothState anew = step_anew(other);
    integrator.step(cloth, other, 0.01);
    EXPECT_EQ(other.positions == anew.positions, change != 0) << change;
    EXPECT_EQ(other.velocities == anew.velocities, change != 0) << change;
  }
}

// ---- What is refused.

TEST_P(EveryIntegrator, AStateThatIsNotFiniteIsNotAcceptedAndNotTouched) {
  const Cloth cloth(square(3), linearFabric(), {});
  ClothState state = cloth.initialState();
  Integrator integrator(cloth, settingsOf(GetParam().method));
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(integrator.step(cloth, state, 1e-3).accepted);
  state.velocities[5].x() = std::numeric_limits<double>::infinity();
  const ClothState before = state;
  EXPECT_FALSE(integrator.step(cloth, state, 1e-3).accepted);
  EXPECT_EQ(state.positions, before.positions);
  EXPECT_EQ(state.velocities, before.velocities);
  EXPECT_EQ(state.time, before.time);
  state.velocities[5].setZero();  // and the integrator goes on
  EXPECT_TRUE(integrator.step(cloth, state, 1e-3).accepted);
}

TEST_P(EveryIntegrator, RefusesBadSteps) {
  const Cloth cloth(square(2), linearFabric(), {});
  ClothState state = cloth.initialState();
  Integrator integrator(cloth, settingsOf(GetParam().method));
  for (double h : {0.0, -0.1, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(integrator.step(cloth, state, h), std::invalid_argument);
  }
  ClothState other = state;
  other.velocities.pop_back();
  EXPECT_THROW(integrator.step(cloth, other, 0.01), std::invalid_argument);
  const Cloth coarser(mesh::makeRectangle(0.1, 0.1, 2, 1, mesh::Triangulation::kOneWay),
                      linearFabric(), {});
  Integrator other_integrator(coarser, settingsOf(GetParam().method));
  EXPECT_THROW(other_integrator.step(cloth, state, 0.01), std::invalid_argument);
  EXPECT_EQ(state.time, 0.0);
}

TEST_P(EveryIntegrator, ReportsWhatItSolved) {
  const Cloth cloth(square(2), linearFabric(), {});
  ClothState state = randomState(cloth, 1e-3, 0.1);
  const StepReport report =
      Integrator(cloth, settingsOf(GetParam().method)).step(cloth, state, 1e-4);
  EXPECT_TRUE(report.accepted && report.linear_converged && report.newton_converged);
  const Method method = GetParam().method;
  const bool two_stages = method == Method::kTrBdf2 || method == Method::kBdf2;  // its first step
  if (method == Method::kBackwardMidpoint) {
    EXPECT_GE(report.newton_iterations, 1);
  } else {
    EXPECT_EQ(report.newton_iterations, isImplicit(method) ? (two_stages ? 2 : 1) : 0);
  }
}

}  // namespace
}  // namespace haptex::cloth::test_integrators
