#include <gtest/gtest.h>

#include <string>

#include "haptex/exoskeleton/control/commander_watch.h"
#include "haptex/exoskeleton/control/driver_announcement.h"
#include "haptex/nodes/common/hand_markers.h"

namespace haptex::nodes::test_driver_announcement {
namespace {

using base::Finger;
using exoskeleton::Mode;
using exoskeleton::OperatingState;

OperatingState state(Mode mode, bool is_homed, bool is_busy = false) {
  OperatingState state;
  state.mode = mode;
  state.is_homed = is_homed;
  state.is_busy = is_busy;
  return state;
}

TEST(DriverAnnouncement, NamesTheFaultAndEveryServiceToCall) {
  EXPECT_EQ(exoskeleton::announcement(state(Mode::kFault, true), "no states from the device"),
            "FAULT: no states from the device; forces are off. Call exoskeleton/clear_fault, then "
            "exoskeleton/enable");
  EXPECT_EQ(exoskeleton::announcement(state(Mode::kFault, false), "an encoder of the thumb jumped"),
            "FAULT: an encoder of the thumb jumped; forces are off. Call exoskeleton/clear_fault, "
            "then exoskeleton/home, then exoskeleton/enable");
}

TEST(DriverAnnouncement, SaysOfEveryStateWhetherThereAreForcesAndWhatToCall) {
  EXPECT_EQ(exoskeleton::announcement(state(Mode::kEnabled, true), ""),
            "ENABLED: commanded forces are rendered");
  EXPECT_EQ(exoskeleton::announcement(state(Mode::kPaused, true), ""),
            "PAUSED: forces are off. Call exoskeleton/enable");
  EXPECT_EQ(exoskeleton::announcement(state(Mode::kDisabled, true), ""),
            "DISABLED: forces are off. Call exoskeleton/enable");
  EXPECT_EQ(exoskeleton::announcement(state(Mode::kDisabled, false), ""),
            "DISABLED, not homed: forces are off. Call exoskeleton/home, then exoskeleton/enable");
  EXPECT_NE(exoskeleton::announcement(state(Mode::kDisabled, false, true), "").find("homing"),
            std::string::npos);
}

TEST(StateMarker, IsATextAboveTheHandThatIsRedForAFault) {
  const auto marker = [](Mode mode) {
    return stateMarker("a text", mode, ros::Time(1.0)).markers.at(0);
  };
  EXPECT_EQ(marker(Mode::kFault).text, "a text");
  EXPECT_EQ(marker(Mode::kFault).ns, "state");
  EXPECT_EQ(marker(Mode::kFault).header.frame_id, "hand_base");
  EXPECT_EQ(marker(Mode::kFault).type, visualization_msgs::Marker::TEXT_VIEW_FACING);
  EXPECT_GT(marker(Mode::kFault).color.r, 2.0F * marker(Mode::kFault).color.g);
  EXPECT_GT(marker(Mode::kEnabled).color.g, 2.0F * marker(Mode::kEnabled).color.r);
}

TEST(CommanderWatch, KnowsTheDeathOfTheOneWhoCommandedLastOnce) {
  exoskeleton::CommanderWatch watch;
  EXPECT_FALSE(watch.hasDied(Finger::kIndex, "")) << "nobody has commanded";
  watch.commanded(Finger::kIndex, "/renderer");
  EXPECT_FALSE(watch.hasDied(Finger::kThumb, "/renderer"));
  EXPECT_FALSE(watch.hasDied(Finger::kIndex, "/rviz"));
  EXPECT_TRUE(watch.hasDied(Finger::kIndex, "/renderer"));
  EXPECT_FALSE(watch.hasDied(Finger::kIndex, "/renderer"));
  watch.commanded(Finger::kIndex, "/renderer");
  watch.commanded(Finger::kIndex, "/another");
  EXPECT_FALSE(watch.hasDied(Finger::kIndex, "/renderer"));
  EXPECT_TRUE(watch.hasDied(Finger::kIndex, "/another"));
}

}  // namespace
}  // namespace haptex::nodes::test_driver_announcement
