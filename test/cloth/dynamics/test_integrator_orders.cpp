// With which order every integrator converges.
#include <gtest/gtest.h>

#include <string>

#include "fixtures.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "integrator_fixtures.h"

namespace haptex::cloth::test_integrator_orders {
namespace {

using Eigen::Vector3d;
using Method = IntegrationMethod;

class OrderOfIntegrator : public testing::TestWithParam<NamedIntegrationMethod> {};
INSTANTIATE_TEST_SUITE_P(Methods, OrderOfIntegrator, testing::ValuesIn(kIntegrationMethods),
                         nameOfIntegrator);

/// A soft cloth in the middle of a motion, one corner of its bar moving, whose fastest vibration is
/// resolved by the steps below.
class SmoothMotion {
 public:
  /// @param stretch at the start, which lasts for a few hundredths of a second
  SmoothMotion(double stretch, bool viscosity, double duration,
               Elasticity elasticity = Elasticity::kGreenLagrange)
      : cloth_(square(2), fabric(), effects(viscosity, elasticity)), duration_(duration) {
    start_ = cloth_.initialState();
    for (std::size_t i = 0; i < cloth_.particleCount(); ++i) {
      Vector3d& position = start_.positions[i];
      const double y = position.y(), z = position.z();
      position = {0.2 * z * (1.0 + y), stretch * y, stretch * z};
      start_.velocities[i] = {2.0 * z - y, 3.0 * z * y, -z};
    }
    for (int particle : mesh::sideParticles(cloth_.mesh(), mesh::Side::kTop)) {
      AttachmentPath path;
      path.start = start_.positions[particle];
      path.duration = 0.2;
      if (particle == 6) path.displacement = {0.01, -0.01, 0.02};
      cloth_.attach(particle, path);
      start_.velocities[particle].setZero();
    }
  }

  /// @param uneven share of the step by which every other one is longer and the rest shorter
  ClothState after(const StepSettings& settings, int steps, double uneven = 0.0) const {
    Integrator integrator(cloth_, settings);
    ClothState state = start_;
    const double h = duration_ / steps;
    for (int i = 0; i < steps; ++i) {
      const StepReport report =
          integrator.step(cloth_, state, h * (i % 2 == 0 ? 1.0 + uneven : 1.0 - uneven));
      EXPECT_TRUE(report.accepted && report.linear_converged);
    }
    return state;
  }

  /// Of the free particles' positions and velocities, relative to the size and the speed.
  double error(const ClothState& state) const {
    static const StepSettings fine = settingsOf(Method::kRungeKutta4);
    if (exact_.positions.empty())
      exact_ = after(fine, 1 << 12);  // 1/4096 of its error in 512 steps
    double sum = 0.0;
    for (std::size_t i = 0; i < cloth_.particleCount(); ++i) {
      EXPECT_TRUE(!cloth_.isAttached(static_cast<int>(i)) ||
                  (state.positions[i] - exact_.positions[i]).norm() < 1e-12);
      if (cloth_.isAttached(static_cast<int>(i))) continue;
      sum += (state.positions[i] - exact_.positions[i]).squaredNorm() / 0.01;
      sum += (state.velocities[i] - exact_.velocities[i]).squaredNorm();
    }
    return std::sqrt(sum);
  }

  /// How often the error halves when the step does.
  double order(const StepSettings& settings, int steps, double uneven = 0.0) const {
    const double coarse = error(after(settings, steps, uneven));
    const double fine = error(after(settings, 2 * steps, uneven));
    EXPECT_LT(coarse, 0.1);
    EXPECT_GT(fine, 1e-12);  // above rounding
    return std::log2(coarse / fine);
  }

 private:
  static material::Fabric fabric() {
    using material::StrainStressCurve;
    material::Fabric fabric = linearFabric(0.02);
    fabric.weft.elastic = StrainStressCurve::linear(2.0);
    fabric.warp.elastic = StrainStressCurve::linear(3.0);
    fabric.shear.elastic = StrainStressCurve::linear(1.0);
    return fabric;
  }
  static ModelledEffects effects(bool viscosity, Elasticity elasticity) {
    ModelledEffects effects;
    effects.elasticity = elasticity;
    effects.viscosity = viscosity;
    effects.gravity = {0.0, 0.0, -9.81};
    effects.air = Air();
    if (!viscosity) effects.air->coefficients.lift = 0.0;  // of which one solve projects a part
    effects.air->wind.mean = {2.0, 0.5, 0.0};  // always from the same side: |m| m has a kink at 0
    effects.air->wind.gusts = {{{0.3, 0.2, 0.0}, 5.0, 1.0}};
    return effects;
  }

