#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>

#include "haptex/simulation/simulated_cloth.h"
#include "small_scene.h"

namespace haptex::simulation::test_sleeping_cloth {
namespace {

using Eigen::Vector3d;

/// The same cloth, without sleep.
class Sleepless {
 public:
  explicit Sleepless(const SimulatedCloth& simulation, const scene::Scene& scene)
      : cloth_(simulation.cloth().mesh(), simulation.cloth().fabric(),
               simulation.cloth().effects()),
        state_(simulation.state()),
        integrator_(cloth_, scene.step) {
    const auto& attachments = simulation.cloth().attachments();
    for (std::size_t i = 0; i < attachments.size(); ++i) {
      if (attachments[i]) cloth_.attach(static_cast<int>(i), *attachments[i]);
    }
  }

  void step(double time_step) { ASSERT_TRUE(integrator_.step(cloth_, state_, time_step).accepted); }
  void move(int particle, const Vector3d& displacement, double duration) {
    const Vector3d start = cloth_.attachments()[particle]->position(state_.time);
    cloth_.attach(particle, {start, displacement, state_.time, duration});
  }

  /// m, of any particle
  double distance(const SimulatedCloth& simulation) const {
    double distance = 0.0;
    for (std::size_t i = 0; i < state_.positions.size(); ++i) {
      distance = std::max(distance, (state_.positions[i] - simulation.state().positions[i]).norm());
    }
    return distance;
  }

