#include <gtest/gtest.h>

#include <string>

#include "haptex/nodes/rviz_plugin/system_status.h"

namespace haptex::nodes::test_system_status {
namespace {

using Level = Diagnosis::Level;
using Mood = StatusLine::Mood;
using std::chrono::milliseconds;

constexpr base::Time kNow = std::chrono::seconds(100);

/// Everything runs, and the index touches.
SystemStatus wellStatus(base::Time now = kNow) {
  SystemStatus status;
  status.hear("cloth simulation", {Level::kOk, "in real time", {}}, now);
  status.hear("exoskeleton link", {Level::kOk, "connected", {}}, now);
  status.hear("exoskeleton loop", {Level::kOk, "in time", {}}, now);
  status.hear("force loop", {Level::kOk, "in time", {}}, now);
  status.hear("force sources", {Level::kOk, "all live", {}}, now);
  status.hear("contact force of the index", {Level::kOk, "touches", {{"force (N)", "0.314"}}}, now);
  status.hear("contact force of the thumb", {Level::kOk, "does not touch", {}}, now);
  status.hear("exoskeleton force of the index", {Level::kOk, "the commanded force is rendered", {}},
              now);
  status.hear(DeviceState{"ENABLED", true, false, ""}, now);
  return status;
}

TEST(SystemStatus, SaysThatNothingIsHeard) {
  const StatusLine line = SystemStatus().line(kNow);
  EXPECT_EQ(line.mood, Mood::kTrouble);
  EXPECT_EQ(line.text,
            "Nothing is heard from haptex: is a launch file running, and rviz in its namespace?");
}

TEST(SystemStatus, SaysThatAllIsWellAndWhatIsFelt) {
  const StatusLine line = wellStatus().line(kNow);
  EXPECT_EQ(line.mood, Mood::kWell);
  EXPECT_EQ(line.text, "All is well: the index feels 0.31 N, the thumb does not touch.");
}

TEST(SystemStatus, AForceThatRisesIsSaidInASentence) {
  SystemStatus status = wellStatus();
  status.hear("contact force of the thumb", {Level::kOk, "the force rises", {}}, kNow);
  EXPECT_EQ(status.line(kNow).text,
            "All is well: the index feels 0.31 N, the thumb feels a rising force.");
}

TEST(SystemStatus, ANodeThatFellSilentIsNamed) {
  const SystemStatus status = wellStatus(kNow);
  EXPECT_EQ(status.line(kNow + SystemStatus::kSilent).mood, Mood::kWell);
  const StatusLine line = status.line(kNow + milliseconds(8000));
  EXPECT_EQ(line.mood, Mood::kTrouble);
  EXPECT_EQ(line.text,
            "No force: cloth_simulation has been silent for 8 s. It has stopped or "
            "hangs; see its terminal.");
}

TEST(SystemStatus, ADriverThatFellSilentIsNamedAlthoughItsStateIsLatched) {
  SystemStatus status = wellStatus(kNow);
  const base::Time later = kNow + milliseconds(9000);
  status.hear("cloth simulation", {Level::kOk, "in real time", {}}, later);
  EXPECT_EQ(status.line(later).text,
            "No force: exoskeleton_driver has been silent for 9 s. It has "
            "stopped or hangs; see its terminal.");
}

TEST(SystemStatus, AForceRendererThatFellSilentIsNamed) {
  SystemStatus status = wellStatus(kNow);
  const base::Time later = kNow + milliseconds(9000);
  status.hear("cloth simulation", {Level::kOk, "in real time", {}}, later);
  status.hear("exoskeleton link", {Level::kOk, "connected", {}}, later);
  EXPECT_EQ(status.line(later).text,
            "No force: force_renderer has been silent for 9 s. It has "
            "stopped or hangs; see its terminal.");
}

std::string textWith(const std::string& name, const Diagnosis& diagnosis) {
  SystemStatus status = wellStatus();
  status.hear(name, diagnosis, kNow);
  return status.line(kNow).text;
}

TEST(SystemStatus, ADeviceThatIsMissingIsSaidWithWhatToLookAt) {
  EXPECT_EQ(textWith("exoskeleton link",
                     {Level::kError, "no device: /dev/ttyUSB0: there is no such port", {}}),
            "No force: no device: /dev/ttyUSB0: there is no such port. Are cable, power and port "
            "right?");
}

TEST(SystemStatus, SourcesThatAreSilentAreNamed) {
  EXPECT_EQ(textWith("force sources", {Level::kError, "no force: tf of hand_base for 80 ms", {}}),
            "No force: tf of hand_base for 80 ms.");
}

TEST(SystemStatus, AFingerThatTouchesAndFeelsNothingIsToldWhy) {
  EXPECT_EQ(textWith("exoskeleton force of the index",
                     {Level::kOk, "no force: a joint is outside of its limits", {}}),
            "No force on the index, which touches: a joint is outside of its limits.");
}

TEST(SystemStatus, AFingerThatDoesNotTouchLacksNothing) {
  SystemStatus status = wellStatus();
  status.hear("exoskeleton force of the thumb",
              {Level::kOk, "no force: nobody commands a force", {}}, kNow);
  EXPECT_EQ(status.line(kNow).mood, Mood::kWell);
}

std::string textOf(const DeviceState& state) {
  SystemStatus status = wellStatus();
  status.hear(state, kNow);
  return status.line(kNow).text;
}

TEST(SystemStatus, EveryStateOfTheDeviceSaysWhichButtonsToPress) {
  EXPECT_EQ(textOf({"DISABLED", true, false, ""}),
            "No force: the device is disabled; press Enable.");
  EXPECT_EQ(textOf({"DISABLED", false, false, ""}),
            "No force: the device is disabled; press Home, then Enable.");
  EXPECT_EQ(textOf({"DISABLED", false, true, ""}), "No force yet: the device is homing.");
  EXPECT_EQ(textOf({"PAUSED", true, false, ""}), "No force: the device is paused; press Enable.");
  EXPECT_EQ(textOf({"FAULT", true, false, "the driver stalled"}),
            "No force: the driver stalled. Press Clear fault, then Enable.");
  EXPECT_EQ(textOf({"FAULT", false, false, "the driver stalled"}),
            "No force: the driver stalled. Press Clear fault, then Home and Enable.");
}

TEST(SystemStatus, WarningsDoNotHideThatForcesAreFelt) {
  SystemStatus status = wellStatus();
  status.hear("cloth simulation", {Level::kWarn, "3.0 % slower than real time", {}}, kNow);
  const StatusLine line = status.line(kNow);
  EXPECT_EQ(line.mood, Mood::kAttention);
  EXPECT_EQ(line.text,
            "The index feels 0.31 N, the thumb does not touch. Attention, cloth "
            "simulation: 3.0 % slower than real time.");
}

TEST(SystemStatus, AReplayedBagIsSaidInsteadOfSilentNodes) {
  SystemStatus status;
  Diagnosis recorded{Level::kOk, "in real time", {}};
  recorded.replayed_by = "/play_17";
  status.hear("cloth simulation", recorded, kNow);
  recorded.message = "touches";
  recorded.values = {{"force (N)", "0.314"}};
  status.hear("contact force of the index", recorded, kNow);
  StatusLine line = status.line(kNow);
  EXPECT_EQ(line.mood, Mood::kAttention);
  EXPECT_EQ(line.text,
            "A bag is replayed by /play_17, and no node answers the buttons. It recorded: the "
            "index feels 0.31 N.");
  line = status.line(kNow + milliseconds(8000));
  EXPECT_EQ(line.text,
            "A bag is replayed by /play_17, and no node answers the buttons. It recorded: the "
            "index feels 0.31 N. Nothing has come for 8 s.");
}

TEST(SystemStatus, NothingOfABagStaysWhenNodesSpeakThemselves) {
  SystemStatus status;
  Diagnosis recorded{Level::kError, "connection lost", {}};
  recorded.replayed_by = "/play_17";
  status.hear("exoskeleton link", recorded, kNow);
  status.hear("cloth simulation", {Level::kOk, "in real time", {}}, kNow + milliseconds(1));
  EXPECT_EQ(status.line(kNow + milliseconds(8)).text,
            "There is a cloth and no exoskeleton: nothing is felt.");
}

TEST(SystemStatus, MissingSchedFifoIsNoTrouble) {
  SystemStatus status = wellStatus();
  status.hear("force loop", {Level::kWarn, "in time, but without SCHED_FIFO: not permitted", {}},
              kNow);
  EXPECT_EQ(status.line(kNow).mood, Mood::kWell);
}

TEST(SystemStatus, APausedClothIsSaid) {
  SystemStatus status = wellStatus();
  status.hear("cloth simulation", {Level::kOk, "paused", {}}, kNow);
  EXPECT_EQ(status.line(kNow).mood, Mood::kAttention);
  EXPECT_NE(status.line(kNow).text.find("The cloth is paused."), std::string::npos);
}

TEST(SystemStatus, AClothThatStandsIsSaidFirst) {
  EXPECT_EQ(textWith("cloth simulation", {Level::kError, "a step was not finite", {}}),
            "The cloth stands: a step was not finite");
}

TEST(SystemStatus, AClothAloneIsToldApartFromATrouble) {
  SystemStatus status;
  status.hear("cloth simulation", {Level::kOk, "in real time", {}}, kNow);
  EXPECT_EQ(status.line(kNow).text, "There is a cloth and no exoskeleton: nothing is felt.");
  EXPECT_EQ(status.line(kNow).mood, Mood::kWell);
}

TEST(SystemStatus, AnExoskeletonAloneLacksARenderer) {
  SystemStatus status;
  status.hear("exoskeleton link", {Level::kOk, "connected", {}}, kNow);
  status.hear(DeviceState{"ENABLED", true, false, ""}, kNow);
  EXPECT_EQ(status.line(kNow).text,
            "No force: no force_renderer is heard, so nobody computes one "
            "(haptex.launch starts it).");
}

std::string figureOf(const SystemStatus& status, const std::string& name) {
  for (const Figure& figure : status.figures(kNow)) {
    if (figure.name == name) return figure.value;
  }
  return "none";
}

TEST(SystemStatus, RatesAndDipsAreThoseBetweenTheLastTwoDiagnoses) {
  SystemStatus status;
  const auto diagnosis = [](double stamp, const char* periods, const char* missed) {
    return Diagnosis{Level::kOk,
                     "in time",
                     {{"periods", periods}, {"periods missed", missed}, {"SCHED_FIFO", "granted"}},
                     stamp};
  };
  status.hear("force loop", diagnosis(7.0, "5000", "3"), kNow);
  EXPECT_EQ(figureOf(status, "force loop"), "none") << "one diagnosis has no rate";
  status.hear("force loop", diagnosis(8.25, "6250", "5"), kNow);  // arrives at the same time
  EXPECT_EQ(figureOf(status, "force loop"), "1000 Hz, 2 missed lately");
}

TEST(SystemStatus, TheBudgetIsSaidWithTheShareOfStepsThatKeepIt) {
  SystemStatus status;
  status.hear("cloth simulation",
              {Level::kOk,
               "in real time",
               {{"step rate (Hz)", "80"},
                {"real-time factor", "1"},
                {"budget (ms)", "10.000000"},
                {"cycles within the budget (%)", "97.5"}}},
              kNow);
  EXPECT_EQ(figureOf(status, "cloth"), "80 Hz, 1.00 of real time");
  EXPECT_EQ(figureOf(status, "budget"), "10 ms, kept by 98 % of the steps");
}

}  // namespace
}  // namespace haptex::nodes::test_system_status
