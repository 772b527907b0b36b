#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "../exoskeleton/shipped_urdf.h"
#include "haptex/base/workload.h"
#include "haptex/exoskeleton/emulator/hand_path.h"
#include "haptex/oracles/experiments/virtual_wall.h"

namespace haptex::oracles::test_virtual_wall {
namespace {

using base::Finger;
using base::kFingers;
using base::PerFinger;

PerFinger<WallTouch> touch(const VirtualWall& wall, int cycles) {
  const auto open =
      exoskeleton::loadHandPath(HAPTEX_SOURCE_DIRECTORY "/config/paths/pinch.yaml").at(1.5);
  return touchWalls(exoskeleton::shippedUrdf(), {}, open.fingertips, {{wall, wall}}, cycles);
}

TEST(VirtualWall, IsSteadyAndPassiveWhereItsLinearisationIsSent) {
  const auto touches = touch({1000.0, 0.0, true, 3}, base::unlessSanitized(5, 2));
  for (const Finger finger : kFingers) {
    EXPECT_TRUE(touches[finger].steady()) << name(finger);
    EXPECT_TRUE(touches[finger].observedPassive()) << name(finger);
    // What is given goes into the damping of the person's finger, which takes 5 N s/m times the
    // integral of the squared speed, 2 * 10/7 * (11 mm)^2 / 0.2 s: 9 mJ.
    EXPECT_LT(touches[finger].given_energy, 9e-3) << name(finger);
  }
}

TEST(VirtualWall, OscillatesWhereItIsStifferThanTheDeviceCanBe) {
  const auto touches = touch({4000.0, 0.0, true, 0}, 1);
  for (const Finger finger : kFingers) EXPECT_GT(touches[finger].ripple, 0.1) << name(finger);
}

TEST(VirtualWall, NeedsThePassivityControllerWhereOnlyItsForceIsSent) {
  const auto touches = touch({600.0, 0.0, false, 0}, base::unlessSanitized(3, 1));
  for (const Finger finger : kFingers) {
    EXPECT_FALSE(touches[finger].observedPassive()) << name(finger);
    EXPECT_GT(touches[finger].controller_share, 0.1) << name(finger);
  }
}

TEST(VirtualWall, RefusesNumbersThatNoWallHas) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const VirtualWall& wall : {VirtualWall{0.0, 0.0, true, 0}, VirtualWall{nan, 0.0, true, 0},
                                  VirtualWall{1.0, -1.0, true, 0}, VirtualWall{1.0, nan, true, 0},
                                  VirtualWall{1.0, 0.0, true, -1}}) {
    EXPECT_THROW(touch(wall, 1), std::invalid_argument);
  }
}

}  // namespace
}  // namespace haptex::oracles::test_virtual_wall
