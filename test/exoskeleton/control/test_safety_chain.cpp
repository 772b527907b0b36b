#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "haptex/exoskeleton/control/safety_chain.h"

namespace haptex::exoskeleton::test_safety_chain {
namespace {

using Eigen::Vector3d;
using std::chrono::milliseconds;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-12;  // N
const Vector3d kZero = Vector3d::Zero();

/// A chain ticked every millisecond.
struct Ticked {
  SafetyChain chain;
  Time now{milliseconds(1000)};
  Vector3d wanted = Vector3d::Zero();
  Vector3d velocity = Vector3d::Zero();
  bool commanded = true;

  Vector3d tick(int times = 1) {
    for (int i = 0; i < times; ++i) {
      now += milliseconds(1);
      if (commanded) chain.commandAccepted(now);
      chain.tick(wanted, velocity, now);
    }
    return chain.force();
  }

  /// Started and past the soft start.
  static Ticked rendering(const Vector3d& wanted) {
    Ticked ticked;
    ticked.tick();
    ticked.chain.start(ticked.now);
    ticked.wanted = wanted;
    ticked.tick(600);
    return ticked;
  }
};

TEST(SafetyChainStages, WhatIsNotFiniteBecomesZero) {
  bool finite = false;
  EXPECT_EQ(finiteOrZero({1.0, 2.0, 3.0}, finite), Vector3d(1.0, 2.0, 3.0));
  EXPECT_TRUE(finite);
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (int i = 0; i < 3; ++i) {
      Vector3d vector(1.0, 2.0, 3.0);
      vector[i] = bad;
      EXPECT_EQ(finiteOrZero(vector, finite), kZero);
      EXPECT_FALSE(finite);
    }
  }
}

TEST(SafetyChainStages, SaturationKeepsTheDirection) {
  EXPECT_EQ(saturated({3.0, 0.0, 4.0}, 5.0), Vector3d(3.0, 0.0, 4.0));
  EXPECT_TRUE(saturated({6.0, 0.0, 8.0}, 5.0).isApprox(Vector3d(3.0, 0.0, 4.0), 1e-15));
  EXPECT_TRUE(saturated({4.0, 4.0, 4.0}, 5.0).isApprox(Vector3d::Constant(5.0 / std::sqrt(3.0))));
  EXPECT_TRUE(saturated({6e300, 0.0, -8e300}, 5.0).isApprox(Vector3d(3.0, 0.0, -4.0), 1e-15));
  EXPECT_EQ(saturated(kZero, 5.0), kZero);
}

TEST(SafetyChainStages, SlewLimitIsOfTheVectorAndOfALateTickNoMoreThanOfTwoMilliseconds) {
  EXPECT_EQ(slewLimited({0.6, 0.0, 0.8}, kZero, 0.001), Vector3d(0.6, 0.0, 0.8));
  EXPECT_TRUE(slewLimited({3.0, 0.0, 4.0}, kZero, 0.001).isApprox(Vector3d(0.6, 0.0, 0.8), 1e-15));
  EXPECT_TRUE(slewLimited({3.0, 0.0, 4.0}, kZero, 0.05).isApprox(Vector3d(1.2, 0.0, 1.6), 1e-15));
  EXPECT_EQ(slewLimited({3.0, 0.0, 4.0}, kZero, 0.0), kZero);
  EXPECT_EQ(slewLimited({3.0, 0.0, 4.0}, kZero, -1.0), kZero);
}

TEST(SafetyChainStages, SoftStartIsAStraightLineOfHalfASecond) {
  EXPECT_EQ(softStartGain(-1.0), 0.0);
  EXPECT_EQ(softStartGain(0.0), 0.0);
  EXPECT_DOUBLE_EQ(softStartGain(0.125), 0.25);
  EXPECT_EQ(softStartGain(0.5), 1.0);
  EXPECT_EQ(softStartGain(9.0), 1.0);
}

TEST(SafetyChainStages, RampDownIsAStraightLineWhateverTheTicks) {
  const Vector3d force(0.0, 4.0, 0.0);
  const Time end = milliseconds(5);
  Vector3d now = rampedDown(force, milliseconds(0), milliseconds(1), end);
  EXPECT_NEAR(now.y(), 3.2, 1e-12);
  now = rampedDown(now, milliseconds(1), milliseconds(4), end);
  EXPECT_NEAR(now.y(), 0.8, 1e-12);
  EXPECT_EQ(rampedDown(now, milliseconds(4), milliseconds(5), end), kZero);
  EXPECT_EQ(rampedDown(force, milliseconds(7), milliseconds(8), end), kZero);
}

TEST(SafetyChain, LetsAHarmlessForceThrough) {
  Ticked ticked = Ticked::rendering({1.0, -2.0, 3.0});
  EXPECT_EQ(ticked.chain.force(), Vector3d(1.0, -2.0, 3.0));
  const SafetyStatistics& statistics = ticked.chain.statistics();
  EXPECT_EQ(statistics.not_finite, 0u);
  EXPECT_EQ(statistics.saturated, 0u);
  EXPECT_EQ(statistics.slew_limited, 3u);  // from 0 to the norm of 3.7 N at the start
  EXPECT_EQ(statistics.watchdog_trips, 0u);
}

TEST(SafetyChain, GivesNothingBeforeItIsStartedAndAfterItIsStopped) {
  Ticked ticked;
  ticked.wanted = {3.0, 0.0, 0.0};
  EXPECT_EQ(ticked.tick(50), kZero);
  ticked = Ticked::rendering({3.0, 0.0, 0.0});
  ticked.chain.stop();
  EXPECT_NEAR(ticked.tick().x(), 2.0, kRounding);
  EXPECT_EQ(ticked.tick(2), kZero);
}

TEST(SafetyChain, NotFiniteForcesAndVelocitiesAreCountedAndGiveNothing) {
  Ticked ticked = Ticked::rendering({3.0, 0.0, 0.0});
  ticked.wanted.y() = kNan;
  EXPECT_NEAR(ticked.tick().x(), 2.0, kRounding);
  EXPECT_EQ(ticked.tick(2), kZero);
  EXPECT_EQ(ticked.chain.statistics().not_finite, 3u);
  ticked.wanted = {0.5, 0.0, 0.0};
  ticked.velocity.z() = kInfinity;
  EXPECT_EQ(ticked.tick(), ticked.wanted);  // the force itself is sound
  EXPECT_EQ(ticked.chain.statistics().not_finite, 4u);
  ticked.chain.countNotFinite();
  EXPECT_EQ(ticked.chain.statistics().not_finite, 5u);
}

TEST(SafetyChain, SaturatesAtFiveNewtonsAndCounts) {
  Ticked ticked = Ticked::rendering({60.0, 0.0, 80.0});
  EXPECT_TRUE(ticked.chain.force().isApprox(Vector3d(3.0, 0.0, 4.0), 1e-12));
  EXPECT_LE(ticked.chain.force().norm(), kMaxForce * (1.0 + 1e-15));
  EXPECT_EQ(ticked.chain.statistics().saturated, 600u);
}

TEST(SafetyChain, StartsSoftly) {
  Ticked ticked;
  ticked.tick();
  ticked.chain.start(ticked.now);
  ticked.wanted = {0.0, 4.0, 0.0};
  EXPECT_NEAR(ticked.tick(250).y(), 2.0, 1e-12);
  EXPECT_NEAR(ticked.tick(125).y(), 3.0, 1e-12);
  EXPECT_EQ(ticked.tick(125), ticked.wanted);
}

TEST(SafetyChain, PassivityIsControlledBeforeTheSoftStart) {
  // The damping of a fast finger would be 1.5 N; the soft start has let 1 % through.
  Ticked ticked;
  ticked.tick();
  ticked.chain.start(ticked.now);
  ticked.wanted = {4.0, 0.0, 0.0};
  ticked.velocity = {0.5, 0.0, 0.0};
  ticked.tick(5);
  EXPECT_NEAR(ticked.chain.force().x(), 0.01 * (4.0 - 0.5 * 3.0), 0.005);
  EXPECT_GT(ticked.chain.statistics().passivity_limited, 0u);
  EXPECT_LT(ticked.chain.statistics().observed_energy, 0.0);
}

TEST(SafetyChain, HoldsForTwelveMillisecondsAndIsZeroEighteenAfterTheLastCommand) {
  Ticked ticked = Ticked::rendering({3.0, 0.0, -4.0});
  ticked.commanded = false;
  EXPECT_TRUE(ticked.tick(12).isApprox(ticked.wanted)) << "too early";
  EXPECT_FALSE(ticked.chain.commandsStopped());
  for (const double share : {0.9, 0.7, 0.5, 0.3, 0.1}) {
    EXPECT_TRUE(ticked.tick().isApprox(share * ticked.wanted, 1e-12));
    EXPECT_TRUE(ticked.chain.commandsStopped());
  }
  EXPECT_EQ(ticked.tick(), kZero);
  EXPECT_EQ(ticked.tick(100), kZero);
  EXPECT_EQ(ticked.chain.statistics().watchdog_trips, 1u);
}

TEST(SafetyChain, ASmallForceIsHeldForLongerAndEndsAtTheSameTime) {
  Ticked ticked = Ticked::rendering({1.6, 0.0, 0.0});
  ticked.commanded = false;
  EXPECT_EQ(ticked.tick(15), ticked.wanted);
  ticked.wanted = {1.2, 0.0, 0.0};  // the command that is held, at another place
  EXPECT_EQ(ticked.tick(), ticked.wanted);
  EXPECT_NEAR(ticked.tick().x(), 0.5, kRounding);
  EXPECT_FALSE(ticked.chain.commandsExpired());
  EXPECT_EQ(ticked.tick(), kZero);
  EXPECT_TRUE(ticked.chain.commandsExpired());
}

TEST(SafetyChain, ADeadCommandersForceGoesToZeroAtOnceAtTheSlewLimit) {
  for (const double force : {5.0, 3.0, 0.5}) {
    Ticked ticked = Ticked::rendering({force, 0.0, 0.0});
    ticked.commanded = false;
    ticked.tick(3);
    ticked.chain.commanderDied(ticked.now);
    ticked.chain.commanderDied(ticked.now + milliseconds(4));  // said twice: nothing is prolonged
    for (double left = force - 1.0; left > 0.0; left -= 1.0) {
      EXPECT_NEAR(ticked.tick().x(), left, 1e-6) << force;
    }
    EXPECT_EQ(ticked.tick(), kZero) << force;
    EXPECT_TRUE(ticked.chain.commandsExpired());
    EXPECT_EQ(ticked.chain.statistics().watchdog_trips, 1u);
    ticked.commanded = true;  // another one commands
    EXPECT_GT(ticked.tick(2).x(), 0.0);
  }
}

TEST(SafetyChain, WatchdogIsExactForTicksOutOfStep) {
  // The last command came 0.9 ms before a tick: the fraction of a period must not cost a tick.
  Ticked ticked = Ticked::rendering({5.0, 0.0, 0.0});
  ticked.commanded = false;
  const Time last = ticked.now + std::chrono::microseconds(100);
  ticked.chain.commandAccepted(last);
  while (ticked.chain.force() != kZero) ticked.tick();
  EXPECT_LE(ticked.now - last, kCommandTimeout + kWatchdogRamp + milliseconds(1));
  EXPECT_GE(ticked.now - last, kCommandTimeout + kWatchdogRamp);
}

TEST(SafetyChain, ReturningCommandsRampUpWithinEightyMilliseconds) {
  Ticked ticked = Ticked::rendering({3.0, 0.0, 0.0});
  ticked.commanded = false;
  ticked.tick(30);
  ticked.commanded = true;
  EXPECT_EQ(ticked.tick(), kZero);
  EXPECT_NEAR(ticked.tick(16).x(), 0.6, kRounding);
  EXPECT_NEAR(ticked.tick(48).x(), 2.4, kRounding);
  EXPECT_NEAR(ticked.tick(16).x(), 3.0, kRounding);
  ticked.commanded = false;
  ticked.tick(16);
  EXPECT_NEAR(ticked.chain.force().x(), 1.5, kRounding);
  ticked.commanded = true;
  EXPECT_NEAR(ticked.tick().x(), 2.5, kRounding) << "in the middle of the ramp";
  EXPECT_EQ(ticked.chain.statistics().watchdog_trips, 2u);
}

TEST(SafetyChain, ComesBackWithinEightyMillisecondsAfterAnInterruption) {
  Ticked ticked = Ticked::rendering({3.0, 0.0, 0.0});
  ticked.chain.interrupt();
  EXPECT_NEAR(ticked.tick().x(), 2.0, kRounding) << "at the slew limit";
  EXPECT_NEAR(ticked.tick(40).x(), 1.5, kRounding);
  EXPECT_EQ(ticked.tick(40), ticked.wanted);
}

TEST(SafetyChain, AfterALateTickItGoesOnFromWhatTheDevicesWatchdogHasLeft) {
  // From 14 to 19 ms after the last command the device goes to zero.
  for (const auto& [period, left] : {std::pair{14.0, 1.0}, {15.0, 0.8}, {18.0, 0.2}, {30.0, 0.0}}) {
    Ticked ticked = Ticked::rendering({2.0, 0.0, 0.0});
    ticked.now += std::chrono::microseconds(static_cast<int>(1000 * (period - 1.0)));
    EXPECT_NEAR(ticked.tick().x(), 2.0 * left, 1e-6) << period;
    EXPECT_NEAR(ticked.tick(8).x(), std::min(2.0, 2.0 * left + 0.2), 1e-6) << period;
  }
}

TEST(SafetyChain, CommandsBeforeAStartDoNotCount) {
  Ticked ticked;
  ticked.wanted = {1.0, 0.0, 0.0};
  ticked.tick();
  ticked.chain.start(ticked.now);
  ticked.commanded = false;
  EXPECT_EQ(ticked.tick(5), kZero);
  EXPECT_TRUE(ticked.chain.commandsStopped());
  EXPECT_EQ(ticked.chain.statistics().watchdog_trips, 0u) << "no force was rendered";
}

TEST(SafetyChain, LatchedFaultEndsTheForceWithinFiveMillisecondsUntilItIsCleared) {
  Ticked ticked = Ticked::rendering({0.0, 5.0, 0.0});
  ticked.chain.latchFault();
  for (const double left : {4.0, 3.0, 2.0, 1.0}) EXPECT_NEAR(ticked.tick().y(), left, kRounding);
  EXPECT_EQ(ticked.tick(), kZero);
  ticked.chain.latchFault();  // again, while it is latched
  EXPECT_EQ(ticked.tick(100), kZero);
  EXPECT_TRUE(ticked.chain.faultLatched());
  ticked.chain.clearFault();
  EXPECT_NEAR(ticked.tick().y(), 1.0, kRounding);
}

TEST(SafetyChain, FaultDuringTheWatchdogsRampDoesNotProlongIt) {
  Ticked ticked = Ticked::rendering({0.0, 5.0, 0.0});
  ticked.commanded = false;
  ticked.tick(15);
  ticked.chain.latchFault();
  EXPECT_NEAR(ticked.tick().y(), 1.5, kRounding);
  EXPECT_EQ(ticked.tick(2), kZero);
}

TEST(SafetyChain, StaysAsItIsIfTimeStandsStillOrGoesBack) {
  Ticked ticked = Ticked::rendering({2.0, 0.0, 0.0});
  ticked.wanted = {0.0, 2.0, 0.0};
  EXPECT_EQ(ticked.chain.tick(ticked.wanted, kZero, ticked.now), Vector3d(2.0, 0.0, 0.0));
  EXPECT_EQ(ticked.chain.tick(ticked.wanted, kZero, ticked.now - milliseconds(9)),
            Vector3d(2.0, 0.0, 0.0));
}

/// Anything at all, often at the edges.
class Chaos {
 public:
  explicit Chaos(unsigned seed) : generator_(seed) {}

