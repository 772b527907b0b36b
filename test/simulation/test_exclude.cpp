#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/scene/scene.h"
#include "haptex/scene/scene_fabric.h"
#include "haptex/simulation/particle_requests.h"
#include "step_plans.h"

namespace haptex::simulation::test_exclude {
namespace {

using Eigen::Vector3d;

/// The two left columns of the small scene, without the attached corner.
const std::vector<std::uint32_t> kLeft = {0, 1, 5, 6, 10, 11, 15, 16};

SimulatedCloth moving() {
  SimulatedCloth simulation = smallSimulation(true);
  simulation.setExternalForce(2, {0.05, 0.0, 0.0});
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(simulation.step());
  return simulation;
}

double largestWay(const SimulatedCloth& simulation, const std::vector<Vector3d>& before) {
  double way = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    way = std::max(way, (simulation.state().positions[i] - before[i]).norm());
  }
  return way;
}

TEST(Exclude, TheRestMovesAsWithThoseAttached) {
  for (const bool hysteresis : {false, true}) {
    scene::Scene scene = smallScene();
    scene.effects.bending = scene.effects.bending_hysteresis = hysteresis;
    scene.step.tolerance = 1e-12;
    SimulatedCloth excluding(scene, smallFabric()), attaching(scene, smallFabric());
    for (SimulatedCloth* cloth : {&excluding, &attaching}) {
      cloth->setExternalForce(2, {0.05, 0.0, 0.0});
      for (int i = 0; i < 20; ++i) ASSERT_TRUE(cloth->step());
      cloth->setState(kLeft, {}, std::vector<Vector3d>(kLeft.size(), Vector3d::Zero()));
    }
    excluding.exclude(kLeft);
    attaching.attach(kLeft);
    for (int i = 0; i < 100; ++i) {
      ASSERT_TRUE(excluding.step());
      ASSERT_TRUE(attaching.step());
    }
    EXPECT_EQ(excluding.state().time, attaching.state().time);
    for (std::size_t i = 0; i < kSmallParticles; ++i) {
      EXPECT_LT((excluding.state().positions[i] - attaching.state().positions[i]).norm(), 1e-9)
          << i;
    }
  }
}

TEST(Exclude, NothingJumpsOutOrIn) {
  SimulatedCloth simulation = moving();
  std::vector<Vector3d> before = simulation.state().positions;
  const std::vector<double> remembered = simulation.state().memory;
  simulation.exclude(kLeft);
  EXPECT_EQ(simulation.state().positions, before);
  EXPECT_EQ(simulation.state().memory, remembered);
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(simulation.step());
  for (const std::uint32_t particle : kLeft) {
    EXPECT_EQ(simulation.state().positions[particle], before[particle]);
    EXPECT_TRUE(simulation.cloth().isAttached(static_cast<int>(particle)));
  }
  before = simulation.state().positions;
  const std::vector<double> held = simulation.state().memory;
  simulation.include({});
  EXPECT_TRUE(simulation.excluded().empty());
  EXPECT_EQ(simulation.state().positions, before);
  EXPECT_EQ(simulation.state().memory, held);
  EXPECT_FALSE(simulation.cloth().isAttached(0));
  ASSERT_TRUE(simulation.step());
  // From rest: what gravity and the pull of the neighbours, at most ten times that, do in a step.
  EXPECT_LT(largestWay(simulation, before), 10.0 * 9.81 * 0.005 * 0.005 + 1e-4);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(simulation.step());
  EXPECT_GT((simulation.state().positions[0] - before[0]).norm(), 1e-6);
}

TEST(Exclude, AttachedOnesComeBackAttached) {
  SimulatedCloth simulation = moving();
  simulation.move({kSmallTop}, {0.0, 0.05, 0.0}, 1.0);
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(simulation.step());
  const Vector3d place = simulation.state().positions[kSmallTop];
  simulation.exclude({kSmallTop, 15});
  simulation.exclude({15, 16});
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(simulation.step());
  simulation.include({kSmallTop, 15});
  EXPECT_EQ(simulation.excluded()[16] != 0, true);
  ASSERT_TRUE(simulation.step());
  EXPECT_EQ(simulation.state().positions[kSmallTop], place);
  EXPECT_TRUE(simulation.cloth().isAttached(kSmallTop));
  EXPECT_FALSE(simulation.cloth().isAttached(15));
  EXPECT_TRUE(simulation.cloth().isAttached(16));
}

TEST(Exclude, EveryPlanGoesOn) {
  SimulatedCloth simulation = plannedSimulation(severalPlans(), true);
  simulation.exclude({0, 1});
  for (std::size_t plan = 0; plan < severalPlans().size(); ++plan) {
    simulation.use(plan);
    for (int i = 0; i < 5; ++i) ASSERT_TRUE(simulation.step()) << plan;
  }
}

TEST(Exclude, LoadsForcesAndFabricsReachTheRestAlone) {
  SimulatedCloth simulation = moving();
  simulation.exclude(kLeft);
  const Vector3d still = simulation.state().positions[0];
  const Vector3d free = simulation.state().positions[4];
  simulation.setExternalForce(0, {1.0, 0.0, 0.0});
  simulation.setExternalForce(4, {1.0, 0.0, 0.0});
  simulation.setPointLoads(
      {{0, Vector3d(0.2, 0.3, 0.5), still, Vector3d(0.1, 0, 0), Eigen::Matrix3d::Identity()}});
  simulation.setFabric(smallFabric());
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(simulation.step());
  EXPECT_EQ(simulation.state().positions[0], still);
  EXPECT_GT(simulation.state().positions[4].x(), free.x() + 0.01);
}

TEST(Exclude, ResetTakesAllInAgain) {
  SimulatedCloth simulation = moving(), other = smallSimulation(true);
  simulation.exclude(kLeft);
  simulation.reset();
  EXPECT_TRUE(simulation.excluded().empty());
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(simulation.step());
    ASSERT_TRUE(other.step());
  }
  EXPECT_EQ(simulation.state().positions, other.state().positions);
}

