#include <gtest/gtest.h>

#include <string>

#include "haptex/exoskeleton/control/operating_state.h"

namespace haptex::exoskeleton::test_operating_state {
namespace {

/// A machine in this mode, homed and with a device, as a person would bring it there.
OperatingStateMachine in(Mode mode) {
  OperatingStateMachine machine;
  machine.home(true);
  machine.homed();
  if (mode == Mode::kEnabled || mode == Mode::kPaused) machine.enable(true);
  if (mode == Mode::kPaused) machine.pause();
  if (mode == Mode::kFault) machine.raiseFault("it smokes");
  EXPECT_EQ(machine.state().mode, mode);
  return machine;
}

struct Transition {
  const char* request;
  Mode from;
  bool accepted;
  Mode to;
};

TEST(OperatingState, EveryRequestInEveryMode) {
  const Mode d = Mode::kDisabled, e = Mode::kEnabled, p = Mode::kPaused, f = Mode::kFault;
  const Transition table[] = {
      {"enable", d, true, e},  {"enable", e, false, e}, {"enable", p, true, e},
      {"enable", f, false, f}, {"pause", d, false, d},  {"pause", e, true, p},
      {"pause", p, false, p},  {"pause", f, false, f},  {"disable", d, true, d},
      {"disable", e, true, d}, {"disable", p, true, d}, {"disable", f, false, f},
      {"home", d, true, d},    {"home", e, false, e},   {"home", p, false, p},
      {"home", f, false, f},   {"clear", d, false, d},  {"clear", e, false, e},
      {"clear", p, false, p},  {"clear", f, true, d},   {"fault", d, true, f},
      {"fault", e, true, f},   {"fault", p, true, f},   {"fault", f, true, f},
  };
  for (const Transition& row : table) {
    OperatingStateMachine machine = in(row.from);
    const std::string what = row.request;
    Refusal refusal;
    if (what == "enable") refusal = machine.enable(true);
    if (what == "pause") refusal = machine.pause();
    if (what == "disable") refusal = machine.disable();
    if (what == "home") refusal = machine.home(true);
    if (what == "clear") refusal = machine.clearFault("");
    if (what == "fault") machine.raiseFault("it burns");
    EXPECT_EQ(refusal.empty(), row.accepted) << what << " in " << name(row.from) << ": " << refusal;
    EXPECT_EQ(machine.state().mode, row.to) << what << " in " << name(row.from);
    EXPECT_EQ(machine.state().is_busy, what == "home" && row.accepted);
    EXPECT_EQ(machine.fault().empty(), row.to != Mode::kFault);
  }
}

TEST(OperatingState, EnableSaysWhatIsMissing) {
  OperatingStateMachine machine;
  EXPECT_NE(machine.enable(false).find("no states from the device"), std::string::npos);
  EXPECT_NE(machine.enable(true).find("home the device first"), std::string::npos);
  machine.home(true);
  EXPECT_NE(machine.enable(true).find("homing"), std::string::npos);
  machine.homed();
  EXPECT_EQ(machine.enable(true), "");
  machine.raiseFault("the port is gone");
  EXPECT_NE(machine.enable(true).find("the port is gone"), std::string::npos);
}

TEST(OperatingState, HomingIsRefusedWithTheReason) {
  OperatingStateMachine machine;
  EXPECT_NE(machine.home(false).find("no states from the device"), std::string::npos);
  EXPECT_EQ(machine.home(true), "");
  EXPECT_NE(machine.home(true).find("already"), std::string::npos);
  EXPECT_NE(in(Mode::kEnabled).home(true).find("DISABLED"), std::string::npos);
}

TEST(OperatingState, HomingAnewForgetsTheOldCalibration) {
  OperatingStateMachine machine = in(Mode::kDisabled);
  EXPECT_TRUE(machine.state().is_homed);
  machine.home(true);
  EXPECT_FALSE(machine.state().is_homed);
  EXPECT_TRUE(machine.state().is_busy);
  machine.disable();
  EXPECT_FALSE(machine.state().is_busy);
  machine.homed();  // too late
  EXPECT_FALSE(machine.state().is_homed);
}

TEST(OperatingState, AFaultEndsHomingButNotTheCalibration) {
  OperatingStateMachine machine = in(Mode::kEnabled);
  machine.raiseFault("it smokes");
  EXPECT_TRUE(machine.state().is_homed);
  machine.loseHoming();
  EXPECT_FALSE(machine.state().is_homed);
  machine = OperatingStateMachine();
  machine.home(true);
  machine.raiseFault("it smokes");
  EXPECT_FALSE(machine.state().is_busy);
}

TEST(OperatingState, TheFirstFaultIsKeptUntilItsCauseIsGone) {
  OperatingStateMachine machine = in(Mode::kEnabled);
  machine.raiseFault("it smokes");
  machine.raiseFault("it burns");
  EXPECT_EQ(machine.fault(), "it smokes");
  EXPECT_NE(machine.clearFault("still smoke").find("still smoke"), std::string::npos);
  EXPECT_EQ(machine.state().mode, Mode::kFault);
  EXPECT_EQ(machine.clearFault(""), "");
  EXPECT_EQ(machine.fault(), "");
}

TEST(OperatingState, ALongFaultIsCut) {
  OperatingStateMachine machine;
  machine.raiseFault(std::string(1000, 'x').c_str());
  EXPECT_EQ(machine.fault(), std::string(250, 'x'));
}

TEST(OperatingState, NamesAreThoseOfCrtk) {
  EXPECT_STREQ(name(Mode::kDisabled), "DISABLED");
  EXPECT_STREQ(name(Mode::kEnabled), "ENABLED");
  EXPECT_STREQ(name(Mode::kPaused), "PAUSED");
  EXPECT_STREQ(name(Mode::kFault), "FAULT");
}

}  // namespace
}  // namespace haptex::exoskeleton::test_operating_state
