// Hysteresis of bending: what friction delivers, its forces, and what steps make of its past.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "derivatives.h"
#include "fixtures.h"
#include "force_fixtures.h"
#include "haptex/cloth/forces/bending/bending_friction.h"
#include "hysteresis_fixtures.h"

namespace haptex::cloth::test_bending_friction {
namespace {

using Eigen::Vector3d;

constexpr material::BendingRigidity kRigidity{2e-5, 1e-5};      // N.m
constexpr material::BendingHysteresis kHysteresis{4e-4, 6e-4};  // N
constexpr std::array<BendingModel, 2> kModels = {BendingModel::kLinear, BendingModel::kQuadratic};

ModelledEffects hysteresis(BendingModel model = BendingModel::kLinear) {
  ModelledEffects effects;
  effects.bending = effects.bending_hysteresis = true;
  effects.bending_settings.model = model;
  return effects;
}

material::Fabric frictionFabric() {
  material::Fabric fabric = linearFabric();
  fabric.bending = kRigidity;
  fabric.bending_hysteresis = kHysteresis;
  return fabric;
}

/// 10 x 8 cells of 10 mm; irregular: inner particles moved by up to a quarter of a cell.
mesh::ClothMesh sheet(mesh::Triangulation triangulation, bool irregular = false) {
  mesh::ClothMesh mesh = mesh::makeRectangle(0.1, 0.08, 10, 8, triangulation);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-0.0025, 0.0025);
  for (Eigen::Vector2d& place : mesh.rest_coordinates) {
    const double u = shift(random), v = shift(random);
    if (!irregular) continue;
    if (place.x() > 1e-9 && place.x() < 0.1 - 1e-9) place.x() += u;
    if (place.y() > 1e-9 && place.y() < 0.08 - 1e-9) place.y() += v;
  }
  return mesh;
}

/// Second derivatives wuu, wvv, wuv of a displacement out of the plane (1/m).
Positions bent(const mesh::ClothMesh& mesh, const Vector3d& w) {
  Positions positions;
  for (const Eigen::Vector2d& x : mesh.rest_coordinates) {
    positions.emplace_back(
        x.x(), x.y(),
        0.5 * w[0] * x.x() * x.x() + 0.5 * w[1] * x.y() * x.y() + w[2] * x.x() * x.y());
  }
  return positions;
}

/// What friction that yields adds to the energy per curvature (N.m2) as the sheet is bent like `w`.
/// The displacement is so small that no normal turns; the past lies far on the other side.
double yieldMoment(const mesh::ClothMesh& mesh, const BendingFriction& friction,
                   const Vector3d& w) {
  constexpr double kSmall = 1e-3;
  std::vector<double> past(friction.memorySize());
  friction.forget(bent(mesh, kSmall * w), past.data());
  for (double& bend : past) bend *= -1e4;
  const auto energy = [&](const Positions& positions) {
    return friction.energy({positions, positions, 0.0, past.data()});
  };
  return (energy(bent(mesh, kSmall * w)) - energy(bent(mesh, Vector3d::Zero()))) / kSmall;
}

struct NamedSheet {
  const char* name;
  mesh::ClothMesh mesh;
};
std::array<NamedSheet, 3> sheets() {
  return {{{"one way", sheet(mesh::Triangulation::kOneWay)},
           {"alternating", sheet(mesh::Triangulation::kAlternating)},
           {"irregular", sheet(mesh::Triangulation::kAlternating, true)}}};
}

// The area that resists, without the half cells at free edges, is that of the elastic hinges.
TEST(BendingFriction, CylindersMeetHalfOfTheHysteresisOnEveryMesh) {
  for (const NamedSheet& on : sheets()) {
    for (BendingModel model : kModels) {
      const Bending bending(on.mesh, kRigidity, {model, {0.0, 0.0}});
      const BendingFriction friction(on.mesh, bending.hinges(), bending.corners(), kRigidity,
                                     kHysteresis);
      const auto area_of = [&](const Vector3d& w, double rigidity) {
        return 2.0 * bending.energy(resting(bent(on.mesh, w))) / rigidity;
      };
      const double weft = 0.5 * kHysteresis.weft * area_of(Vector3d::UnitX(), kRigidity.weft);
      const double warp = 0.5 * kHysteresis.warp * area_of(Vector3d::UnitY(), kRigidity.warp);
      EXPECT_NEAR(yieldMoment(on.mesh, friction, Vector3d::UnitX()), weft, 1e-6 * weft) << on.name;
      EXPECT_NEAR(yieldMoment(on.mesh, friction, Vector3d::UnitY()), warp, 1e-6 * warp) << on.name;
      // In between: cos^2 of the one and sin^2 of the other, and twist meets nothing.
      const double oblique = 0.75 * weft + 0.25 * warp, root = std::sqrt(0.1875);
      EXPECT_NEAR(yieldMoment(on.mesh, friction, {0.75, 0.25, root}), oblique, 1e-6 * oblique);
      EXPECT_NEAR(yieldMoment(on.mesh, friction, Vector3d::UnitZ()), 0.0, 1e-6 * weft);
    }
  }
}

// Half of the hinges or so yield.
TEST(BendingFriction, ForceIsTheGradientOfTheEnergyAndTheJacobianThatOfTheForce) {
  for (BendingModel model : kModels) {
    material::Fabric limp;  // bending alone
    limp.areal_density = 0.1;
    limp.bending = kRigidity;
    limp.bending_hysteresis = kHysteresis;
    const Cloth cloth(square(4), limp, hysteresis(model));
    ClothState state = randomState(cloth, 2e-3, 0.0);
    cloth.forget(state);
    std::mt19937 random(2);
    std::normal_distribution<double> normal(0.0, 8e-4);
    for (Vector3d& place : state.positions) {
      place += Vector3d(normal(random), normal(random), normal(random));
    }
    const int yielding = yieldingIn(cloth, state);
    ASSERT_GT(yielding, 3);
    ASSERT_LT(yielding, static_cast<int>(state.memory.size()) - 3);
    expectExactDerivatives(cloth, state, {0, 7, 12});
  }
}

TEST(BendingFriction, YieldingTakesEnergyOutAndLeavesTheForces) {
  const Cloth cloth(square(4), frictionFabric(), hysteresis());
  ClothState state = cloth.initialState();
  state.positions = randomState(cloth, 2e-3, 0.0).positions;
  const ClothState before = state;
  cloth.remember(state);
  ASSERT_NE(state.memory, before.memory);
  EXPECT_LT(cloth.potentialEnergy(state), cloth.potentialEnergy(before));
  std::vector<Vector3d> forces, forces_before;
  cloth.computeForces(state, forces);
  cloth.computeForces(before, forces_before);
  double scale = 0.0;
  for (const Vector3d& force : forces) scale = std::max(scale, force.norm());
  for (std::size_t i = 0; i < forces.size(); ++i) {
    EXPECT_LT((forces[i] - forces_before[i]).norm(), 1e-12 * scale);
  }
  const ClothState once = state;
  cloth.remember(state);  // what has yielded does not again, but for rounding
  for (std::size_t i = 0; i < once.memory.size(); ++i) {
    EXPECT_NEAR(state.memory[i], once.memory[i], 1e-15);
  }
}

/// A strip of 100 mm x 20 mm, free, bent along weft by `curvature`, in the past as well.
struct FreeStrip {
  Cloth cloth;
  ClothState state;