  Cloth cloth_;
  double duration_;  // s
  ClothState start_;
  mutable ClothState exact_;
};

double orderOf(Method method) {
  switch (method) {
    case Method::kRungeKutta4:
      return 4.0;
    case Method::kBackwardEuler:
    case Method::kExplicitEuler:
    case Method::kTwoStepEuler:
      return 1.0;
    default:
      return 2.0;
  }
}

// Over halvings of the steps below the measured orders change by less than the tolerance, which is
// what terms of higher order still contribute there.
constexpr int kSteps = 256;
constexpr double kOrderTolerance = 0.05;

TEST_P(OrderOfIntegrator, ConvergesWithItsOrderInOneSolvePerStageInElasticTension) {
  const SmoothMotion motion(1.2, false, 0.005);
  const Method method = GetParam().method;
  EXPECT_NEAR(motion.order(settingsOf(method), kSteps / 4), orderOf(method), kOrderTolerance);
}

// What the projection and the derivative of the strain rate by the position would add to the linear
// systems is left out of them, which is of the first order in one solve and of the second in two.
class OrderInTwoSolves : public OrderOfIntegrator {};
INSTANTIATE_TEST_SUITE_P(Methods, OrderInTwoSolves, testing::ValuesIn(kIntegrationMethods),
                         nameOfIntegrator);

TEST_P(OrderInTwoSolves, ConvergesWithItsOrderUnderViscosity) {
  const SmoothMotion motion(1.1, true, 0.1);
  const Method method = GetParam().method;
  EXPECT_NEAR(motion.order(settingsOf(method, 2), kSteps), orderOf(method), kOrderTolerance);
}

TEST_P(OrderInTwoSolves, ConvergesWithItsOrderInCompression) {
  const SmoothMotion motion(0.8, true, 0.1);
  const Method method = GetParam().method;
  EXPECT_NEAR(motion.order(settingsOf(method, 2), kSteps), orderOf(method), kOrderTolerance);
}

TEST_P(OrderInTwoSolves, ConvergesWithItsOrderForUnevenSteps) {
  const SmoothMotion motion(1.1, true, 0.1);
  const Method method = GetParam().method;
  EXPECT_NEAR(motion.order(settingsOf(method, 2), kSteps, 0.3), orderOf(method), kOrderTolerance);
}

TEST_P(OrderInTwoSolves, ConvergesWithItsOrderWhereMoreSolvesAreAllowed) {
  const SmoothMotion motion(1.1, true, 0.1);
  const Method method = GetParam().method;
  EXPECT_NEAR(motion.order(settingsOf(method, 20), kSteps), orderOf(method), kOrderTolerance);
}

class OrderOfOtherModels
    : public testing::TestWithParam<std::tuple<NamedIntegrationMethod, Elasticity>> {};
INSTANTIATE_TEST_SUITE_P(Methods, OrderOfOtherModels,
                         testing::Combine(testing::ValuesIn(kIntegrationMethods),
                                          testing::Values(Elasticity::kBilinear,
                                                          Elasticity::kMassSpring,
                                                          Elasticity::kCorotational)));

TEST_P(OrderOfOtherModels, ConvergesWithItsOrder) {
  // Runge-Kutta is 0.051 off on springs: twice the steps are already near its rounding.
  constexpr double kOtherTolerance = 0.1;
  const auto [named, elasticity] = GetParam();
  for (double stretch : {0.8, 1.1}) {
    const SmoothMotion motion(stretch, true, 0.1, elasticity);
    EXPECT_NEAR(motion.order(settingsOf(named.method, 2), kSteps), orderOf(named.method),
                kOtherTolerance);
  }
}

// ---- Attachments, momentum, energy.

}  // namespace
}  // namespace haptex::cloth::test_integrator_orders