TEST(Exclude, BadRequestsChangeNothing) {
  const auto expectRefused = [](const std::function<void(SimulatedCloth&)>& request,
                                const std::string& expected) {
    const auto halfExcluded = [] {
      SimulatedCloth cloth = moving();
      cloth.exclude(kLeft);
      return cloth;
    };
    simulation::expectRefused(halfExcluded, request, expected);
  };
  std::vector<std::uint32_t> all(kSmallParticles);
  std::iota(all.begin(), all.end(), 0u);
  expectRefused([](auto& cloth) { cloth.exclude({}); }, "particles is empty");
  expectRefused([](auto& cloth) { cloth.exclude({25}); }, "particles[0] = 25 does not exist");
  expectRefused([](auto& cloth) { cloth.include({25}); }, "particles[0] = 25 does not exist");
  expectRefused([&](auto& cloth) { cloth.exclude(all); }, "all 25 particles would be excluded");
  const std::string excluded = "particles[0] = 1 is excluded from the computation";
  expectRefused([](auto& cloth) { cloth.attach({1}); }, excluded);
  expectRefused([](auto& cloth) { cloth.attach({1}, {Vector3d::Zero()}); }, excluded);
  expectRefused([](auto& cloth) { cloth.release({1}); }, excluded);
  expectRefused([](auto& cloth) { cloth.move({1}, Vector3d::Zero(), 0.0); }, excluded);
  expectRefused([](auto& cloth) { cloth.setState({1}, {Vector3d::Zero()}, {}); },
                "or include it first");
}

using Particles = std::vector<std::uint32_t>;

/// 4 x 2 cells of 10 mm.
const mesh::ClothMesh kSheet =
    mesh::makeRectangle(0.04, 0.02, 4, 2, mesh::Triangulation::kAlternating);

TEST(SelectedParticles, AreThoseNamedAndThoseInTheRegionWithItsBorders) {
  EXPECT_EQ(selectedParticles(kSheet, {7, 2}, {}, {}), (Particles{7, 2}));
  EXPECT_EQ(selectedParticles(kSheet, {}, {}, {}), Particles{});
  EXPECT_EQ(selectedParticles(kSheet, {}, {0.01, 0.03}, {0.0, 0.01}),
            (Particles{1, 2, 3, 6, 7, 8}));
  EXPECT_EQ(selectedParticles(kSheet, {8, 0}, {0.03, 0.04}, {0.01, 0.01}), (Particles{8, 0, 9}));
}

TEST(SelectedParticles, AreRefusedWithWhatIsAllowed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expectRefused = [](const Particles& particles, const std::vector<double>& weft,
                                const std::vector<double>& warp, const std::string& expected) {
    try {
      selectedParticles(kSheet, particles, weft, warp);
      FAIL() << "accepted, instead of: " << expected;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
    }
  };
  expectRefused({15}, {}, {}, "particles[0] = 15 does not exist: allowed are 0 to 14");
  expectRefused({1, 1}, {}, {}, "is named twice");
  expectRefused({1}, {0.0, 0.1}, {}, "region: warp = [] m: allowed are two finite numbers");
  expectRefused({1}, {0.0, nan}, {0.0, 0.1}, "region: weft = [0, nan] m");
  expectRefused({1}, {0.2, 0.1}, {0.0, 0.1}, "region: weft = [0.2, 0.1] m");
  expectRefused({}, {0.5, 0.6}, {0.0, 0.1}, "no particle lies in the region");
}

}  // namespace
}  // namespace haptex::simulation::test_exclude
