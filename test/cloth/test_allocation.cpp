// An executable of its own, because it counts every call of malloc in the process.
#include <gtest/gtest.h>

#include <cstdlib>
#include <tuple>

#include "../malloc_counter.h"
#include "fixtures.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "seam_fixtures.h"
#include "self_contact_fixtures.h"

namespace haptex::cloth::test_allocation {
namespace {

class StepAllocation : public testing::TestWithParam<
                           std::tuple<NamedIntegrationMethod, linear::LinearSolverMethod>> {};

TEST_P(StepAllocation, NoStepAllocatesAfterStartUp) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  for (const auto& [newton_iterations, newton_error] :
       {std::pair(1, 0.0), std::pair(5, 0.0), std::pair(5, 1e-3)}) {
    ModelledEffects effects;
    effects.viscosity = effects.point_loads = true;
    effects.gravity = {0.0, 0.0, -9.81};
    effects.air = Air();
    effects.air->wind.gusts = {{{1.0, 0.0, 0.0}, 1.0, 0.0}};
    effects.bending = effects.bending_hysteresis = effects.membrane_hysteresis = true;
    effects.bending_settings.rest_curvature << 5.0, -2.0;
    effects.fasteners = {
        {"band",
         FastenerKind::kElastic,
         {ClothPlace{{0, -1, -1}}, ClothPlace{{16, -1, -1}}},
         10.0,
         0.01,
         5.0},
        {"cord",
         FastenerKind::kDrawstring,
         {ClothPlace{{34, -1, -1}}, ClothPlace{{40, -1, -1}}, ClothPlace{{50, -1, -1}}},
         10.0,
         0.01,
         5.0}};
    material::Fabric fabric = stiffeningFabric();
    fabric.bending = {1e-5, 2e-5};
    fabric.bending_hysteresis = {3e-4, 1e-4};
    fabric.resilience = {0.5, 0.7};
    fabric.shear_hysteresis = {0.5, 1.0};
    Cloth cloth(square(16), fabric, effects);
    for (int particle : mesh::sideParticles(cloth.mesh(), mesh::Side::kTop)) {
      AttachmentPath path;
      path.start = cloth.mesh().initial_positions[particle];
      cloth.attach(particle, path);
    }
    PointLoad load{7, {0.5, 0.25, 0.25}, {0, 0, 0}, {0.1, 0, 0}, Eigen::Matrix3d::Identity()};
    const std::vector<PointLoad> loads(100, load);
    StepSettings settings;
    settings.method = std::get<0>(GetParam()).method;
    settings.solver = std::get<1>(GetParam());
    settings.newton_iterations = newton_iterations;
    settings.newton_error = newton_error;
    Integrator integrator(cloth, settings);
    ClothState state = randomState(cloth, 1e-4, 0.1);
    std::vector<Eigen::Vector3d> forces;
    cloth.computeForces(state, forces);

    const long before = allocations;
    // Explicit steps accept only the shortest; BDF-2 continues, and starts anew where steps grow.
    const double longest = isImplicit(settings.method) ? 0.04 : 4e-5;
    for (double share : {0.3, 0.02, 0.03, 1.0, 1e-3}) {
      const double h = share * longest;
      cloth.setPointLoads(loads);
      Fasteners::set(0, share < 0.5, state.memory.data());
      EXPECT_TRUE(integrator.step(cloth, state, h).accepted);
      cloth.computeForces(state, forces);
    }
    EXPECT_EQ(allocations - before, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Methods, StepAllocation,
    testing::Combine(testing::ValuesIn(kIntegrationMethods),
                     testing::Values(linear::LinearSolverMethod::kConjugateGradient,
                                     linear::LinearSolverMethod::kCholesky,
                                     linear::LinearSolverMethod::kAutomatic)));

class StepAllocationOfOtherModels : public testing::TestWithParam<Elasticity> {};
INSTANTIATE_TEST_SUITE_P(Models, StepAllocationOfOtherModels,
                         testing::Values(Elasticity::kBilinear, Elasticity::kMassSpring,
                                         Elasticity::kCorotational));

TEST_P(StepAllocationOfOtherModels, NoStepAllocatesAfterStartUp) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  ModelledEffects effects;
  effects.elasticity = GetParam();
  effects.viscosity = effects.bending = true;
  material::Fabric fabric = stiffeningFabric();
  fabric.bending = {1e-5, 1e-5};
  const Cloth cloth(square(8), fabric, effects);
  for (IntegrationMethod method : {IntegrationMethod::kTrBdf2, IntegrationMethod::kRungeKutta4}) {
    StepSettings settings;
    settings.method = method;
    settings.newton_iterations = 5;
    Integrator integrator(cloth, settings);
    ClothState state = randomState(cloth, 1e-4, 0.1);
    const long before = allocations;
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(integrator.step(cloth, state, 1e-5).accepted);
    EXPECT_EQ(allocations - before, 0);
  }
}

TEST(StepAllocation, StepsOfSewnClothAllocateNothing) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  ModelledEffects effects;
  effects.viscosity = effects.bending = true;
  material::Fabric fabric = stiffeningFabric();
  fabric.bending = {1e-5, 1e-5};
  Halves made = halves(6, 10);
  made.seam.angle = 0.2;
  mesh::sew(made.mesh, {made.seam});
  for (const NamedIntegrationMethod& named : kIntegrationMethods) {
    Cloth cloth(made.mesh, fabric, effects);
    StepSettings settings;
    settings.method = named.method;
    settings.newton_iterations = 5;
    Integrator integrator(cloth, settings);
    ClothState state = cloth.initialState();
    state.positions[made.seam.second[3]].z() += 1e-5;
    cloth.closeSeams(state, 0.5);
    const long before = allocations;
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(integrator.step(cloth, state, 1e-5).accepted);
    EXPECT_EQ(allocations - before, 0) << named.name;
  }
}

TEST(StepAllocation, StepsThatAreTakenAnewAllocateNothing) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  material::Fabric fabric = linearFabric();
  fabric.weft.elastic = fabric.warp.elastic = material::StrainStressCurve::linear(1e6);
  const Cloth cloth(square(8), fabric, {});
  for (const NamedIntegrationMethod& named : kIntegrationMethods) {
    if (!isImplicit(named.method)) continue;
    StepSettings settings;
    settings.method = named.method;
    Integrator integrator(cloth, settings);
    ClothState state = randomState(cloth, 1e-4, 100.0);
    const long before = allocations;
    bool anew = false;
    for (int i = 0; i < 3; ++i) anew = integrator.step(cloth, state, 0.1).taken_anew || anew;
    EXPECT_EQ(allocations - before, 0) << named.name;
    EXPECT_TRUE(anew) << named.name;
  }
}

