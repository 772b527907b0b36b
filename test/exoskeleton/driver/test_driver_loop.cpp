// The driver without ROS against the emulated device on a real pseudo-terminal, in real time: what
// is waited for may take long on a busy machine.
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "exoskeleton_fixtures.h"
#include "haptex/exoskeleton/driver/driver_loop.h"
#include "haptex/realtime/periodic_thread.h"
#include "haptex/realtime/steady_clock.h"

namespace haptex::exoskeleton::test_driver_loop {
namespace {

using namespace std::chrono_literals;

constexpr Time kPatience = 30s;

ForceCommand threeNewtons() {
  ForceCommand command;
  command.force = {0.0, 0.0, 3.0};
  return command;
}

/// A driver that ticks, and a commander.
class ADriverLoop : public ::testing::Test {
 protected:
  bool eventually(const std::function<bool(const DriverSnapshot&)>& happens) {
    const Time end = realtime::steadyNow() + kPatience;
    while (!happens(loop_.status())) {
      if (realtime::steadyNow() > end) return false;
      std::this_thread::sleep_for(1ms);
    }
    return true;
  }

  bool connects() {
    return eventually([](const DriverSnapshot& now) {
      return now.link == LinkStatus::kConnected && now.states > 0;
    });
  }

  /// Brings the device to where it renders forces, one request at a time. Where the machine stood
  /// still for 10 ms, that is again from the start.
  void getReady(const DriverSnapshot& now) {
    const OperatingState& state = now.operating_state;
    if (state.mode == Mode::kFault) {
      loop_.ask(DriverRequest::kClearFault);
    } else if (!state.is_homed && !state.is_busy) {
      loop_.ask(DriverRequest::kHome);
    } else if (state.is_homed && state.mode != Mode::kEnabled) {
      loop_.ask(DriverRequest::kEnable);
    }
  }

  /// Commands 3 N until the index finger's sensor says so.
  bool feelsThreeNewtons() {
    const ForceCommand command = threeNewtons();
    return eventually([&](const DriverSnapshot& now) {
      getReady(now);
      loop_.command(Finger::kIndex, command, realtime::steadyNow());
      return now.fingers[Finger::kIndex].no_force == NoForceReason::kNone &&
             (now.fingers[Finger::kIndex].force - command.force).norm() < 0.3;
    });
  }

