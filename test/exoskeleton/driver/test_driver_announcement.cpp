#include <gtest/gtest.h>

#include <string>

#include "haptex/exoskeleton/driver/driver_announcement.h"

namespace haptex::exoskeleton::test_driver_announcement {
namespace {

OperatingState state(Mode mode, bool is_homed, bool is_busy = false) {
  OperatingState state;
  state.mode = mode;
  state.is_homed = is_homed;
  state.is_busy = is_busy;
  return state;
}

TEST(DriverAnnouncement, NamesTheFaultAndEveryServiceToCall) {
  EXPECT_EQ(announcement(state(Mode::kFault, true), "no states from the device"),
            "FAULT: no states from the device; forces are off. Call exoskeleton/clear_fault, then "
            "exoskeleton/enable");
  EXPECT_EQ(announcement(state(Mode::kFault, false), "an encoder of the thumb jumped"),
            "FAULT: an encoder of the thumb jumped; forces are off. Call exoskeleton/clear_fault, "
            "then exoskeleton/home, then exoskeleton/enable");
}

TEST(DriverAnnouncement, SaysOfEveryStateWhetherThereAreForcesAndWhatToCall) {
  EXPECT_EQ(announcement(state(Mode::kEnabled, true), ""),
            "ENABLED: commanded forces are rendered");
  EXPECT_EQ(announcement(state(Mode::kPaused, true), ""),
            "PAUSED: forces are off. Call exoskeleton/enable");
  EXPECT_EQ(announcement(state(Mode::kDisabled, true), ""),
            "DISABLED: forces are off. Call exoskeleton/enable");
  EXPECT_EQ(announcement(state(Mode::kDisabled, false), ""),
            "DISABLED, not homed: forces are off. Call exoskeleton/home, then exoskeleton/enable");
  EXPECT_NE(announcement(state(Mode::kDisabled, false, true), "").find("homing"),
            std::string::npos);
}

}  // namespace
}  // namespace haptex::exoskeleton::test_driver_announcement
