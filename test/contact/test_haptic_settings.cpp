#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <ostream>
#include <stdexcept>
#include <string>

#include "haptex/contact/haptic_settings.h"

namespace haptex::contact::test_haptic_settings {
namespace {

using Layer = HapticSettings::Layer;

// A scene file that lives as long as the test.
class HapticSettingsFile : public testing::Test {
 protected:
  HapticSettingsFile()
      : path_(testing::TempDir() + "haptex_haptics_" + std::to_string(getpid()) + ".yaml") {}
  ~HapticSettingsFile() override { std::remove(path_.c_str()); }

  HapticSettings load(const std::string& text) const {
    std::ofstream(path_) << text;
    return loadHapticSettings(path_);
  }

  std::string path_;
};

TEST_F(HapticSettingsFile, HasItsDefaultsWhereTheSceneSaysNothing) {
  for (const char* text : {"fabric: wool\n", "haptics: {}\n"}) {
    const HapticSettings settings = load(text);
    EXPECT_EQ(settings.layer, Layer::kPatch);
    EXPECT_EQ(settings.refinement, 2);
    EXPECT_EQ(settings.margin, 0.008);
    EXPECT_EQ(settings.surround, 0.0);
    EXPECT_TRUE(settings.predict);
    EXPECT_EQ(settings.time_step, 1e-3);
  }
}

TEST_F(HapticSettingsFile, ReadsEveryKey) {
  const HapticSettings settings = load(
      "fabric: wool\n"
      "haptics: {layer: patch, refinement: 0, margin: 0.02, most_elements: 7, "
      "surround: 0.03, predict: false}\n");
  EXPECT_EQ(settings.layer, Layer::kPatch);
  EXPECT_EQ(settings.refinement, 0);
  EXPECT_EQ(settings.margin, 0.02);
  EXPECT_EQ(settings.most_elements, 7);
  EXPECT_EQ(settings.surround, 0.03);
  EXPECT_FALSE(settings.predict);
  EXPECT_EQ(load("haptics: {layer: whole_cloth}\n").layer, Layer::kWholeCloth);
}

TEST_F(HapticSettingsFile, LeavesOutWhatIsNotGiven) {
  const HapticSettings settings = load("haptics: {layer: patch, refinement: 4}\n");
  EXPECT_EQ(settings.layer, Layer::kPatch);
  EXPECT_EQ(settings.refinement, 4);
  EXPECT_EQ(settings.margin, 0.008);
  EXPECT_TRUE(load("haptics: {predict: true}\n").predict);
  EXPECT_EQ(load("haptics: {margin: 0.1}\n").margin, 0.1);
  EXPECT_EQ(load("haptics: {surround: 0.2}\n").surround, 0.2);
}

TEST(HapticSettings, OfTheShippedWoolSampleAreAPatchRefinedTwice) {
  const HapticSettings settings =
      loadHapticSettings(std::string(HAPTEX_CONFIG_DIRECTORY) + "/scenes/wool_sample.yaml");
  EXPECT_EQ(settings.layer, Layer::kPatch);
  EXPECT_EQ(settings.refinement, 2);
}

struct Refusal {
  std::string name;
  std::string text;
  std::string complaint;
};

void PrintTo(const Refusal& refusal, std::ostream* stream) { *stream << refusal.name; }

class HapticSettingsRefuse : public HapticSettingsFile,
                             public testing::WithParamInterface<Refusal> {};

TEST_P(HapticSettingsRefuse, NamingFileKeyValueAndWhatIsAllowed) {
  try {
    load(GetParam().text);
    ADD_FAILURE() << "not refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(error.what(), path_ + ": " + GetParam().complaint);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Settings, HapticSettingsRefuse,
    testing::Values(Refusal{"UnknownKey", "haptics: {time_step: 0.001}",
                            "haptics.time_step: unknown key, allowed here: layer, refinement, "
                            "margin, most_elements, surround, predict"},
                    Refusal{"NotAMap", "haptics: patch",
                            "haptics: 'patch' must be a map with the keys layer, refinement, "
                            "margin, most_elements, surround, predict"},
                    Refusal{"Empty", "haptics:",
                            "haptics: nothing must be a map with the keys layer, refinement, "
                            "margin, most_elements, surround, predict"},
                    Refusal{"SceneNotAMap", "- wool", "a list of 1 must be a map"},
                    Refusal{"UnknownLayer", "haptics: {layer: fine}",
                            "haptics.layer: 'fine' must be one of patch, whole_cloth"},
                    Refusal{"RefinedWholeCloth", "haptics: {layer: whole_cloth, refinement: 0}",
                            "haptics.refinement: '0' is not allowed with layer: whole_cloth, which "
                            "has no patches"},
                    Refusal{"PredictedWholeCloth", "haptics: {predict: false, layer: whole_cloth}",
                            "haptics.predict: 'false' is not allowed with layer: whole_cloth, "
                            "which has no patches"},
                    Refusal{"NegativeRefinement", "haptics: {refinement: -1}",
                            "haptics.refinement: '-1' must be an integer from 0 to 4"},
                    Refusal{"TooFine", "haptics: {refinement: 5}",
                            "haptics.refinement: '5' must be an integer from 0 to 4"},
                    Refusal{"HalfARefinement", "haptics: {refinement: 1.5}",
                            "haptics.refinement: '1.5' must be an integer"},
                    Refusal{"NoMargin", "haptics: {margin: 0}",
                            "haptics.margin: '0' must be > 0 and <= 0.1 m"},
                    Refusal{"MarginInMillimetres", "haptics: {margin: 8}",
                            "haptics.margin: '8' must be > 0 and <= 0.1 m"},
                    Refusal{"NanMargin", "haptics: {margin: .nan}",
                            "haptics.margin: '.nan' must be a finite number"},
                    Refusal{"SurroundBelowZero", "haptics: {surround: -0.01}",
                            "haptics.surround: '-0.01' must be from 0 to 0.2 m"},
                    Refusal{"SurroundInMillimetres", "haptics: {surround: 60}",
                            "haptics.surround: '60' must be from 0 to 0.2 m"},
                    Refusal{"PredictWithANumber", "haptics: {predict: 1}",
                            "haptics.predict: '1' must be one of true, false"}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace haptex::contact::test_haptic_settings
