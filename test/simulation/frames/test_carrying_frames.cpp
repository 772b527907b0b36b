#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "../../refusal.h"
#include "../small_scene.h"
#include "haptex/simulation/simulated_cloth.h"

namespace haptex::simulation::test_carrying_frames {
namespace {

using test::refusalOf;

using Eigen::Isometry3d;
using Eigen::Vector3d;

const Isometry3d kStart(Eigen::Translation3d(0.1, 0.2, 0.3));

/// smallScene() whose attached particles a frame carries instead of the world.
scene::Scene carriedScene() {
  scene::Scene scene = smallScene();
  scene::CarryingFrame frame{"bow", kStart, scene.attached_particles, {}};
  for (const int particle : frame.particles) {
    frame.places.push_back(kStart.inverse() * scene.mesh.initial_positions[particle]);
  }
  scene.frames = {frame};
  return scene;
}

SimulatedCloth carriedCloth() { return SimulatedCloth(carriedScene(), smallFabric()); }

TEST(CarryingFrames, TakeTheirParticlesAlongExactly) {
  SimulatedCloth simulation = carriedCloth();
  const std::vector<Vector3d> start = simulation.state().positions;
  Isometry3d motion = Isometry3d::Identity();
  for (int i = 0; i < 20; ++i) {
    motion = Eigen::Translation3d(0.002, 0.0, 0.001) * motion *
             Eigen::AngleAxisd(0.01, Vector3d(1, 2, 3).normalized());
    simulation.moveFrame(0, motion * kStart);
    ASSERT_TRUE(simulation.step());
    for (const int particle : simulation.frames().particles(0)) {
      EXPECT_LT((simulation.state().positions[particle] - motion * start[particle]).norm(), 1e-12);
    }
  }
}

TEST(CarryingFrames, GiveTheirParticlesTheirVelocity) {
  SimulatedCloth simulation = carriedCloth();
  const Vector3d way(0.001, 0.0, 0.0);
  for (int i = 1; i <= 3; ++i) {
    simulation.moveFrame(0, Eigen::Translation3d(i * way) * kStart);
    ASSERT_TRUE(simulation.step());
  }
  const int particle = simulation.frames().particles(0).front();
  EXPECT_LT((simulation.state().velocities[particle] - way / simulation.timeStep()).norm(), 1e-9);
  ASSERT_TRUE(simulation.step());
  EXPECT_EQ(simulation.state().velocities[particle], Vector3d(Vector3d::Zero()));
}

TEST(CarryingFrames, ThatAppearElsewhereDrawTheirParticlesAtABoundedSpeed) {
  SimulatedCloth simulation = carriedCloth();
  const int particle = simulation.frames().particles(0).front();
  const Vector3d start = simulation.state().positions[particle];
  simulation.moveFrame(0, Eigen::Translation3d(1.0, 0.0, 0.0) * kStart);
  ASSERT_TRUE(simulation.step());
  EXPECT_NEAR((simulation.state().positions[particle] - start).norm(),
              CarryingFrames::kFastest * simulation.timeStep(), 1e-9);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(simulation.step());
  EXPECT_LT((simulation.state().positions[particle] - start - Vector3d(1, 0, 0)).norm(), 1e-12);
}

TEST(CarryingFrames, FeelTheWeightOfClothAtRest) {
  SimulatedCloth simulation = carriedCloth();
  for (int i = 0; i < 2000; ++i) ASSERT_TRUE(simulation.step());
  std::vector<Vector3d> forces;
  simulation.cloth().computeForces(simulation.state(), forces);
  const FrameWrench wrench =
      simulation.frames().wrench(0, simulation.cloth(), simulation.state(), forces);
  double mass = 0.0;
  Vector3d moment = Vector3d::Zero();
  const Vector3d gravity(0, 0, -9.80665);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const double m = simulation.cloth().masses()[i];
    mass += m;
    moment += (simulation.state().positions[i] - kStart.translation()).cross(m * gravity);
  }
  EXPECT_LT((wrench.force - mass * gravity).norm(), 1e-6 * mass * 9.8);
  EXPECT_LT((wrench.torque - moment).norm(), 1e-6 * moment.norm());
}

TEST(CarryingFrames, FeelTheInertiaOfClothThatFallsWithThem) {
  SimulatedCloth simulation = carriedCloth();
  // Everything is accelerated alike, with gravity: nothing is strained, and nothing is felt.
  Vector3d velocity = Vector3d::Zero(), way = Vector3d::Zero();
  const double step = simulation.timeStep();
  for (int i = 0; i < 5; ++i) {
    velocity.z() -= 9.80665 * step;
    way += step * velocity;
    simulation.moveFrame(0, Eigen::Translation3d(way) * kStart);
    ASSERT_TRUE(simulation.step());
  }
  std::vector<Vector3d> forces;
  simulation.cloth().computeForces(simulation.state(), forces);
  const FrameWrench wrench =
      simulation.frames().wrench(0, simulation.cloth(), simulation.state(), forces);
  EXPECT_LT(wrench.force.norm(), 1e-6);
}

TEST(CarryingFrames, LetGoOfParticlesThatAreReleasedOrAttachedElsewhere) {
  SimulatedCloth simulation = carriedCloth();
  const std::vector<int> carried = simulation.frames().particles(0);
  ASSERT_GE(carried.size(), 3u);
  simulation.release({static_cast<std::uint32_t>(carried[0])});
  simulation.attach({static_cast<std::uint32_t>(carried[1])});
  const Vector3d held = simulation.state().positions[carried[1]];
  simulation.moveFrame(0, Eigen::Translation3d(0.01, 0.0, 0.0) * kStart);
  ASSERT_TRUE(simulation.step());
  EXPECT_EQ(simulation.frames().particles(0).size(), carried.size() - 2);
  EXPECT_FALSE(simulation.cloth().isAttached(carried[0]));
  EXPECT_EQ(simulation.state().positions[carried[1]], held);
  simulation.reset();
  EXPECT_EQ(simulation.frames().particles(0), carried);
}

TEST(CarryingFrames, CanTakeMoreParticlesWhileTheSceneRuns) {
  SimulatedCloth simulation = carriedCloth();
  const std::uint32_t last = static_cast<std::uint32_t>(simulation.cloth().particleCount() - 1);
  const Isometry3d hand(Eigen::Translation3d(1.0, 1.0, 1.0));
  simulation.attach({last}, "hand", hand);
  ASSERT_EQ(simulation.frames().size(), 2u);
  EXPECT_EQ(simulation.frames().name(1), "hand");
  const Vector3d before = simulation.state().positions[last];
  simulation.moveFrame(1, Eigen::Translation3d(0.0, 0.005, 0.0) * hand);
  ASSERT_TRUE(simulation.step());
  EXPECT_LT((simulation.state().positions[last] - before - Vector3d(0, 0.005, 0)).norm(), 1e-12);
}

TEST(CarryingFrames, WakeClothThatSleeps) {
  SimulatedCloth simulation = carriedCloth();
  for (int i = 0; i < 20000 && !simulation.asleep(); ++i) ASSERT_TRUE(simulation.step());
  ASSERT_TRUE(simulation.asleep());
  simulation.moveFrame(0, kStart);
  ASSERT_TRUE(simulation.step());
  EXPECT_TRUE(simulation.asleep());
  simulation.moveFrame(0, Eigen::Translation3d(0.001, 0.0, 0.0) * kStart);
  ASSERT_TRUE(simulation.step());
  EXPECT_FALSE(simulation.asleep());
}

TEST(CarryingFrames, RefusePosesThatAreNotFiniteOrFarAway) {
  SimulatedCloth simulation = carriedCloth();
  Isometry3d pose = kStart;
  pose.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(simulation.moveFrame(0, pose), std::invalid_argument);
  pose.translation().x() = 1e3;
  EXPECT_EQ(refusalOf([&] { simulation.moveFrame(0, pose); }),
            "the origin of frame 'bow' = (1000, 0.2, 0.3) m: allowed are finite components from "
            "-100 to 100 m");
  EXPECT_THROW(simulation.attach({0}, "hand", pose), std::invalid_argument);
  pose = kStart;
  pose.linear()(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusalOf([&] { simulation.moveFrame(0, pose); }),
            "the rotation of frame 'bow' is not finite: allowed are finite numbers");
  EXPECT_EQ(refusalOf([&] { simulation.attach({0}, "a/b", kStart); }),
            "frame = 'a/b': allowed is a letter, then letters, digits and _, up to 200 characters");
  EXPECT_EQ(simulation.frames().size(), 1u);
  EXPECT_TRUE(simulation.step());
}

}  // namespace
}  // namespace haptex::simulation::test_carrying_frames