  double number() {
    static constexpr double kOdd[] = {kNan,  kInfinity, -kInfinity, 1e300, -1e300,
                                      1e308, 5.0,       5e-324,     0.0,   -0.0};
    if (chance(0.02)) return kOdd[generator_() % 10];
    return chance(0.1) ? 1000.0 * normal_(generator_) : 4.0 * normal_(generator_);
  }
  Vector3d vector() { return {number(), number(), number()}; }
  bool chance(double probability) {
    return std::uniform_real_distribution<double>()(generator_) < probability;
  }
  /// From 0.1 to 50 ms, mostly short.
  Time period() {
    const double exponent = std::pow(std::uniform_real_distribution<double>()(generator_), 3);
    return Time(static_cast<Time::rep>(1e5 * std::pow(500.0, exponent)));
  }

 private:
  std::mt19937_64 generator_;
  std::normal_distribution<double> normal_;
};

TEST(SafetyChain, WhateverHappensItIsFiniteBoundedAndDoesNotJump) {
  Chaos chaos(11);
  SafetyChain chain;
  Time now = milliseconds(5);
  Vector3d wanted = Vector3d::Zero();
  Vector3d before = chain.tick(wanted, kZero, now);
  bool commanded = true;
  double largest = 0.0, fastest = 0.0;
  for (int i = 0; i < 1000000; ++i) {
    if (chaos.chance(0.002)) chain.start(now);
    if (chaos.chance(0.0002)) chain.stop();
    if (chaos.chance(0.001)) chain.latchFault();
    if (chaos.chance(0.01)) chain.clearFault();
    if (chaos.chance(0.001)) chain.commanderDied(now);
    if (chaos.chance(0.01)) commanded = !commanded;
    if (commanded) chain.commandAccepted(now);
    if (chaos.chance(0.3)) wanted = chaos.vector();
    const Time period = chaos.period();
    now += period;
    const Vector3d force = chain.tick(wanted, 0.1 * chaos.vector(), now);
    ASSERT_TRUE(force.allFinite()) << i;
    const double allowed = kMaxSlew * std::min(seconds(period), kLongestSlew);
    ASSERT_LE((force - before).norm(), allowed + kRounding) << i;
    largest = std::max(largest, force.norm());
    fastest = std::max(fastest, (force - before).norm() / allowed);
    before = force;
  }
  EXPECT_LE(largest, kMaxForce + kRounding);
  EXPECT_GT(largest, 0.99 * kMaxForce) << "the test did not go to the limits";
  EXPECT_GT(fastest, 0.999) << "the test did not go to the limits";
  EXPECT_GT(chain.statistics().watchdog_trips, 100u);
  EXPECT_GT(chain.statistics().not_finite, 1000u);
}

TEST(SafetyChain, WhateverHappensTheWatchdogEndsIt) {
  Chaos chaos(12);
  SafetyChain chain;
  Time now = milliseconds(5);
  chain.tick(kZero, kZero, now);
  chain.start(now);
  now += milliseconds(600);
  for (int trial = 0; trial < 5000; ++trial) {
    for (int i = 0; i < 12; ++i) {
      now += milliseconds(1);
      chain.commandAccepted(now);
      chain.tick(chaos.vector(), 0.1 * chaos.vector(), now);
    }
    const Time last = now;
    const int fault_at = static_cast<int>(20 * std::abs(std::sin(trial)));
    while (now < last + milliseconds(18)) {
      now += milliseconds(1);
      if (now - last == milliseconds(fault_at)) chain.latchFault();
      chain.tick(chaos.vector(), 0.1 * chaos.vector(), now);
    }
    ASSERT_EQ(chain.force(), kZero) << trial;
    chain.clearFault();
  }
}

}  // namespace
}  // namespace haptex::exoskeleton::test_safety_chain
