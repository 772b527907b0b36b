// Hysteresis of stretch and shear: its laws, its forces, and what steps make of its past.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "derivatives.h"
#include "fixtures.h"
#include "force_fixtures.h"
#include "haptex/cloth/forces/membrane_friction.h"
#include "hysteresis_fixtures.h"

namespace haptex::cloth::test_membrane_friction {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180.0;
constexpr material::TensileResilience kResilience{0.5, 0.7};
constexpr material::ShearHysteresis kShear{1.0, 2.0};  // N/m

ModelledEffects hysteresis() {
  ModelledEffects effects;
  effects.membrane_hysteresis = true;
  return effects;
}

material::Fabric withHysteresis(material::Fabric fabric) {
  fabric.resilience = kResilience;
  fabric.shear_hysteresis = kShear;
  return fabric;
}

/// Work (J/m^2) of pulling a curve from rest to a strain, and what comes back.
struct Cycle {
  double work = 0.0, returned = 0.0;
};

Cycle pull(const material::StrainStressCurve& curve, double resilience, double most) {
  const ThreadFriction friction(curve, resilience);
  constexpr int kSteps = 20000;
  Cycle cycle;
  double past = friction.forgotten(0.0), before = 0.0;
  for (int i = 1; i <= 2 * kSteps; ++i) {
    const double strain = most * (i <= kSteps ? i : 2 * kSteps - i) / kSteps;
    const double elastic = 1.0 - ThreadFriction::share(resilience);
    const double stress =
        elastic * curve.evaluate(strain).stress + friction.respond(strain, past).stress;
    (i <= kSteps ? cycle.work : cycle.returned) += 0.5 * (before + stress) * most / kSteps;
    if (i <= kSteps) {
      EXPECT_NEAR(stress, curve.evaluate(strain).stress, 1e-9 * curve.evaluate(most).stress);
    }
    before = stress;
    past = friction.follow(strain, past);
  }
  return cycle;
}

// Whatever the curve and the largest strain are, and on the way there the stress is the curve's.
TEST(FrictionLaws, ThreadsReturnTheResilienceOfTheWorkOfTheirCurve) {
  const material::Fabric stiffening = stiffeningFabric();
  for (const double resilience : {0.1, 0.4, 0.65, 0.95, 1.0}) {
    for (const auto& curve : {material::StrainStressCurve::linear(100.0), stiffening.weft.elastic,
                              stiffening.warp.elastic}) {
      for (const double most : {1e-3, 0.02, 0.3}) {
        const Cycle cycle = pull(curve, resilience, most);
        EXPECT_NEAR(cycle.work, curve.energy(most), 1e-6 * cycle.work);
        EXPECT_NEAR(cycle.returned, resilience * cycle.work, 1e-3 * cycle.work);
      }
    }
  }
}

TEST(FrictionLaws, ThreadsMeetNoneWhereTheyAreCompressed) {
  const ThreadFriction friction(material::StrainStressCurve::linear(100.0), 0.5);
  // With the membrane's share of it the curve's stress, whatever was before.
  const double share = ThreadFriction::share(0.5);
  for (const double past : {friction.forgotten(0.0), friction.forgotten(0.1)}) {
    EXPECT_NEAR(friction.respond(-0.05, past).stress, share * -5.0, 1e-12);
    EXPECT_NEAR(friction.respond(-0.05, past).tangent, share * 100.0, 1e-12);
  }
  // Slack, they forget what was: pulled again, they meet their curve.
  const double past = friction.follow(-0.01, friction.forgotten(0.1));
  EXPECT_NEAR(friction.respond(0.01, past).stress, share, 1e-12);
}

TEST(FrictionLaws, TheLoopOfShearHasTheWidthsOfTheFile) {
  for (const material::ShearHysteresis& widths :
       {kShear, material::ShearHysteresis{3.0, 0.5}, material::ShearHysteresis{0.0, 1.0}}) {
    const ShearFriction friction(widths);
    double past = friction.forgotten(0.0);
    const auto shear = [&](double angle) {
      const double strain = std::sin(angle * kDegree);
      const double stress = friction.respond(strain, past).stress;
      past = friction.follow(strain, past);
      return stress;
    };
    shear(8.0);
    const double back_5 = shear(5.0), back_05 = shear(0.5);
    shear(-8.0);
    const double up_05 = shear(0.5), up_5 = shear(5.0);
    EXPECT_NEAR(up_05 - back_05, widths.at_half_degree, 1e-12);
    EXPECT_NEAR(up_5 - back_5, widths.at_five_degrees, 1e-12);
  }
}

/// Calls with strains and pasts of all kinds.
template <typename Law, typename Check>
void forRandomStates(const Law& law, const Check& check) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> strain(-0.12, 0.15), change(-0.02, 0.02);
  for (int i = 0; i < 2000; ++i) {
    const double before = strain(random);
    check(before + (i % 2 == 0 ? change(random) : strain(random)), law.forgotten(before));
  }
}