TEST(StepAllocation, ExplicitIntegratorsHoldNoMatrix) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  const Cloth cloth(square(16), linearFabric(), {});
  const auto calls = [&](IntegrationMethod method) {
    StepSettings settings;
    settings.method = method;
    const long before = allocations;
    const Integrator integrator(cloth, settings);
    return allocations - before;
  };
  // Positions and velocities of the end, and of a stage where there is one, and forces.
  EXPECT_EQ(calls(IntegrationMethod::kExplicitEuler), 3);
  EXPECT_EQ(calls(IntegrationMethod::kTwoStepEuler), 3);
  EXPECT_LE(calls(IntegrationMethod::kRungeKutta4), 5);
  EXPECT_GT(calls(IntegrationMethod::kBackwardEuler), 10);
}

TEST(StepAllocation, TheCounterCounts) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  const long before = allocations;
  std::free(std::malloc(100000));
  Eigen::VectorXd vector(1000);
  EXPECT_GE(allocations - before, 1);
}

TEST(SelfCollisionAllocation, NoStepAllocatesOnceAsMuchHasTouched) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  Cloth cloth(layers(2, 0.04, 5), fabricNamed("wool"), selfCollision());
  StepSettings settings;
  settings.newton_iterations = 5;
  // All runs touch as much: no solve depends on what the solver tried in the one before.
  settings.tolerance = 1e-12;
  Integrator integrator(cloth, settings);
  long before = 0;
  std::size_t touching = 0;
  for (int run = 0; run < 4; ++run) {
    ClothState state = cloth.initialState();
    for (std::size_t i = state.positions.size() / 2; i < state.positions.size(); ++i) {
      state.positions[i].z() = 5e-4 + 0.1 * state.positions[i].x();
      state.velocities[i].z() = -0.3;
    }
    before = allocations;
    for (int i = 0; i < 6; ++i) {
      EXPECT_TRUE(integrator.step(cloth, state, 0.005).accepted);
      touching = std::max(touching, cloth.selfContact()->touching(state.positions).size());
    }
  }
  EXPECT_GT(touching, 0u);
  EXPECT_EQ(allocations - before, 0);
}

}  // namespace
}  // namespace haptex::cloth::test_allocation