  explicit FreeStrip(double curvature)
      : cloth(mesh::makeRectangle(0.1, 0.02, 10, 2, mesh::Triangulation::kAlternating),
              frictionFabric(), hysteresis()),
        state(cloth.initialState()) {
    for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
      const Eigen::Vector2d& rest = cloth.mesh().rest_coordinates[i];
      const double angle = curvature * (rest.x() - 0.05);
      state.positions[i] = {std::sin(angle) / curvature, rest.y(),
                            (1.0 - std::cos(angle)) / curvature};
    }
    cloth.remember(state);
  }
  double energy() const { return cloth.potentialEnergy(state) + cloth.kineticEnergy(state); }
  /// 1/m, of the circle through the ends and the middle of a side.
  double curvature() const {
    const Vector3d a = state.positions[0], b = state.positions[5], c = state.positions[10];
    return 2.0 * (b - a).cross(c - b).norm() / ((b - a).norm() * (c - b).norm() * (c - a).norm());
  }
};

TEST(BendingFriction, EnergyNeverGrows) {
  expectEnergyNeverGrows([] { return FreeStrip(40.0); }, 2e-3, 0.5);
}

// Friction holds at most the curvature at which the elastic moment is half of 2HB, 10 /m. One
// linear solve per step. Two columns are held, as a free strip may go on turning. Where friction
// holds the vibration left is elastic, which backward Euler damps in long steps.
TEST(BendingFriction, AReleasedStripStopsCurvedByNoMoreThanFrictionHolds) {
  FreeStrip strip(40.0);
  for (std::size_t i = 0; i < strip.cloth.particleCount(); ++i) {
    if (i % 11 > 1) continue;
    AttachmentPath path;
    path.start = strip.state.positions[i];
    strip.cloth.attach(static_cast<int>(i), path);
  }
  Integrator integrator(strip.cloth, StepSettings());
  for (int step = 0; step < 300; ++step) {
    ASSERT_TRUE(integrator.step(strip.cloth, strip.state, step < 100 ? 0.0125 : 0.1).accepted);
  }
  const double largest = 0.5 * kHysteresis.weft / kRigidity.weft;
  EXPECT_LT(strip.curvature(), 1.01 * largest);
  EXPECT_GT(strip.curvature(), 0.5 * largest);
  double speed = 0.0;
  for (const Vector3d& velocity : strip.state.velocities) speed = std::max(speed, velocity.norm());
  EXPECT_LT(speed, 1e-6);  // m/s; at first some 0.1
}

