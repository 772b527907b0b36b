#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "haptex/simulation/force_sources.h"
#include "small_scene.h"

namespace haptex::simulation::test_force_sources {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 0.005;  // s, of smallScene()
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Vector3d kPush(0.02, -0.01, 0.03);  // N

ParticleForces forcesOn(const std::vector<std::uint32_t>& particles, double lifetime,
                        const Vector3d& force = kPush) {
  return {particles, std::vector<Vector3d>(particles.size(), force), lifetime};
}

/// The external force (N) on a particle: beside it only gravity acts where the cloth starts.
Vector3d forceOn(const SimulatedCloth& simulation, int particle) {
  const cloth::Cloth& cloth = simulation.cloth();
  std::vector<Vector3d> forces;
  cloth.computeForces(cloth.initialState(), forces);
  return forces[particle] - cloth.masses()[particle] * cloth.effects().gravity;
}

bool acts(const SimulatedCloth& simulation, int particle, const Vector3d& force) {
  return (forceOn(simulation, particle) - force).norm() < 1e-12;  // N, rounding of the flat sheet
}

void step(ForceSources& sources, SimulatedCloth& simulation, int steps = 1) {
  for (int i = 0; i < steps; ++i) {
    sources.apply(simulation);
    ASSERT_TRUE(simulation.step());
  }
}

class Forces : public testing::Test {
 protected:
  SimulatedCloth simulation_ = smallSimulation();
  ForceSources sources_{kSmallParticles};
};

TEST_F(Forces, OfAllSourcesAddUp) {
  sources_.set("wind", forcesOn({0, 1}, 1.0));
  sources_.set("magnet", forcesOn({1, 2}, 1.0, {0.0, 0.5, 0.0}));
  sources_.apply(simulation_);
  EXPECT_TRUE(acts(simulation_, 0, kPush));
  EXPECT_TRUE(acts(simulation_, 1, kPush + Vector3d(0.0, 0.5, 0.0)));
  EXPECT_TRUE(acts(simulation_, 2, {0.0, 0.5, 0.0}));
  EXPECT_TRUE(acts(simulation_, 3, Vector3d::Zero()));
  EXPECT_EQ(sources_.size(), 2u);
}

TEST_F(Forces, OfASourceReplaceItsEarlierOnesOnly) {
  sources_.set("wind", forcesOn({0, 1}, 1.0));
  sources_.set("magnet", forcesOn({1}, 1.0));
  sources_.apply(simulation_);
  sources_.set("wind", forcesOn({1, 3}, 1.0, {0.1, 0.0, 0.0}));
  sources_.set("wind", forcesOn({3}, 1.0, {0.2, 0.0, 0.0}));  // the newest counts
  sources_.apply(simulation_);
  EXPECT_TRUE(acts(simulation_, 0, Vector3d::Zero()));
  EXPECT_TRUE(acts(simulation_, 1, kPush));
  EXPECT_TRUE(acts(simulation_, 3, {0.2, 0.0, 0.0}));
}

// As long as is nearest to the lifetime, but for a step at least.
TEST_F(Forces, ActForTheirLifetimeInWholeSteps) {
  for (const auto& [lifetime, steps] : std::vector<std::pair<double, int>>{
           {1e-9, 1}, {kStep, 1}, {1.4 * kStep, 1}, {1.6 * kStep, 2}, {20 * kStep, 20}}) {
    sources_.set("wind", forcesOn({2}, lifetime));
    for (int i = 0; i < steps; ++i) {
      sources_.apply(simulation_);
      EXPECT_TRUE(acts(simulation_, 2, kPush)) << lifetime << " " << i;
      ASSERT_TRUE(simulation_.step());
    }
    sources_.apply(simulation_);
    EXPECT_TRUE(acts(simulation_, 2, Vector3d::Zero())) << lifetime;
    EXPECT_EQ(sources_.size(), 0u);
  }
}

TEST_F(Forces, LiveFromWhenTheyAreTakenAndNotWhileThereAreNoSteps) {
  sources_.set("wind", forcesOn({2}, 2 * kStep));
  EXPECT_TRUE(acts(simulation_, 2, Vector3d::Zero()));  // paused: nobody has taken them
  EXPECT_EQ(sources_.size(), 1u);
  step(sources_, simulation_, 2);
  EXPECT_TRUE(acts(simulation_, 2, kPush));
  sources_.set("wind", forcesOn({2}, 2 * kStep));  // another life
  step(sources_, simulation_, 2);
  EXPECT_TRUE(acts(simulation_, 2, kPush));
  step(sources_, simulation_);
  EXPECT_TRUE(acts(simulation_, 2, Vector3d::Zero()));
}

TEST_F(Forces, EndAtOnceWithLifetimeZeroOrWithoutParticles) {
  for (const ParticleForces& end : {forcesOn({0}, 0.0), forcesOn({}, 1.0)}) {
    sources_.set("wind", forcesOn({0}, 1.0));
    sources_.set("magnet", forcesOn({0}, 1.0));
    step(sources_, simulation_);
    sources_.set("wind", end);
    sources_.set("nobody", end);  // who has no forces
    sources_.apply(simulation_);
    EXPECT_TRUE(acts(simulation_, 0, kPush));
    EXPECT_EQ(sources_.size(), 1u);
  }
}

TEST_F(Forces, EndWithAReset) {
  sources_.set("wind", forcesOn({0}, 1.0));
  step(sources_, simulation_, 3);
  sources_.set("magnet", forcesOn({1}, 1.0));  // waits
  sources_.clear();
  simulation_.reset();
  SimulatedCloth fresh = smallSimulation();
  for (int i = 0; i < 5; ++i) {
    step(sources_, simulation_);
    ASSERT_TRUE(fresh.step());
  }
  EXPECT_EQ(simulation_.state().positions, fresh.state().positions);
  EXPECT_EQ(sources_.size(), 0u);
  sources_.set("magnet", forcesOn({0}, 1.0));
  sources_.apply(simulation_);
  EXPECT_TRUE(acts(simulation_, 0, kPush));  // nothing is left of the wind's
}

// A free cloth without gravity: its momentum is the force times how long it has acted.
TEST(ForceSources, GiveTheMomentumOfTheirForcesAndNoMoreEnergyThanTheirWork) {
  scene::Scene scene = smallScene();
  scene.attached_particles.clear();
  scene.effects.gravity.setZero();
  scene.step.tolerance = 1e-12;
  SimulatedCloth simulation(scene, smallFabric());
  ForceSources sources(kSmallParticles);
  sources.set("wind", forcesOn({3, 7}, 10 * kStep));
  double work = 0.0;  // J
  for (int i = 0; i < 15; ++i) {
    const std::vector<Vector3d> before = simulation.state().positions;
    step(sources, simulation);
    for (const int particle : {3, 7}) {
      work += kPush.dot(simulation.state().positions[particle] - before[particle]) * (i < 10);
    }
  }
  const Vector3d momentum = simulation.cloth().momentum(simulation.state());
  const Vector3d expected = 2.0 * 10.0 * kStep * kPush;
  EXPECT_LT((momentum - expected).norm(), 1e-9 * expected.norm());  // of the solver
  const double energy = simulation.cloth().kineticEnergy(simulation.state()) +
                        simulation.cloth().potentialEnergy(simulation.state());
  EXPECT_GT(energy, 0.0);
  EXPECT_LE(energy, work * (1.0 + 1e-9));
}

TEST_F(Forces, WakeAClothThatSleepsUnlessTheyAreTheSame) {
  material::Fabric fabric = smallFabric();
  for (material::MembraneCurves* curves : {&fabric.weft, &fabric.warp, &fabric.shear}) {
    curves->viscous = material::StrainStressCurve::linear(10.0);
  }
  scene::Scene scene = smallScene();
  scene.effects.viscosity = true;
  SimulatedCloth simulation(scene, fabric);
  const auto sleep = [&] {
    for (int i = 0; i < 20000 && !simulation.asleep(); ++i) step(sources_, simulation);
    return simulation.asleep();
  };
  sources_.set("wind", forcesOn({2}, 3600.0, {0.0, 0.0, -0.01}));
  ASSERT_TRUE(sleep());
  const double pulled = simulation.state().positions[2].z();
  sources_.set("wind", forcesOn({2}, 1.0, {0.0, 0.0, -0.01}));
  sources_.apply(simulation);
  EXPECT_TRUE(simulation.asleep());
  step(sources_, simulation, static_cast<int>(std::lround(1.0 / kStep)));
  EXPECT_TRUE(simulation.asleep());
  sources_.apply(simulation);  // the end of the second life
  EXPECT_FALSE(simulation.asleep());
  ASSERT_TRUE(sleep());
  EXPECT_GT(simulation.state().positions[2].z(), pulled + 1e-5);
}

TEST_F(Forces, AreRefusedForWhatIsWrongWithThem) {
  sources_.set("wind", forcesOn({0}, 1.0));
  const auto expect_refused = [&](const std::string& source, const ParticleForces& forces,
                                  const std::string& expected) {
    try {
      sources_.set(source, forces);
      FAIL() << "accepted, instead of: " << expected;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
    }
  };
  expect_refused("", forcesOn({1}, 1.0), "source is empty: allowed is");
  expect_refused("wind", forcesOn({1, kSmallParticles}, 1.0),
                 "particles[1] = 25 does not exist: allowed are 0 to 24");
  expect_refused("wind", forcesOn({4294967295u}, 1.0), "particles[0] = 4294967295 does not exist");
  expect_refused("wind", forcesOn({1, 2, 1}, 1.0), "particles[2] = 1 is named twice");
  ParticleForces forces = forcesOn({1, 2}, 1.0);
  forces.forces.pop_back();
  expect_refused("wind", forces, "forces has 1 elements and particles 2: allowed is one for each");
  for (const double number : {kNaN, kInfinity, -1000.5}) {
    forces = forcesOn({1, 2}, 1.0);
    forces.forces[1].y() = number;
    expect_refused("wind", forces, "forces[1] = (");
  }
  expect_refused("wind", forces, "allowed are finite components from -1000 to 1000 N");
  for (const double lifetime : {kNaN, kInfinity, -1e-9, 3601.0}) {
    expect_refused("wind", forcesOn({1}, lifetime), "allowed are finite numbers from 0 to 3600");
  }
  expect_refused("wind", forcesOn({}, -1.0), "lifetime = -1 s");
  sources_.apply(simulation_);
  EXPECT_TRUE(acts(simulation_, 0, kPush));  // what was there goes on
  EXPECT_TRUE(acts(simulation_, 1, Vector3d::Zero()));
}

TEST_F(Forces, AreRefusedOfASourceTooMany) {
  for (std::size_t i = 0; i < ForceSources::kMax; ++i) {
    sources_.set("source " + std::to_string(i), forcesOn({0}, i == 5 ? kStep : 1.0));
  }
  EXPECT_THROW(sources_.set("another", forcesOn({1}, 1.0)), std::invalid_argument);
  sources_.set("source 3", forcesOn({1}, 1.0));
  EXPECT_NO_THROW(sources_.set("another", forcesOn({1}, 0.0)));
  step(sources_, simulation_);
  EXPECT_THROW(sources_.set("another", forcesOn({1}, 1.0)), std::invalid_argument);
  sources_.apply(simulation_);  // the forces of source 5 end
  sources_.set("another", forcesOn({1}, 1.0));
  sources_.apply(simulation_);
  EXPECT_TRUE(acts(simulation_, 1, 2.0 * kPush));
}

}  // namespace
}  // namespace haptex::simulation::test_force_sources