  const TemporaryDirectory directory_;
  const std::string port_ = directory_.path() + "/exoskeleton";
  DriverLoop loop_{port_, exoskeleton::shippedUrdf()};
  std::atomic<bool> frozen_{false};
  realtime::PeriodicThread thread_{DriverLoop::kPeriod, [this](Time now) {
                                     if (!frozen_) loop_.tick(now);
                                   }};
};

TEST_F(ADriverLoop, NamesAPortThatIsNotThere) {
  ASSERT_TRUE(eventually([&](const DriverSnapshot& now) {
    return now.ticks > 0 && loop_.portTrouble().find("not been opened") == std::string::npos;
  }));
  EXPECT_NE(loop_.portTrouble().find(port_), std::string::npos) << loop_.portTrouble();
  const DriverSnapshot now = loop_.status();
  EXPECT_FALSE(now.port_open);
  EXPECT_EQ(now.link, LinkStatus::kConnecting);
  EXPECT_EQ(now.fingers[Finger::kIndex].no_force, NoForceReason::kNoDevice);
  EXPECT_NE(loop_.ask(DriverRequest::kHome), "");
}

TEST_F(ADriverLoop, NamesAPortThatIsNoSerialPort) {
  std::ofstream(port_) << "a file";
  ASSERT_TRUE(eventually([&](const DriverSnapshot&) {
    const std::string trouble = loop_.portTrouble();
    return trouble.find(port_) != std::string::npos &&
           trouble.find("serial port") != std::string::npos;
  })) << loop_.portTrouble();
}

TEST_F(ADriverLoop, ShowsEveryStateOfTheDeviceOnceInOrder) {
  const LivingDevice device(port_);
  ASSERT_TRUE(connects());
  EXPECT_EQ(loop_.portTrouble(), "");
  EXPECT_EQ(loop_.status().identity.serial_number, 42u);
  DriverSnapshot last;
  while (loop_.takeMeasured(last, 0ms)) {
  }
  const std::uint64_t lost = loop_.lostSnapshots();
  for (int i = 0; i < 100; ++i) {
    DriverSnapshot now;
    ASSERT_TRUE(loop_.takeMeasured(now, kPatience));
    if (loop_.lostSnapshots() == lost) {
      EXPECT_EQ(now.states, last.states + 1);
    }
    EXPECT_GT(now.states, last.states);
    EXPECT_GT(now.state_time, last.state_time);
    last = now;
  }
}

TEST_F(ADriverLoop, RefusesToEnableBeforeHoming) {
  const LivingDevice device(port_);
  ASSERT_TRUE(connects());
  EXPECT_NE(loop_.ask(DriverRequest::kEnable), "");
  EXPECT_EQ(loop_.status().operating_state.mode, Mode::kDisabled);
}

TEST_F(ADriverLoop, RendersTheCommandedForceAndNoneAfterTheLastCommand) {
  const LivingDevice device(port_);
  ASSERT_TRUE(connects());
  ASSERT_TRUE(feelsThreeNewtons());
  ASSERT_TRUE(eventually([](const DriverSnapshot& now) {
    return now.fingers[Finger::kIndex].no_force == NoForceReason::kNoCommand &&
           now.fingers[Finger::kIndex].desired_force.norm() == 0.0 &&
           now.fingers[Finger::kIndex].force.norm() < 0.3;
  }));
  EXPECT_GE(loop_.status().fingers[Finger::kIndex].safety.watchdog_trips, 1u);
}

TEST_F(ADriverLoop, EndsTheForceOfADeadCommanderSoonerThanThatOfASilentOne) {
  const LivingDevice device(port_);
  ASSERT_TRUE(connects());
  ASSERT_TRUE(feelsThreeNewtons());
  loop_.command(Finger::kIndex, threeNewtons(),
                realtime::steadyNow() + 1h);  // the watchdog never ends it
  loop_.commanderDied(Finger::kIndex);
  ASSERT_TRUE(eventually([](const DriverSnapshot& now) {
    return now.fingers[Finger::kIndex].desired_force.norm() == 0.0;
  }));
  EXPECT_EQ(loop_.status().fingers[Finger::kIndex].no_force, NoForceReason::kNoCommand);
  EXPECT_TRUE(feelsThreeNewtons()) << "of another commander";
}

TEST_F(ADriverLoop, GoesOnWithoutAFaultAfterItStoodStillForLong) {
  const LivingDevice device(port_);
  ASSERT_TRUE(connects());
  ASSERT_TRUE(feelsThreeNewtons());
  // Longer than the pseudo-terminal's buffers hold states: the driver reads old ones first, and
  // then those of 2 s later.
  frozen_ = true;
  std::this_thread::sleep_for(3500ms);
  const std::uint64_t states = loop_.status().states;
  frozen_ = false;
  ASSERT_TRUE(eventually([&](const DriverSnapshot& now) { return now.states > states + 500; }));
  const DriverSnapshot now = loop_.status();
  EXPECT_EQ(now.fault.str().find("switched off"), std::string::npos) << now.fault.str();
  EXPECT_TRUE(now.operating_state.is_homed);
  EXPECT_TRUE(feelsThreeNewtons());
}

TEST_F(ADriverLoop, LatchesAFaultWhenThePortVanishesAndWorksAgainWhenItIsBack) {
  auto device = std::make_unique<LivingDevice>(port_);
  ASSERT_TRUE(connects());
  ASSERT_TRUE(feelsThreeNewtons());
  device.reset();
  ASSERT_TRUE(eventually([](const DriverSnapshot& now) {
    return now.operating_state.mode == Mode::kFault && now.ports_lost == 1;
  }));
  EXPECT_EQ(loop_.status().link, LinkStatus::kConnecting);
  EXPECT_NE(loop_.status().fault.str(), "");
  EXPECT_NE(loop_.portTrouble().find(port_), std::string::npos) << loop_.portTrouble();
  device = std::make_unique<LivingDevice>(port_);  // switched on anew: its counts start over
  ASSERT_TRUE(eventually([](const DriverSnapshot& now) { return !now.operating_state.is_homed; }));
  // One more where the machine stood still for so long that the link was taken for lost.
  EXPECT_GE(loop_.status().link_statistics.handshakes, 2u);
  EXPECT_EQ(loop_.ask(DriverRequest::kClearFault), "");
  EXPECT_NE(loop_.ask(DriverRequest::kEnable), "");  // nobody knows where the fingers are
  EXPECT_TRUE(feelsThreeNewtons());
}

TEST_F(ADriverLoop, EndsForcesWhenAskedTo) {
  const LivingDevice device(port_);
  ASSERT_TRUE(connects());
  for (const auto& [request, mode] : {std::pair{DriverRequest::kPause, Mode::kPaused},
                                      std::pair{DriverRequest::kDisable, Mode::kDisabled}}) {
    ASSERT_TRUE(feelsThreeNewtons());
    EXPECT_EQ(loop_.ask(request), "");
    EXPECT_EQ(loop_.status().operating_state.mode, mode);
    EXPECT_TRUE(eventually([&](const DriverSnapshot& now) {
      loop_.command(Finger::kIndex, threeNewtons(), realtime::steadyNow());  // in vain
      return now.fingers[Finger::kIndex].desired_force.norm() == 0.0 && !now.motors_on &&
             now.fingers[Finger::kIndex].force.norm() < 0.3;
    }));
  }
}

/// A driver whose ticks are the device's, and a commander that answers every state at once.
TEST(AnsweredDriverLoop, RendersTheForceThatAnswersAStateInTheSamePeriod) {
  const TemporaryDirectory directory;
  const std::string port = directory.path() + "/exoskeleton";
  DriverLoop* answered = nullptr;
  std::atomic<std::uint64_t> states{0};
  const auto answer = [&](const DriverSnapshot& snapshot) {
    ++states;
    for (const Finger finger : kFingers) {
      answered->command(finger, {}, realtime::steadyNow(), snapshot.state_time);
    }
  };
  DriverLoop loop(port, exoskeleton::shippedUrdf(), answer);
  answered = &loop;
  const realtime::PeriodicThread thread(DriverLoop::kPeriod, [&](Time now) { loop.tick(now); },
                                        {[&](Time until) { return loop.awaitState(until); }});
  const LivingDevice device(port);
  const Time end = realtime::steadyNow() + kPatience;
  while (states < 200 && realtime::steadyNow() < end) std::this_thread::sleep_for(1ms);
  ASSERT_GE(states, 200u);
  const realtime::DurationHistogram::Counts path = loop.path().counts();
  EXPECT_GE(path.total(), 2 * 190u);  // both fingers
  EXPECT_GE(path.quantile(0.01), DriverLoop::kLine);
}

TEST(DriverLoop, RefusesAUrdfThatIsNone) {
  EXPECT_THROW(DriverLoop("/dev/null", "no URDF"), std::invalid_argument);
}

TEST(FixedText, KeepsShortTextsAndTheBeginOfLongOnes) {
  EXPECT_EQ(FixedText().str(), "");
  EXPECT_EQ(FixedText("why").str(), "why");
  EXPECT_EQ(FixedText(std::string(1000, 'x')).str(), std::string(FixedText::kCapacity, 'x'));
  EXPECT_TRUE(FixedText("why") == FixedText("why"));
  EXPECT_FALSE(FixedText("why") == FixedText("whom"));
}

}  // namespace
}  // namespace haptex::exoskeleton::test_driver_loop