template <typename Law>
void expectExactAndDissipative(const Law& law) {
  int yielding = 0;
  forRandomStates(law, [&](double strain, double past) {
    const FrictionResponse at = law.respond(strain, past);
    constexpr double kStep = 1e-7;
    const FrictionResponse above = law.respond(strain + kStep, past);
    const FrictionResponse below = law.respond(strain - kStep, past);
    EXPECT_NEAR((above.energy - below.energy) / (2.0 * kStep), at.stress, 1e-5);
    // But where the slope jumps within the difference.
    const bool smooth = std::abs(above.tangent - below.tangent) < 1.0;
    const double slope = (above.stress - below.stress) / (2.0 * kStep);
    if (smooth) {
      EXPECT_NEAR(slope, at.tangent, 2e-2);
    }
    EXPECT_GE(at.secant, 0.0);
    EXPECT_GE(at.energy, -1e-15);
    const double followed = law.follow(strain, past);
    yielding += followed != past;
    const FrictionResponse after = law.respond(strain, followed);
    EXPECT_LE(after.energy, at.energy + 1e-15);
    EXPECT_NEAR(after.stress, at.stress, 1e-12 * (1.0 + std::abs(at.stress)));
  });
  EXPECT_GT(yielding, 100);
}

TEST(FrictionLaws, AreTheSlopesOfTheirEnergiesAndTakeEnergyOut) {
  expectExactAndDissipative(ThreadFriction(stiffeningFabric().weft.elastic, 0.4));
  expectExactAndDissipative(ThreadFriction(material::StrainStressCurve::linear(100.0), 0.8));
  expectExactAndDissipative(ShearFriction(kShear));
  expectExactAndDissipative(ShearFriction({2.0, 0.3}));
}

TEST(FrictionLaws, LetNaNThrough) {
  const double nan = std::nan("");
  const ThreadFriction threads(material::StrainStressCurve::linear(100.0), 0.5);
  EXPECT_TRUE(std::isnan(threads.respond(nan, 1.0).stress));
  EXPECT_TRUE(std::isnan(threads.respond(nan, 1.0).energy));
  EXPECT_TRUE(std::isnan(ShearFriction(kShear).respond(nan, 0.0).stress));
  EXPECT_TRUE(std::isnan(ShearFriction(kShear).respond(nan, 0.0).energy));
}

/// Stretched at random, moved on from there by less, so that some of it yields and some does not.
ClothState yieldingState(const Cloth& cloth) {
  ClothState state = randomState(cloth, 2e-3, 0.0);
  for (Vector3d& place : state.positions) place *= 1.05;
  cloth.forget(state);
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0.0, 1e-4);
  for (Vector3d& place : state.positions) {
    place += Vector3d(normal(random), normal(random), normal(random));
  }
  return state;
}

