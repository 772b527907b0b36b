// What the whole loop promises while 3 N are commanded, whatever happens to it. In simulated time.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <iostream>
#include <limits>
#include <string>

#include "haptex/base/workload.h"
#include "haptex/exoskeleton/emulator/hand_path.h"
#include "haptex/oracles/experiments/device/stalled_hold.h"
#include "haptex/oracles/experiments/exoskeleton_loop.h"
#include "shipped_urdf.h"

namespace haptex::exoskeleton::test_faults {
namespace {

using Eigen::Vector3d;
using oracles::ExoskeletonLoop;
using oracles::LoopSample;
using std::chrono::milliseconds;

constexpr double kCommanded = 3.0;  // N
/// N per millisecond. The safety chain lets through 1; feedback on the force sensor, damping, the
/// motion of the finger while a torque stays, and the rounding of torques come on top.
constexpr double kMaxChange = 1e-3 * kMaxSlew + 0.15;
/// N, 20 ms after the commander's death. The motors are off for 13 ms then; the person's finger
/// returns from a deflection of 7.5 mm and accelerates 9 to 12 g of device and rotors, whose weight
/// and friction it always feels. Motors that are off at once leave 0.32 N (validate exoskeleton).
constexpr double kLeftAfterCommander = 0.45;
/// N, the weight of the links and the friction of the transmissions, which stay for ever.
constexpr double kWeightAndFriction = 0.25;

/// A command of 22 bytes on the line, and steps of the device: the firmware counts from the last
/// command that it got.
constexpr Time kOnTheLine = std::chrono::microseconds(375);

/// Of the driver's period, at which commander or driver end: quarters of it.
constexpr int kMoments = base::unlessSanitized(4, 1);

/// What the fingers felt at worst.
struct Worst {
  double contact_force = 0.0;  ///< N
  double change = 0.0;         ///< N per millisecond, of the motor force
  bool finite = true;
  Time motors_on{0};  ///< when there was a motor force last
};

/// Where the fingertips are for taking the sample (m, frame of the hand).
PerFinger<Vector3d> openHand() {
  return loadHandPath(HAPTEX_SOURCE_DIRECTORY "/config/paths/pinch.yaml").at(1.5).fingertips;
}

/// Two fingers as far apart as for taking the sample, pushed apart by what is commanded.
class FaultyLoop {
 public:
  explicit FaultyLoop(unsigned seed = 1) : loop(shippedUrdf(), seed) {
    const PerFinger<Vector3d> open = openHand();
    const Vector3d& index = open[Finger::kIndex];
    const Vector3d& thumb = open[Finger::kThumb];
    apart_ = (index - thumb).normalized();
    loop.device().setTarget(Finger::kIndex, index);
    loop.device().setTarget(Finger::kThumb, thumb);
    loop.makeReady();
    command(kCommanded);
    loop.run(milliseconds(1500));
  }

  /// Pushes the fingers apart (N).
  void command(double force) {
    loop.setCommander([this, force](Finger finger, Time) {
      ForceCommand command;
      command.force = force * direction(finger);
      return command;
    });
  }

  Vector3d direction(Finger finger) const { return finger == Finger::kIndex ? apart_ : -apart_; }

  Worst watch(Time duration) {
    Worst worst;
    PerFinger<std::deque<Vector3d>> millisecond;
    loop.run(duration, [&](const ExoskeletonLoop& now) {
      for (const Finger finger : kFingers) {
        const LoopSample sample = now.sample(finger);
        std::deque<Vector3d>& forces = millisecond[finger];
        forces.push_back(sample.motor_force);
        if (forces.size() > ExoskeletonLoop::kStepsPerTick + 1) forces.pop_front();
        worst.contact_force = std::max(worst.contact_force, sample.contact_force.norm());
        worst.change = std::max(worst.change, (forces.back() - forces.front()).norm());
        if (!sample.contact_force.allFinite() || !sample.motor_force.allFinite()) {
          worst.finite = false;
        }
        if (!sample.motor_force.isZero(0.0)) worst.motors_on = sample.time;
      }
    });
    return worst;
  }

  double contactForce() const {
    return std::max(loop.sample(Finger::kIndex).contact_force.norm(),
                    loop.sample(Finger::kThumb).contact_force.norm());
  }

  /// What a person does after a fault: clears it and enables again.
  void recover() {
    loop.run(milliseconds(300));  // until the link greets again
    if (loop.controller().operatingState().mode == Mode::kFault) {
      ASSERT_EQ(loop.ask(DriverRequest::kClearFault), "");
    }
    if (loop.controller().operatingState().mode == Mode::kDisabled) {
      ASSERT_EQ(loop.ask(DriverRequest::kEnable), "");
    }
    loop.run(milliseconds(1000));
    for (const Finger finger : kFingers) {
      EXPECT_LT((loop.sample(finger).contact_force - kCommanded * direction(finger)).norm(), 0.1);
    }
  }

  ExoskeletonLoop loop;

