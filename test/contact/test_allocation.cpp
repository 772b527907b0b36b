// An executable of its own, because it counts every call of malloc in the process.
#include <gtest/gtest.h>

#include <algorithm>

#include "../malloc_counter.h"
#include "fixtures.h"
#include "haptex/contact/obstacles/obstacle_collision.h"

namespace haptex::contact::test_allocation {
namespace {

TEST(ContactAllocation, TheFastThreadsCallsAllocateNothing) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  const mesh::ClothMesh mesh = smallSample();
  for (const auto kind : {HapticSettings::Layer::kPatch, HapticSettings::Layer::kWholeCloth}) {
    HapticSettings settings;
    settings.layer = kind;
    const bool patches = kind == HapticSettings::Layer::kPatch;
    cloth::ModelledEffects effects{true, {0.0, 0.0, -9.81}};
    effects.self_collision = patches;
    effects.contacts = patches;
    const Eigen::Isometry3d behind(Eigen::Translation3d(-0.03, 0.0, -0.02));
    mesh::Obstacle ball{"ball", mesh::ObstacleSphere{0.0298}, behind};
    ball.motion = mesh::ObstacleDrift{{1e-4, 0.0, 0.0}};
    HapticLayer layer(mesh, wool(), effects, settings, {ball});
    const auto prepare = [&](double u) {
      return layer.preparePatch(trianglesAround(mesh, {u, 0.02}, 0.01), nothingAttached(mesh));
    };
    std::unique_ptr<Patch> first = patches ? prepare(0.02) : nullptr;
    std::unique_ptr<Patch> second = patches ? prepare(0.025) : nullptr;
    Fingertip index = pressing(layer.law(), kSmallSampleMiddle, 1e-3);
    Fingertip thumb = index;
    thumb.position.x() *= -1.0;
    Fingertip unsound = thumb;
    unsound.position.y() = std::nan("");
    const std::vector<Eigen::Vector3d> rest = atRest(mesh);
    bool touched = false;

    const long before = allocations;
    layer.step({index, thumb});
    layer.receive(mesh.initial_positions, rest, 0.02);
    layer.exchange(std::move(first));
    for (int i = 0; i < 50; ++i) layer.step({index, thumb});
    touched = layer.contacts()[base::Finger::kIndex].touching &&
              layer.contacts()[base::Finger::kThumb].touching &&
              (!patches || layer.patch()->touchesObstacle());
    layer.receive(mesh.initial_positions, rest, 0.02);
    std::unique_ptr<Patch> old = layer.exchange(std::move(second));
    for (int i = 0; i < 50; ++i) layer.step({index, i % 2 == 0 ? thumb : unsound});
    std::unique_ptr<Patch> older = layer.exchange(nullptr);
    layer.step({index, std::nullopt});
    EXPECT_EQ(allocations - before, 0);
    EXPECT_GT(before, 0) << "the count does not work";
    EXPECT_TRUE(touched);
  }
}

TEST(ContactAllocation, StepsAmongObstaclesAllocateNothing) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  const Eigen::Isometry3d under(Eigen::Translation3d(0.0, 0.0, -0.12));
  std::vector<mesh::Obstacle> obstacles = {
      {"ball", mesh::ObstacleSphere{0.03}, under},
      {"sheet", mesh::ObstacleMesh{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}}}, under}};
  obstacles[0].motion = mesh::ObstacleOrbit{{0.05, 0.0, -0.12}, Eigen::Vector3d::UnitZ(), 1.0};
  for (const int newton_iterations : {1, 5}) {
    cloth::ModelledEffects effects;
    effects.gravity = {0.0, 0.0, -9.81};
    effects.contacts = true;
    cloth::Cloth cloth(smallSample(), wool(), effects);
    cloth::StepSettings settings;
    settings.newton_iterations = newton_iterations;
    settings.method = cloth::IntegrationMethod::kBdf2;
    cloth::Integrator integrator(cloth, settings);
    ObstacleCollision collision(cloth, obstacles);
    cloth::ClothState state = cloth.initialState();
    int rounds = 0;
    const long before = allocations;
    for (int i = 0; i < 40; ++i) {
      rounds += collision.step(cloth, integrator, state, 0.01).contact_rounds;
    }
    EXPECT_EQ(allocations - before, 0);
    EXPECT_GT(rounds, 40);
  }
}

TEST(ContactAllocation, StepsWithBodiesAllocateNothing) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  const auto at = [](double x, double z) {
    return Eigen::Isometry3d(Eigen::Translation3d(x, 0.0, z));
  };
  std::vector<mesh::Obstacle> obstacles = {
      {"ball", mesh::ObstacleSphere{0.03}, at(0.034, -0.02)},
      {"box", mesh::ObstacleBox{{0.02, 0.03, 0.04}}, at(0.1, -0.07)},
      {"floor", mesh::ObstacleBox{{1.0, 1.0, 0.02}}, at(0.0, -0.11)}};
  obstacles[0].body = mesh::ObstacleBody{0.01, {-0.5, 0.0, 0.0}, {0.0, 0.0, 5.0}, 0.3};
  obstacles[1].body = mesh::ObstacleBody{0.01, {-0.5, 0.0, 0.0}, {1.0, 2.0, 3.0}, 0.3};
  for (const int newton_iterations : {0, 1, 5}) {  // 0: an explicit method
    cloth::ModelledEffects effects;
    effects.gravity = {0.0, 0.0, -9.81};
    effects.contacts = true;
    cloth::Cloth cloth(smallSample(), wool(), effects);
    ObstacleCollision collision(cloth, obstacles);
    cloth::StepSettings settings;
    settings.newton_iterations = std::max(1, newton_iterations);
    if (newton_iterations == 0) settings.method = cloth::IntegrationMethod::kRungeKutta4;
    cloth::Integrator integrator(cloth, settings);
    cloth::ClothState state = cloth.initialState();
    const double h = newton_iterations == 0 ? 2e-5 : 0.01;
    int rounds = 0;
    const long before = allocations;
    for (int i = 0; i < 40; ++i) {
      rounds += collision.step(cloth, integrator, state, h).contact_rounds;
    }
    EXPECT_EQ(allocations - before, 0) << newton_iterations;
    if (newton_iterations > 0) {
      EXPECT_GT(rounds, 40);
    }
  }
}

}  // namespace
}  // namespace haptex::contact::test_allocation