TEST(MembraneFriction, ForceIsTheGradientOfTheEnergyAndTheJacobianThatOfTheForce) {
  const Cloth cloth(square(4), withHysteresis(linearFabric()), hysteresis());
  const ClothState state = yieldingState(cloth);
  const int yielding = yieldingIn(cloth, state);
  ASSERT_GT(yielding, 10);
  ASSERT_LT(yielding, static_cast<int>(state.memory.size()) - 10);
  expectExactDerivatives(cloth, state, {0, 7, 12});
}

TEST(MembraneFriction, AddsNothingIndefiniteToAStep) {
  const Cloth cloth(square(3), withHysteresis(stiffeningFabric()), hysteresis());
  const auto* friction = cloth.forces().find<MembraneFriction>();
  ASSERT_NE(friction, nullptr);
  ClothState state = yieldingState(cloth);
  state.velocities = randomState(cloth, 0.0, 0.5).velocities;
  std::vector<double> memory(friction->memorySize());
  friction->forget(cloth.initialState().positions, memory.data());
  const ForceState at{state.positions, state.velocities, 0.0, memory.data()};
  linear::BlockVector rhs = linear::BlockVector::Zero(3, cloth.particleCount());
  for (const bool newton : {false, true}) {
    linear::SymmetricBlockMatrix matrix = cloth.pattern();
    matrix.setZero();
    if (newton) {
      friction->assembleNewton(at, nullptr, 0.01, Hessian::kProjected, matrix, rhs);
    } else {
      friction->assembleLinearised(at, {0.01, 0.01}, matrix, rhs);
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(dense(matrix));
    EXPECT_GT(solver.eigenvalues().maxCoeff(), 0.0);
    EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-12 * solver.eigenvalues().maxCoeff());
  }
}

// As if it had been stretched to there from rest: there patches, which have no friction, agree.
TEST(MembraneFriction, WithoutAPastWeftAndWarpExertTheForcesOfTheirCurves) {
  const material::Fabric fabric = withHysteresis(stiffeningFabric());
  const Cloth friction(square(4), fabric, hysteresis()), elastic(square(4), fabric, {});
  ClothState state = randomState(friction, 2e-3, 0.0);
  friction.forget(state);
  ClothState same{state.positions, state.velocities, 0.0, {}};
  std::vector<Vector3d> with, without;
  friction.computeForces(state, with);
  elastic.computeForces(same, without);
  double scale = 0.0;
  for (const Vector3d& force : without) scale = std::max(scale, force.norm());
  for (std::size_t i = 0; i < with.size(); ++i) {
    EXPECT_LT((with[i] - without[i]).norm(), 1e-12 * scale) << i;
  }
}

/// 100 mm x 100 mm, stretched by 6 % and 3 % and sheared, and let go; two corners are held.
struct ReleasedSheet {
  Cloth cloth;
  ClothState state;

  explicit ReleasedSheet(const ModelledEffects& effects = hysteresis())
      : cloth(square(4), withHysteresis(linearFabric()), effects), state(cloth.initialState()) {
    for (Vector3d& place : state.positions) {
      place = Vector3d(0.0, 1.06 * place.y() + 0.05 * place.z(), 1.03 * place.z());
    }
    cloth.remember(state);
    for (const int particle : mesh::sideParticles(cloth.mesh(), mesh::Side::kTop)) {
      cloth.attach(particle, {state.positions[particle], Vector3d::Zero(), 0.0, 0.0});
    }
  }
  double energy() const { return cloth.potentialEnergy(state) + cloth.kineticEnergy(state); }
};

TEST(MembraneFriction, EnergyNeverGrows) {
  expectEnergyNeverGrows([] { return ReleasedSheet(); }, 2e-4, 0.0);
}

