#include <gtest/gtest.h>

#include <stdexcept>

#include "haptex/nodes/cloth_simulation/external_force_input.h"

namespace haptex::nodes::test_force_input {
namespace {

TEST(ExternalForceMessages, KeepEveryNumberInItsPlace) {
  haptex::ExternalForces message;
  message.header.frame_id = "world";
  message.particles = {7, 3};
  message.forces.resize(2);
  message.forces[0].x = 0.5;
  message.forces[1].z = -0.25;
  message.lifetime = 1.5;
  const simulation::ParticleForces forces = particleForces(message);
  EXPECT_EQ(forces.particles, message.particles);
  ASSERT_EQ(forces.forces.size(), 2u);
  EXPECT_EQ(forces.forces[0], Eigen::Vector3d(0.5, 0.0, 0.0));
  EXPECT_EQ(forces.forces[1], Eigen::Vector3d(0.0, 0.0, -0.25));
  EXPECT_EQ(forces.lifetime, 1.5);
  message.header.frame_id = "map";
  EXPECT_THROW(particleForces(message), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::nodes::test_force_input