 private:
  Vector3d apart_;
};

void expectSafe(const Worst& worst, const std::string& what) {
  EXPECT_TRUE(worst.finite) << what;
  EXPECT_LE(worst.contact_force, kMaxForce) << what;
  EXPECT_LE(worst.change, kMaxChange) << what;
}

class FaultsOfTheLine : public testing::TestWithParam<bool> {};

TEST_P(FaultsOfTheLine, NeitherJerkNorOverloadAFinger) {
  FaultyLoop faulty;
  oracles::SimulatedLine& line = GetParam() ? faulty.loop.toDevice() : faulty.loop.toDriver();
  double largest_change = 0.0, largest_force = 0.0;
  for (const serial::LineFault fault : serial::lineFaults()) {
    const double probability = fault == serial::LineFault::kStall ? 1.0 : 0.3;
    line.faults().set(fault, probability, faulty.loop.now() + milliseconds(400));
    const Worst worst = faulty.watch(milliseconds(600));
    expectSafe(worst, name(fault));
    largest_change = std::max(largest_change, worst.change);
    largest_force = std::max(largest_force, worst.contact_force);
    ASSERT_NO_FATAL_FAILURE(faulty.recover()) << name(fault);
  }
  std::cout << (GetParam() ? "to the device" : "to the driver") << ": largest change of force "
            << largest_change << " N/ms, largest contact force " << largest_force << " N\n";
  EXPECT_GT(largest_change, 0.3) << "no fault reached the fingers: the test tests nothing";
}

INSTANTIATE_TEST_SUITE_P(EachDirection, FaultsOfTheLine, testing::Bool(), [](const auto& info) {
  return std::string(info.param ? "ToTheDevice" : "ToTheDriver");
});

TEST(Faults, MixedInBothDirectionsAreAsHarmless) {
  FaultyLoop faulty(2);
  for (const double probability : {0.01, 0.05, 0.2}) {
    for (const serial::LineFault fault : serial::lineFaults()) {
      const double share = fault == serial::LineFault::kStall ? 0.0 : probability;
      faulty.loop.toDevice().faults().set(fault, share, faulty.loop.now() + milliseconds(1000));
      faulty.loop.toDriver().faults().set(fault, share, faulty.loop.now() + milliseconds(1000));
    }
    const Worst worst = faulty.watch(milliseconds(1200));
    expectSafe(worst, std::to_string(probability));
    std::cout << "mixed, each with probability " << probability << ": largest change of force "
              << worst.change << " N/ms, largest contact force " << worst.contact_force << " N\n";
    ASSERT_NO_FATAL_FAILURE(faulty.recover()) << probability;
  }
}

TEST(Faults, AClosedPortTakesTheForceToZeroUntilItIsClearedAndEnabledAgain) {
  FaultyLoop faulty;
  const Time closed = faulty.loop.now();
  faulty.loop.closePort();
  const Worst worst = faulty.watch(milliseconds(300));
  expectSafe(worst, "closed");
  EXPECT_LE(worst.motors_on - closed, FirmwareModel::kRamp + kOnTheLine);
  EXPECT_LT(faulty.contactForce(), kWeightAndFriction);
  EXPECT_EQ(faulty.loop.controller().operatingState().mode, Mode::kFault);
  EXPECT_EQ(faulty.loop.ask(DriverRequest::kClearFault), "");
  EXPECT_NE(faulty.loop.ask(DriverRequest::kEnable), "") << "there is no device";

  faulty.loop.openPort();
  expectSafe(faulty.watch(milliseconds(300)), "opened");
  EXPECT_LT(faulty.contactForce(), kWeightAndFriction) << "nobody has enabled it";
  faulty.recover();
}

TEST(Faults, ASaturatedSensorLeavesTheForceWithinAHalfNewton) {
  FaultyLoop faulty;
  for (const bool saturated : {true, false}) {
    for (const Finger finger : kFingers) faulty.loop.device().saturateSensor(finger, saturated);
    expectSafe(faulty.watch(milliseconds(1000)), "saturated");
    for (const Finger finger : kFingers) {
      const Vector3d force = faulty.loop.sample(finger).contact_force;
      EXPECT_LT((force - kCommanded * faulty.direction(finger)).norm(), 0.5);
    }
  }
}

TEST(Faults, TheMotorsAreOffWithinTenMillisecondsAfterTheCommandersDeath) {
  double largest = 0.0;
  for (int i = 0; i < kMoments; ++i) {
    FaultyLoop faulty(1 + i);
    faulty.loop.run(i * std::chrono::microseconds(250));  // at any moment of the driver's period
    const Time death = faulty.loop.now();
    faulty.loop.killCommander();
    expectSafe(faulty.watch(milliseconds(10)), "killed");
    for (const Finger finger : kFingers) {
      EXPECT_TRUE(faulty.loop.sample(finger).motor_force.isZero(0.0)) << i;
    }
    expectSafe(faulty.watch(milliseconds(10)), "off");
    largest = std::max(largest, faulty.contactForce());
    EXPECT_LT(faulty.contactForce(), kLeftAfterCommander) << i;
    const Worst after = faulty.watch(milliseconds(480));
    expectSafe(after, "afterwards");
    EXPECT_LE(after.motors_on, death + milliseconds(10)) << "the motors came on again";
    EXPECT_LT(faulty.contactForce(), kWeightAndFriction) << i;
  }
  std::cout << "contact force 20 ms after the commander's death " << largest << " N\n";
}

TEST(Faults, TheDriverDoesNotWaitForTheAnswersOfADeadCommander) {
  const PerFinger<Vector3d> open = openHand();
  const auto motors_until = [&](oracles::DyingPart part) {
    return oracles::dieInAHold(shippedUrdf(), open, kCommanded, part).motors_on;
  };
  // Within the tick after the death, to the quarter of a period in which that was looked for, as
  // when the driver itself dies; DriverLoop::kAnswerPatience would come on top.
  const double period = 1e3 * base::seconds(DriverLoop::kPeriod);
  EXPECT_LT(motors_until(oracles::DyingPart::kCommander),
            motors_until(oracles::DyingPart::kDriver) + 1.25 * period);
}

TEST(Faults, TheMotorsAreOffTwentyMillisecondsAfterCommanderOrDriverFellSilent) {
  for (const bool driver : {false, true}) {
    for (int i = 0; i < kMoments; ++i) {
      FaultyLoop faulty(1 + i);
      faulty.loop.run(i * std::chrono::microseconds(250));
      const Time stall = faulty.loop.now();
      if (driver) faulty.loop.stallDriver(std::chrono::seconds(10));
      if (!driver) faulty.loop.stallCommander(std::chrono::seconds(10));
      const Worst worst = faulty.watch(milliseconds(500));
      expectSafe(worst, "silent");
      EXPECT_LE(worst.motors_on - stall, milliseconds(20)) << driver << i;
      EXPECT_GT(worst.motors_on - stall, milliseconds(12)) << "let go of too soon";
    }
  }
}

TEST(Faults, AStallOfUpToFifteenMillisecondsDoesNotOpenTheHand) {
  const PerFinger<Vector3d> open = openHand();
  for (const oracles::StalledPart part : oracles::kStalledParts) {
    const auto holds = oracles::holdThroughStalls(
        shippedUrdf(), open, 1.6, 800.0, part,
        {milliseconds(5), milliseconds(11), milliseconds(15), milliseconds(19), milliseconds(25)});
    ASSERT_EQ(holds.size(), 5u);
    for (std::size_t i = 0; i < holds.size(); ++i) {
      const std::string which = oracles::name(part) + std::string(" ") + std::to_string(i);
      EXPECT_NEAR(holds[i].hold, 1.6, 0.05) << which;
      EXPECT_LT(holds[i].overshoot, 0.3) << which;
      EXPECT_LT(holds[i].jump, 0.6) << which;
      if (i > 2) continue;
      EXPECT_GT(holds[i].least, 0.8) << which;
      EXPECT_EQ(holds[i].below, 0.0) << which;
      EXPECT_LT(holds[i].jump, 0.3) << which;
    }
  }
}

TEST(Faults, ADriverThatStoodStillForTenSecondsGoesOnWithoutAFault) {
  FaultyLoop faulty;
  faulty.loop.stallDriver(std::chrono::seconds(10));
  expectSafe(faulty.watch(std::chrono::seconds(11)), "stood still");
  EXPECT_EQ(faulty.loop.controller().operatingState().mode, Mode::kEnabled)
      << faulty.loop.controller().fault();
  faulty.recover();
}

TEST(Faults, CommandsThatAreNotFiniteAreAsGoodAsNone) {
  FaultyLoop faulty;
  const auto dropped = [&] {
    return faulty.loop.controller().measured(Finger::kIndex).safety.not_finite;
  };
  ASSERT_EQ(dropped(), 0u);
  faulty.command(std::numeric_limits<double>::quiet_NaN());
  expectSafe(faulty.watch(milliseconds(20)), "not finite");
  for (const Finger finger : kFingers) {
    EXPECT_TRUE(faulty.loop.sample(finger).motor_force.isZero(0.0));
  }
  EXPECT_GE(dropped(), 19u);
  faulty.command(kCommanded);
  expectSafe(faulty.watch(milliseconds(500)), "finite again");
  faulty.recover();
}

TEST(Faults, TheMotorsAreOffWithinTenMillisecondsAfterTheDriversDeath) {
  for (int i = 0; i < kMoments; ++i) {
    FaultyLoop faulty(1 + i);
    faulty.loop.run(i * std::chrono::microseconds(250));
    const Time death = faulty.loop.now();
    faulty.loop.killDriver();
    const Worst worst = faulty.watch(milliseconds(500));
    expectSafe(worst, "killed");
    EXPECT_LE(worst.motors_on - death, milliseconds(10)) << i;
    EXPECT_LT(faulty.contactForce(), kWeightAndFriction) << i;
  }
}

}  // namespace
}  // namespace haptex::exoskeleton::test_faults