// Every method carries the past from step to step: what they converge to is the same motion.
TEST(MembraneFriction, AllMethodsAgreeOnTheMotionOfASheetWithFriction) {
  const auto end = [](IntegrationMethod method, double time_step) {
    ReleasedSheet sheet;
    run(sheet, method, 8, static_cast<int>(std::lround(2e-3 / time_step)), time_step);
    return sheet.state.positions[2];
  };
  const Vector3d start = ReleasedSheet().state.positions[2];
  const Vector3d reference = end(IntegrationMethod::kRungeKutta4, 1e-6);
  const double way = (reference - start).norm();
  ASSERT_GT(way, 5e-4);
  for (const NamedIntegrationMethod& named : kIntegrationMethods) {
    const double time_step = isImplicit(named.method) ? 1e-5 : 2e-6;
    EXPECT_LT((end(named.method, time_step) - reference).norm(), 0.02 * way) << named.name;
  }
}

// What is pulled and let go in place takes energy that elastic cloth keeps.
TEST(MembraneFriction, AVibrationDiesAwayFasterThanWithoutIt) {
  const auto left = [](const ModelledEffects& effects) {
    ReleasedSheet sheet(effects);
    const double first = sheet.energy();
    run(sheet, IntegrationMethod::kTrBdf2, 4, 200, 1e-4);
    return sheet.energy() / first;
  };
  EXPECT_LT(left(hysteresis()), 0.8 * left({}));
}

TEST(MembraneFriction, ARejectedStepLeavesThePastAlone) {
  ReleasedSheet sheet;
  expectARejectedStepToLeaveThePastAlone(sheet);
}

TEST(MembraneFriction, ThatIsNotModelledIsNotThere) {
  const Cloth elastic(square(4), withHysteresis(linearFabric()), {});
  EXPECT_EQ(elastic.forces().find<MembraneFriction>(), nullptr);
  EXPECT_TRUE(elastic.initialState().memory.empty());
  material::Fabric smooth = linearFabric();
  smooth.resilience = {1.0, 1.0};
  smooth.shear_hysteresis = {0.0, 0.0};
  EXPECT_EQ(Cloth(square(4), smooth, hysteresis()).forces().find<MembraneFriction>(), nullptr);
}

TEST(MembraneFriction, RefusesWhatItCannotModel) {
  for (const Elasticity elasticity : {Elasticity::kMassSpring, Elasticity::kCorotational}) {
    ModelledEffects other = hysteresis();
    other.elasticity = elasticity;
    EXPECT_EQ(refusal(withHysteresis(linearFabric()), other),
              "hysteresis of stretch and shear is modelled, which only Green-Lagrange elasticity "
              "knows");
  }
  material::Fabric fabric = withHysteresis(linearFabric());
  fabric.resilience.reset();
  EXPECT_EQ(refusal(fabric, hysteresis()),
            "hysteresis of stretch and shear is modelled and fabric 'linear' lacks it: add the key "
            "resilience");
  fabric = withHysteresis(linearFabric());
  fabric.shear_hysteresis.reset();
  EXPECT_EQ(refusal(fabric, hysteresis()),
            "hysteresis of stretch and shear is modelled and fabric 'linear' lacks it: add the key "
            "hysteresis to shear");
  fabric = withHysteresis(linearFabric());
  fabric.resilience->warp = 0.05;
  EXPECT_EQ(refusal(fabric, hysteresis()),
            "the resilience of the warp is 0.05; it must be from 0.1 to 1");
  fabric.resilience = {std::nan(""), 0.5};
  EXPECT_EQ(refusal(fabric, hysteresis()),
            "the resilience of the weft is nan; it must be from 0.1 to 1");
  fabric = withHysteresis(linearFabric());
  fabric.shear_hysteresis = {0.5, -1.0};
  EXPECT_EQ(refusal(fabric, hysteresis()),
            "the hysteresis of shear at 5 degrees is -1; it must be finite and at least 0");
}

}  // namespace
}  // namespace haptex::cloth::test_membrane_friction
