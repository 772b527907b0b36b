#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "haptex/contact/obstacles/obstacles.h"
#include "haptex/contact/obstacles/start_outside.h"
#include "haptex/proximity/intersections.h"
#include "haptex/scene/scene.h"
#include "haptex/scene/scene_fabric.h"
#include "haptex/simulation/simulated_cloth.h"
#include "small_scene.h"

namespace haptex::simulation::test_simulated_cloth {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void expectRefused(const std::function<void(SimulatedCloth&)>& request,
                   const std::string& expected) {
  simulation::expectRefused([] { return smallSimulation(); }, request, expected);
}

TEST(SimulatedCloth, RefusesParticlesThatAreNotThereOrNamedTwice) {
  const auto attach = [](const std::vector<std::uint32_t>& particles) {
    return [particles](SimulatedCloth& simulation) { simulation.attach(particles); };
  };
  expectRefused(attach({}), "particles is empty");
  expectRefused(attach({0, kSmallParticles}),
                "particles[1] = 25 does not exist: allowed are 0 to 24");
  expectRefused(attach({0, 4294967295u}), "particles[1] = 4294967295 does not exist");
  expectRefused(attach({0, 1, 0}), "particles[2] = 0 is named twice");
}

TEST(SimulatedCloth, RefusesPlacesThatAreNotFiniteNotForEachOrTooFar) {
  const auto attach = [](const std::vector<Eigen::Vector3d>& places) {
    return [places](SimulatedCloth& simulation) { simulation.attach({0, 1}, places); };
  };
  expectRefused(attach({Eigen::Vector3d::Zero()}), "positions has 1 elements and particles 2");
  expectRefused(attach({{0, 0, 0}, {0, kNaN, 0}}), "positions[1] = (0, nan, 0) m");
  expectRefused(attach({{0, 0, kInfinity}, {0, 0, 0}}), "positions[0] = (0, 0, inf) m");
  expectRefused(attach({{0, 0, 0}, {-101, 0, 0}}), "from -100 to 100 m");
}

TEST(SimulatedCloth, RefusesMovesItCannotMake) {
  const auto move = [](const std::vector<std::uint32_t>& particles, const Eigen::Vector3d& by,
                       double duration) {
    return [=](SimulatedCloth& simulation) { simulation.move(particles, by, duration); };
  };
  expectRefused(move({kSmallTop, 0}, {0, 0, 0.1}, 1), "particles[1] = 0 is not attached");
  expectRefused(move({kSmallTop}, {kNaN, 0, 0}, 1), "displacement = (nan, 0, 0) m");
  expectRefused(move({kSmallTop}, {0, 0, 0}, -1), "duration = -1 s: allowed are finite");
  expectRefused(move({kSmallTop}, {0, 0, 0}, kNaN), "duration = nan s");
  expectRefused(move({kSmallTop}, {0, 0, 0}, kInfinity), "duration = inf s");
  expectRefused(move({kSmallTop}, {0, 100.5, 0}, 1), "the end of the path of particles[0]");
}

TEST(SimulatedCloth, RefusesToReleaseWhatIsNotAttached) {
  expectRefused(
      [](SimulatedCloth& simulation) {
        simulation.release({kSmallTop, 0});
      },
      "particles[1] = 0 is not attached");
}

TEST(SimulatedCloth, MovesAttachedParticlesExactlyToTheEndOfTheirPaths) {
  SimulatedCloth simulation = smallSimulation();
  const Eigen::Vector3d start = simulation.state().positions[kSmallTop];
  const Eigen::Vector3d displacement(0.01, -0.02, 0.03);
  simulation.move({kSmallTop}, displacement, 7.5 * simulation.timeStep());
  for (int i = 0; i < 7; ++i) ASSERT_TRUE(simulation.step());
  EXPECT_NE(simulation.state().positions[kSmallTop], start + displacement);
  ASSERT_TRUE(simulation.step());
  EXPECT_EQ(simulation.state().positions[kSmallTop], start + displacement);
}

TEST(SimulatedCloth, RunsAgainBitByBitAfterReset) {
  SimulatedCloth simulation = smallSimulation();
  SimulatedCloth fresh = smallSimulation();
  simulation.attach({0}, {Eigen::Vector3d(0.05, 0, -0.1)});
  simulation.release({kSmallTop});
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(simulation.step());
  simulation.reset();
  EXPECT_EQ(simulation.steps(), 0u);
  EXPECT_EQ(simulation.state().time, 0.0);
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(simulation.step());
    ASSERT_TRUE(fresh.step());
  }
  EXPECT_EQ(simulation.state().positions, fresh.state().positions);
  EXPECT_EQ(simulation.state().velocities, fresh.state().velocities);
}

