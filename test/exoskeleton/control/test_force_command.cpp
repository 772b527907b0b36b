#include <gtest/gtest.h>

#include <limits>

#include "haptex/exoskeleton/control/force_command.h"

namespace haptex::exoskeleton::test_force_command {
namespace {

using Eigen::Vector3d;

ForceCommand spring() {
  ForceCommand command;
  command.force = {0.0, 0.0, 1.0};
  command.position = {0.1, 0.0, 0.0};
  command.velocity = {0.0, 0.2, 0.0};
  command.stiffness = Vector3d(100.0, 200.0, 300.0).asDiagonal();
  command.damping = Vector3d(1.0, 2.0, 3.0).asDiagonal();
  return command;
}

TEST(ForceCommand, IsTheForceItselfWhereItWasLinearised) {
  const ForceCommand command = spring();
  EXPECT_EQ(evaluate(command, command.position, command.velocity), command.force);
}

TEST(ForceCommand, PushesAgainstDisplacementAndMotion) {
  const ForceCommand command = spring();
  const Vector3d dp(0.001, -0.002, 0.003), dv(0.01, 0.02, -0.03);
  const Vector3d expected = command.force - Vector3d(100.0, 200.0, 300.0).cwiseProduct(dp) -
                            Vector3d(1, 2, 3).cwiseProduct(dv);
  EXPECT_TRUE(
      evaluate(command, command.position + dp, command.velocity + dv).isApprox(expected, 1e-14));
}

TEST(ForceCommand, IsFiniteOnlyIfEveryNumberIs) {
  EXPECT_TRUE(isFinite(spring()));
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    ForceCommand command = spring();
    command.force.y() = bad;
    EXPECT_FALSE(isFinite(command));
    command = spring();
    command.position.x() = bad;
    EXPECT_FALSE(isFinite(command));
    command = spring();
    command.velocity.z() = bad;
    EXPECT_FALSE(isFinite(command));
    command = spring();
    command.stiffness(2, 0) = bad;
    EXPECT_FALSE(isFinite(command));
    command = spring();
    command.damping(1, 2) = bad;
    EXPECT_FALSE(isFinite(command));
  }
}

}  // namespace
}  // namespace haptex::exoskeleton::test_force_command
