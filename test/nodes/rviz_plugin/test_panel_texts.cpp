#include <gtest/gtest.h>

#include <string>

#include "haptex/nodes/rviz_plugin/panel_texts.h"

namespace haptex::nodes::test_panel_texts {
namespace {

TEST(StatusOfNamespace, TakesThoseOfItsOwnNamespaceAlone) {
  EXPECT_EQ(statusOfNamespace("haptex/force_renderer: force loop", "/haptex"), "force loop");
  EXPECT_EQ(statusOfNamespace("left/haptex/force_renderer: force loop", "/left/haptex"),
            "force loop");
  EXPECT_EQ(statusOfNamespace("left/haptex/force_renderer: force loop", "/haptex"), "");
  EXPECT_EQ(statusOfNamespace("haptex2/force_renderer: force loop", "/haptex"), "");
  EXPECT_EQ(statusOfNamespace("haptex/deeper/node: force loop", "/haptex"), "");
  EXPECT_EQ(statusOfNamespace("force_renderer: force loop", "/"), "force loop");
  EXPECT_EQ(statusOfNamespace("a name without a node", "/haptex"), "");
}

TEST(DiagnosisOf, CutsWhatIsTooLong) {
  diagnostic_msgs::DiagnosticStatus status;
  status.level = diagnostic_msgs::DiagnosticStatus::WARN;
  status.message = std::string(5000, 'x');
  status.values.resize(1);
  status.values[0].key = "key";
  status.values[0].value = std::string(5000, 'y');
  const Diagnosis diagnosis = diagnosisOf(status, 3.0, std::string(5000, 'z'));
  EXPECT_EQ(diagnosis.level, Diagnosis::Level::kWarn);
  EXPECT_EQ(diagnosis.message.size(), kLongest);
  EXPECT_EQ(diagnosis.values.at("key").size(), kLongest);
  EXPECT_EQ(diagnosis.replayed_by.size(), kLongest);
}

TEST(DiagnosisOf, TellsANodeThatSpeaksItselfFromARecordedOne) {
  diagnostic_msgs::DiagnosticStatus status;
  status.name = "left/haptex/force_renderer: force loop";
  EXPECT_EQ(diagnosisOf(status, 3.0, "/left/haptex/force_renderer").replayed_by, "");
  EXPECT_EQ(diagnosisOf(status, 3.0, "/play_1717").replayed_by, "/play_1717");
}

TEST(QualityText, SaysTheErrorToExpect) {
  haptex::ClothQuality message;
  message.cycle_ms = 2.345;
  message.quality.name = "balanced";
  message.quality.integrator = "backward_euler";
  message.quality.substeps = 2;
  message.quality.cells_as_measured = true;
  message.quality.motion = {"hang", "swing"};
  message.quality.position_error = {0.00042, 0.003};
  message.quality.force_error = {0.01, 0.02};
  EXPECT_EQ(qualityText(message),
            "balanced: backward_euler in 2 substeps, 2.35 ms a step\n"
            "error to expect in hang: 0.42 mm, 0.01 N, in swing: 3 mm, 0.02 N");
  message.quality.cells_as_measured = false;
  EXPECT_NE(qualityText(message).find("but for its cells"), std::string::npos);
}

TEST(QualityText, ListsOfDifferentLengthsAreReadAsFarAsTheyGo) {
  haptex::ClothQuality message;
  message.quality.motion = {"hang", "swing"};
  message.quality.position_error = {0.001};
  EXPECT_NE(qualityText(message).find("its errors were not measured"), std::string::npos);
}

}  // namespace
}  // namespace haptex::nodes::test_panel_texts