 private:
  cloth::Cloth cloth_;
  cloth::ClothState state_;
  cloth::Integrator integrator_;
};

void stepUntilAsleep(SimulatedCloth& simulation, double longest) {
  const double end = simulation.state().time + longest;
  while (!simulation.asleep() && simulation.state().time < end) ASSERT_TRUE(simulation.step());
  ASSERT_TRUE(simulation.asleep());
}

material::Fabric viscousFabric(double seconds) {
  material::Fabric fabric = smallFabric();
  for (material::MembraneCurves* curves : {&fabric.weft, &fabric.warp, &fabric.shear}) {
    curves->viscous = material::StrainStressCurve::linear(100.0 * seconds);
  }
  return fabric;
}

/// A motion that has to settle before it sleeps.
struct Settling {
  std::string name;
  scene::Scene scene;
  material::Fabric fabric;
};

std::vector<Settling> settlingMotions() {
  std::vector<Settling> motions;
  motions.push_back({"hanging", smallScene(), smallFabric()});
  motions.push_back({"with bending and its hysteresis", smallScene(), smallFabric()});
  motions.back().scene.effects.bending = motions.back().scene.effects.bending_hysteresis = true;
  motions.push_back({"with hysteresis of stretch and shear", smallScene(), smallFabric()});
  motions.back().scene.effects.membrane_hysteresis = true;
  for (const double seconds : {0.2, 3.0}) {
    motions.push_back({"creeping", smallScene(), viscousFabric(seconds)});
    motions.back().scene.effects.viscosity = true;
  }
  motions.push_back({"in a steady wind", smallScene(), smallFabric()});
  motions.back().scene.effects.air = cloth::Air();
  motions.back().scene.effects.air->wind.mean = {0.5, 0.2, 0.0};
  motions.push_back({"with TR-BDF2 in air", smallScene(), viscousFabric(0.01)});
  motions.back().scene.effects.viscosity = true;
  motions.back().scene.effects.air = cloth::Air();
  motions.back().scene.effects.air->coefficients.normal = 100.0;
  motions.back().scene.step.method = cloth::IntegrationMethod::kTrBdf2;
  return motions;
}

// Neither while it sleeps nor after it was woken is it farther from one that never slept than what
// the detector allows to go on unseen.
TEST(SleepingCloth, StaysWhereASleeplessOneComesToRest) {
  for (const Settling& motion : settlingMotions()) {
    SimulatedCloth simulation(motion.scene, motion.fabric);
    Sleepless sleepless(simulation, motion.scene);
    const auto step_both = [&] {
      ASSERT_TRUE(simulation.step());
      sleepless.step(simulation.timeStep());
    };
    const auto step_for = [&](double seconds) {
      const double end = simulation.state().time + seconds;
      while (simulation.state().time < end) step_both();
    };
    while (!simulation.asleep() && simulation.state().time < 100.0) step_both();
    ASSERT_TRUE(simulation.asleep()) << motion.name;
    EXPECT_LT(sleepless.distance(simulation), 1e-12) << motion.name << ": the same until then";
    step_for(20.0);
    EXPECT_TRUE(simulation.asleep()) << motion.name;
    EXPECT_LT(sleepless.distance(simulation), cloth::RestDetector::kTolerance) << motion.name;
    simulation.move({kSmallTop}, {0.01, 0.02, 0.01}, 0.3);
    sleepless.move(kSmallTop, {0.01, 0.02, 0.01}, 0.3);
    step_for(0.1);
    EXPECT_LT(sleepless.distance(simulation), 3.0 * cloth::RestDetector::kTolerance)
        << motion.name << ": on the way";
  }
}

TEST(SleepingCloth, OnlyItsTimeGoesOn) {
  SimulatedCloth simulation = smallSimulation();
  stepUntilAsleep(simulation, 60.0);
  const cloth::ClothState before = simulation.state();
  const std::uint64_t steps = simulation.steps(), computed = simulation.computedSteps();
  EXPECT_EQ(steps, computed);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(simulation.step());
  EXPECT_EQ(simulation.state().positions, before.positions);
  EXPECT_EQ(simulation.state().velocities, before.velocities);
  EXPECT_NEAR(simulation.state().time, before.time + 100 * simulation.timeStep(), 1e-9);
  EXPECT_EQ(simulation.steps(), steps + 100);
  EXPECT_EQ(simulation.computedSteps(), computed);
  EXPECT_EQ(simulation.lastReport().newton_iterations, 0);
  EXPECT_EQ(simulation.lastReport().total_seconds, 0.0);
}

TEST(SleepingCloth, EveryChangeWakesIt) {
  const cloth::PointLoad push{
      5, {1.0, 0.0, 0.0}, {0, 0, 0}, {0, 0.001, 0}, Eigen::Matrix3d::Zero()};
  const std::vector<std::pair<std::string, std::function<void(SimulatedCloth&)>>> changes = {
      {"fabric", [](SimulatedCloth& s) { s.setFabric(smallFabric()); }},
      {"attach", [](SimulatedCloth& s) { s.attach({0}); }},
      {"attach elsewhere",
       [](SimulatedCloth& s) {
         s.attach({0}, {{0.0, 0.0, -0.1}});
       }},
      {"move",
       [](SimulatedCloth& s) {
         s.move({kSmallTop}, {0, 0, 0.01}, 1000.0);
       }},
      {"release", [](SimulatedCloth& s) { s.release({kSmallTop}); }},
      {"loads", [=](SimulatedCloth& s) { s.setPointLoads({push}); }},
      {"reset", [](SimulatedCloth& s) { s.reset(); }},
  };
  for (const auto& [name, change] : changes) {
    SimulatedCloth simulation = smallSimulation();
    stepUntilAsleep(simulation, 60.0);
    change(simulation);
    EXPECT_FALSE(simulation.asleep()) << name;
    const std::uint64_t computed = simulation.computedSteps();
    ASSERT_TRUE(simulation.step());
    EXPECT_EQ(simulation.computedSteps(), computed + 1) << name;
  }
  SimulatedCloth simulation = smallSimulation();
  stepUntilAsleep(simulation, 60.0);
  simulation.setPointLoads({});
  EXPECT_TRUE(simulation.asleep()) << "there were none before";
  simulation.setPointLoads({push});
  stepUntilAsleep(simulation, 60.0);
  simulation.setPointLoads({});
  EXPECT_FALSE(simulation.asleep()) << "the load has gone";
}

TEST(SleepingCloth, ARefusedChangeLetsItSleep) {
  SimulatedCloth simulation = smallSimulation();
  stepUntilAsleep(simulation, 60.0);
  EXPECT_THROW(simulation.attach({kSmallParticles}), std::invalid_argument);
  EXPECT_THROW(simulation.release({0}), std::invalid_argument);
  EXPECT_TRUE(simulation.asleep());
}

TEST(SleepingCloth, DoesNotSleepWhileSomethingOutsideMoves) {
  const auto sleeps_within = [](SimulatedCloth simulation, double seconds) {
    while (!simulation.asleep() && simulation.state().time < seconds) simulation.step();
    return simulation.asleep();
  };
  scene::Scene gusts = smallScene();
  gusts.effects.air = cloth::Air();
  gusts.effects.air->wind.gusts = {{{1e-6, 0.0, 0.0}, 0.01, 0.0}};
  EXPECT_FALSE(sleeps_within(SimulatedCloth(gusts, smallFabric()), 60.0));

  SimulatedCloth moved = smallSimulation();
  moved.move({kSmallTop}, {0.0, 0.0, 1e-3}, 1e6);  // which begins more slowly than a creep
  EXPECT_FALSE(sleeps_within(std::move(moved), 60.0));

  scene::Scene obstacles = smallScene();
  obstacles.effects.contacts = true;
  mesh::Obstacle ball{"ball", mesh::ObstacleSphere{0.01}, Eigen::Isometry3d::Identity()};
  ball.pose.translation() = Vector3d(0.5, 0.0, -0.1);  // it does not touch the cloth
  ball.friction = 0.2;
  obstacles.obstacles = {ball};
  EXPECT_TRUE(sleeps_within(SimulatedCloth(obstacles, smallFabric()), 60.0)) << "it rests";
  obstacles.obstacles[0].motion = mesh::ObstacleDrift{{1e-4, 0.0, 0.0}};
  EXPECT_FALSE(sleeps_within(SimulatedCloth(obstacles, smallFabric()), 60.0));
}

}  // namespace
}  // namespace haptex::simulation::test_sleeping_cloth