// Every method carries the past from step to step: what they converge to is the same motion.
TEST(BendingFriction, AllMethodsAgreeOnTheMotionOfAStripWithFriction) {
  const auto end = [](IntegrationMethod method, double time_step) {
    FreeStrip strip(30.0);
    run(strip, method, 8, static_cast<int>(std::lround(0.02 / time_step)), time_step);
    return strip.curvature();
  };
  const double reference = end(IntegrationMethod::kRungeKutta4, 2.5e-5);
  for (const NamedIntegrationMethod& named : kIntegrationMethods) {
    const double time_step = isImplicit(named.method) ? 1e-4 : 1e-5;
    EXPECT_NEAR(end(named.method, time_step), reference, 0.3) << named.name;
  }
}

TEST(BendingFriction, ARejectedStepLeavesThePastAlone) {
  FreeStrip strip(30.0);
  expectARejectedStepToLeaveThePastAlone(strip);
}

TEST(BendingFriction, AnotherFabricHasNoPast) {
  FreeStrip strip(30.0);
  material::Fabric other = frictionFabric();
  other.bending_hysteresis->warp = 0.0;  // fewer hinges with friction
  strip.cloth.setFabric(other);
  std::vector<Vector3d> forces;
  EXPECT_THROW(strip.cloth.computeForces(strip.state, forces), std::invalid_argument);
  Integrator integrator(strip.cloth, StepSettings());
  EXPECT_THROW(integrator.step(strip.cloth, strip.state, 0.01), std::invalid_argument);
  strip.cloth.forget(strip.state);
  EXPECT_EQ(strip.cloth.forces().find<BendingFriction>()->energy(strip.state.ofForces()), 0.0);
  EXPECT_TRUE(integrator.step(strip.cloth, strip.state, 0.01).accepted);
}

TEST(BendingFriction, ThatIsNotModelledIsNotThere) {
  ModelledEffects elastic = hysteresis();
  elastic.bending_hysteresis = false;
  const Cloth cloth(square(4), frictionFabric(), elastic);
  EXPECT_EQ(cloth.forces().find<BendingFriction>(), nullptr);
  EXPECT_TRUE(cloth.initialState().memory.empty());
  material::Fabric smooth = frictionFabric();
  smooth.bending_hysteresis = {0.0, 0.0};
  EXPECT_EQ(Cloth(square(4), smooth, hysteresis()).forces().find<BendingFriction>(), nullptr);
}

TEST(BendingFriction, RefusesWhatItCannotModel) {
  ModelledEffects unbent = hysteresis();
  unbent.bending = false;
  EXPECT_EQ(refusal(frictionFabric(), unbent),
            "hysteresis of bending is modelled and bending is not");
  ModelledEffects springs = hysteresis();
  springs.elasticity = Elasticity::kMassSpring;
  EXPECT_EQ(refusal(frictionFabric(), springs),
            "hysteresis of bending is modelled, which bend springs do not know");
  material::Fabric fabric = frictionFabric();
  fabric.bending_hysteresis.reset();
  EXPECT_EQ(
      refusal(fabric, hysteresis()),
      "hysteresis of bending is modelled and fabric 'linear' has none: add the key hysteresis "
      "to bending");
  fabric.bending_hysteresis = {1e-4, std::nan("")};
  EXPECT_EQ(refusal(fabric, hysteresis()),
            "the hysteresis of bending along warp is nan N; it must be finite and at least 0, and "
            "0 where the rigidity is");
  fabric.bending_hysteresis = {1e-4, 1e-4};
  fabric.bending->weft = 0.0;
  EXPECT_EQ(refusal(fabric, hysteresis()),
            "the hysteresis of bending along weft is 0.0001 N; it must be finite and at least 0, "
            "and 0 where the rigidity is");
}

}  // namespace
}  // namespace haptex::cloth::test_bending_friction