TEST(SimulatedCloth, KeepsPositionsAndVelocitiesWhenTheFabricChanges) {
  SimulatedCloth simulation = smallSimulation();
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(simulation.step());
  const cloth::ClothState before = simulation.state();
  material::Fabric heavy = simulation.cloth().fabric();
  heavy.areal_density *= 2;
  const double mass = simulation.cloth().masses()[0];
  simulation.setFabric(heavy);
  EXPECT_EQ(simulation.state().positions, before.positions);
  EXPECT_EQ(simulation.state().velocities, before.velocities);
  EXPECT_DOUBLE_EQ(simulation.cloth().masses()[0], 2 * mass);
}

// Friction remembers how the cloth was bent; another fabric and a reset do not.
TEST(SimulatedCloth, AnotherFabricAndAResetForgetHowTheClothWasBent) {
  SimulatedCloth simulation = smallSimulation(true);
  const std::vector<double> flat = simulation.state().memory;
  ASSERT_FALSE(flat.empty());
  simulation.move({kSmallTop}, {0.05, 0.1, 0.0}, 0.1);
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(simulation.step());
  EXPECT_NE(simulation.state().memory, flat);
  material::Fabric other = simulation.cloth().fabric();
  other.bending_hysteresis->warp = 0.0;  // fewer hinges with friction
  simulation.setFabric(other);
  EXPECT_LT(simulation.state().memory.size(), flat.size());
  ASSERT_TRUE(simulation.step());
  simulation.setFabric(smallSimulation(true).cloth().fabric());
  simulation.reset();
  EXPECT_EQ(simulation.state().memory, flat);
}

TEST(SimulatedCloth, OtherFabricsGravityAndAirActFromTheNextStepOn) {
  SimulatedCloth simulation = smallSimulation();
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(simulation.step());
  const cloth::ClothState before = simulation.state();
  std::vector<material::Fabric> fabrics = simulation.cloth().fabrics();
  fabrics.front().areal_density *= 3.0;
  simulation.setMaterial(fabrics, {0.0, 1.0, 0.0}, std::nullopt);
  EXPECT_EQ(simulation.state().positions, before.positions);
  EXPECT_EQ(simulation.state().velocities, before.velocities);
  std::vector<Eigen::Vector3d> forces;
  simulation.cloth().computeForces(simulation.state(), forces);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& force : forces) sum += force;
  EXPECT_NEAR(sum.y(), 3.0 * 0.1 * 0.2 * 0.2, 1e-12);  // kg times 1 m/s^2; the rest cancels
  EXPECT_NEAR(sum.z(), 0.0, 1e-12);
  ASSERT_TRUE(simulation.step());
}

TEST(SimulatedCloth, RefusesOtherMaterialThatDoesNotFit) {
  const std::vector<material::Fabric> fabrics = smallSimulation().cloth().fabrics();
  const auto refuse = [&](const std::vector<material::Fabric>& others,
                          const std::optional<cloth::Air>& air, const std::string& says) {
    expectRefused(
        [&](SimulatedCloth& cloth) {
          cloth.setMaterial(others, {0.0, 0.0, -1.0}, air);
        },
        says);
  };
  refuse({fabrics.front(), fabrics.front()}, std::nullopt, "there are 2 fabrics: allowed are 1");
  refuse(fabrics, cloth::Air(), "modelled without air");
  material::Fabric weightless = fabrics.front();
  weightless.areal_density = 0.0;
  refuse({weightless}, std::nullopt, "density");
}

/// The rail of this scene reaches through the sheet at the start.
TEST(SimulatedCloth, ThatStartsInAnObstacleGoesOnOutsideOfIt) {
  const std::string path = HAPTEX_CONFIG_DIRECTORY "/scenes/dropped_sheet.yaml";
  scene::Scene scene = scene::loadScene(path);
  EXPECT_EQ(scene.start_move.triangle, -1);
  mesh::Obstacle& rail = scene.obstacles[1];
  ASSERT_EQ(rail.name, "rail");
  rail.pose.translation().x() = 0.003;
  const contact::StartMove move =
      contact::moveOutside(scene.mesh, scene.obstacles, scene.attached_particles);
  EXPECT_GT(move.particles, 0);
  const proximity::RigidObstacle shape = contact::makeObstacle(rail);
  const std::vector<std::array<int, 3>> triangles = scene.mesh.triangles;
  SimulatedCloth simulation(scene, scene::loadSceneFabrics(path, scene));
  for (int i = 0; i < 24; ++i) {
    ASSERT_TRUE(simulation.step()) << i;
    const std::vector<Eigen::Vector3d>& at = simulation.state().positions;
    EXPECT_TRUE(proximity::intersectingTriangles(at, triangles).empty()) << i;
    for (const auto& [a, b, c] : triangles) {
      EXPECT_GT(shape.closestPoint({at[a], at[b], at[c]}).distance, 0.0) << i;
    }
  }
}

}  // namespace
}  // namespace haptex::simulation::test_simulated_cloth
