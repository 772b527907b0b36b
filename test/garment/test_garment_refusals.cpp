#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "../refusal.h"
#include "garment_fixtures.h"

namespace haptex::garment::test_garment_refusals {
namespace {

struct Refused {
  const char* part;
  const char* replacement;
  const char* message;  // after "small.yaml: "
};

/// Not a constant: what it is made of is one in another source.
std::string panels() { return kSmallGarment.substr(0, kSmallGarment.find("seams:")); }

TEST(GarmentRefusals, NamePanelEdgeAndWhatIsAllowed) {
  const Refused refused[] = {
      {"[0.4, 0.6], [0.25, 0.6]]", "[0.4, 0.61], [0.25, 0.6]]",
       "panel 'front', edge 1 'side': ends at (0.4, 0.6), 0.01 m from where edge 2 starts: the "
       "outline is open, allowed is a gap of 1e-06 m"},
      {"{line: [[0.4, 0], [0, 0]]}", "{line: [[0.4, 0], [0.1, 0.1]]}",
       "panel 'back', edge 2: ends at (0.1, 0.1), 0.141421356237 m from where edge 0 starts: the "
       "outline is open, allowed is a gap of 1e-06 m"},
      {"[0, 0.6], [0.4, 0.6]]}", "[0.3, 0.6], [0.1, 0.2], [0, 0.6], [0.4, 0.6]]}",
       "panel 'back', edge 0: crosses itself: outlines may meet in the corners between successive "
       "edges only"},
      {"[0, 0], [0, 0.6], [0.4, 0.6]", "[0, 0], [0, 0.6], [0.2, 0], [0.4, 0.6]",
       "panel 'back', edge 0: crosses or touches panel 'back', edge 2: outlines may meet in the "
       "corners between successive edges only"},
      {"[[0.15, 0.2], [0.2, 0.25], [0.25, 0.2]]", "[[0.15, 0.2], [0.2, 0.65], [0.25, 0.2]]",
       "panel 'front', edge 5: crosses or touches panel 'front', hole 0, edge 0: "
       "outlines may meet in the corners between successive edges only"},
      {"[0.15, 0.2], [0.2, 0.25], [0.25, 0.2]]}\n        - {arc: [[0.25, 0.2], [0.2, 0.15], [0.15,",
       "[1.15, 0.2], [1.2, 0.25], [1.25, 0.2]]}\n        - {arc: [[1.25, 0.2], [1.2, 0.15], [1.15,",
       "panel 'front': hole 0 lies outside of the outline or in another hole: must lie inside"},
      {"outline:\n      - {line: [[0, 0], [0, 0.6], [0.4, 0.6]]}\n      - {quadratic: [[0.4, 0.6], "
       "[0.45, 0.3], [0.4, 0]], name: side}\n      - {line: [[0.4, 0], [0, 0]]}",
       "outline: [{line: [[0, 0], [0.001, 0], [0.001, 0.0005], [0, 0]]}]",
       "panel 'back': its area is 2.5e-07 m^2: allowed is >= 1e-06"},
      {"outline:\n      - {line: [[0, 0], [0, 0.6], [0.4, 0.6]]}\n      - {quadratic: [[0.4, 0.6], "
       "[0.45, 0.3], [0.4, 0]], name: side}\n      - {line: [[0.4, 0], [0, 0]]}",
       "outline: [{line: [[0, 0], [0.1, 0]]}, {line: [[0.1, 0], [0, 0]]}]",
       "panel 'back', edge 0: crosses or touches panel 'back', edge 1: outlines may meet in the "
       "corners between successive edges only"},
      {"[0.25, 0.6], [0.2, 0.4]]", "[0.25, 0.6], [0.25, 0.6]]",
       "panel 'front', edge 3 'left of dart': is 0 m long: allowed is >= 0.0001 m"},
      {"[0.45, 0.3], [0.4, 0]", "[20.5, 0.3], [0.4, 0]",
       "panel 'back', edge 1 'side': has the point (20.5, 0.3): allowed are up to 20 m in each "
       "direction"},
      {"name: back", "name: front", "panel 'front' is there twice: names must differ"},
      {"[0.15, 0.6], [0, 0.6]]", "[0.15, 0.6], [0, 0.6]], name: hem",
       "panel 'front', edge 5 'hem': another edge has the same name: names must differ"},
      {"layer: 1", "layer: 16", "panel 'front': layer is 16: allowed are 0 to 15"},
      {"carrier: torso", "carrier: tail",
       "panel 'back': carrier 'tail' is unknown: there are torso"},
      {"carriers:\n  - {name: torso, shape: cylinder, segment: spine}\n", "",
       "panel 'back': carrier 'torso' is unknown: there is none"},
      {"segment: spine}", "segment: spine}\n  - {name: torso, shape: cone, segment: neck}",
       "carrier 'torso' is there twice: names must differ"},
      {"along: 0.5", "along: 3.5",
       "panel 'back': lies at angle 3.14 rad, 3.5 along its carrier, turned by 0 rad: allowed are "
       "angles of -2 pi to 2 pi and -2 to 3"},
      {"angle: 3.14", "angle: 1e300",
       "panel 'back': lies at angle 1e+300 rad, 0.5 along its carrier, turned by 0 rad: allowed "
       "are "
       "angles of -2 pi to 2 pi and -2 to 3"},
      {"position: [0.2, 0, 1]", "position: [0.2, 0, 30]",
       "panel 'front': its position has a coordinate of 30 m: allowed are finite ones up to 20 m"},
  };
  for (const auto& [part, replacement, message] : refused) {
    EXPECT_EQ(refusalOf(panels(), part, replacement), std::string("small.yaml: ") + message)
        << part;
  }
}

TEST(GarmentRefusals, NameTheSeamAndWhatItsEasingAllows) {
  const Refused refused[] = {
      {"{panel: back, edges: [0]}], easing: 0.1", "{panel: back, edges: [2]}], easing: 0.1",
       "seam 1 of panel 'front', edge 6 to 0 and panel 'back', edge 2: the lengths differ by "
       "0.602461825027 of the longer one: its easing allows 0.1"},
      {"{panel: back, edges: [1], reversed: true}", "{panel: front, edges: [1], reversed: true}",
       "seam 0: sews panel 'front', edge 1 'side' to itself: the sides of a seam must be different "
       "edges"},
      {"{panel: back, edges: [0]}], easing: 0.1", "{panel: front, edges: [4, 6]}], easing: 0.1",
       "seam 1: sews panel 'front', edge 6 to itself: the sides of a seam must be different edges"},
      {"easing: 0.1", "easing: 1.5", "seam 1: easing is 1.5: allowed are 0 to 0.9"},
  };
  for (const auto& [part, replacement, message] : refused) {
    EXPECT_EQ(refusalOf(kSmallGarment, part, replacement), std::string("small.yaml: ") + message)
        << part;
  }
}

TEST(GarmentRefusals, NameTheFastenerThatIsOnNoPanel) {
  const Refused refused[] = {
      {"at: [0.3, 0.2]", "at: [0.6, 0.2]",
       "fastener 'button': (0.6, 0.2) is not on panel 'back': allowed are places within its "
       "outline "
       "and outside of its holes"},
      {"at: [0.05, 0.1]", "at: [0.2, 0.21]",
       "fastener 'button': (0.2, 0.21) is not on panel 'front': allowed are places within its "
       "outline and outside of its holes"},
      {"fasteners:\n",
       "fasteners:\n  - {name: button, between: [{panel: front, at: [0.1, 0.1]}, "
       "{panel: back, at: [0.1, 0.1]}]}\n",
       "fastener 'button' is there twice: names must differ"},
  };
  for (const auto& [part, replacement, message] : refused) {
    EXPECT_EQ(refusalOf(kSmallGarment, part, replacement), std::string("small.yaml: ") + message)
        << part;
  }
}

TEST(GarmentRefusals, NameTheKeyOfWhatCannotBeRead) {
  const Refused refused[] = {
      {"[[0.4, 0], [0.45, 0.3]", "[[0.4, .nan], [0.45, 0.3]",
       "panels[0].outline[1].quadratic[0][1]: '.nan' must be a finite number"},
      {"cubic", "spline",
       "panels[0].outline[6].spline: unknown key, allowed here: line, quadratic, "
       "cubic, arc, name"},
      {"{line: [[0.4, 0], [0, 0]]}", "{name: hem}",
       "panels[1].outline[2]: must have one of line, quadratic, cubic, arc"},
      {"name: hem", "arc: [[0, 0], [1, 1], [2, 0]]",
       "panels[0].outline[0]: has line and arc: allowed is one"},
      {"[[0.15, 0.2], [0.2, 0.25], [0.25, 0.2]]", "[[0.15, 0.2], [0.2, 0.2], [0.25, 0.2]]",
       "panels[0].holes[0][0].arc: panel 'front': the three points of an arc lie on a line: they "
       "must "
       "determine a circle"},
      {"[[0, 0], [0.4, 0]]", "[[0, 0]]",
       "panels[0].outline[0].line: panel 'front': a line has 1 points: allowed are >= 2"},
      {"grain: [0, 2]", "grain: [0, 0]",
       "panels[0].grain: a list of 2 must be a direction, longer than 1e-6"},
      {"name: hem", "name: 12",
       "panels[0].outline[0].name: '12' is a number: names of edges must have another character"},
      {"panel: back, edges: [1]", "panel: sleeve, edges: [1]",
       "seams[0].sides[1].panel: 'sleeve' is no panel"},
      {"panel: back, edges: [1]", "panel: back, edges: [3]",
       "seams[0].sides[1].edges[0]: '3' is no edge: allowed are names of edges and 0 to 2"},
      {"panel: back, edges: [1]", "panel: back, edges: [top]",
       "seams[0].sides[1].edges[0]: 'top' is no edge: allowed are names of edges and 0 to 2"},
      {"panel: back, edges: [1]", "panel: back, edges: [1, 2, 0]",
       "seams[0].sides[1].edges: a list of 3 must be a list of one edge or of the first and the "
       "last"},
      {"panel: back, edges: [1]", "panel: front, hole: 1, edges: [1]",
       "seams[0].sides[1].hole: '1' is no hole: panel 'front' has 1"},
      {"[left of dart, right of dart]", "[left of dart, side]",
       "darts[0].edges: a list of 2 must be two successive edges, which meet in the tip of the "
       "dart"},
      {"at: [0.3, 0.2]", "at: [0.3]",
       "fasteners[0].between[1].at: a list of 1 must be a list of 2"},
      {"{panel: back, at", "{panel: sleeve, at",
       "fasteners[0].between[1].panel: 'sleeve' is no panel"},
      {"shape: cylinder", "shape: sphere",
       "carriers[0].shape: 'sphere' must be one of cylinder, cone"},
  };
  for (const auto& [part, replacement, message] : refused) {
    EXPECT_EQ(refusalOf(kSmallGarment, part, replacement), std::string("small.yaml: ") + message)
        << part;
  }
}

TEST(GarmentRefusals, TooManyPanelsEdgesAndPoints) {
  std::string panels = "source: x\npanels:\n";
  for (int i = 0; i <= 500; ++i) {
    panels += "  - {name: p" + std::to_string(i) + ", fabric: wool, outline: []}\n";
  }
  EXPECT_EQ(refusalOf(panels, "x", "x"),
            "small.yaml: panels: a list of 501 is too long: allowed are up to 500");
  std::string zigzag;
  for (int i = 0; i < 10002; ++i) zigzag += "[" + std::to_string(i * 1e-4) + ", 0.1], [0, 0], ";
  EXPECT_EQ(refusalOf(kSmallGarment, "[0, 0], [0, 0.6], [0.4, 0.6]", zigzag + "[0.4, 0.6]"),
            "small.yaml: panels[1].outline[0].line: a list of 20005 is too long: allowed are up to "
            "20000");
}

TEST(GarmentRefusals, PatternsThatDidNotComeFromAFile) {
  Pattern pattern = parsePattern(kSmallGarment, "small.yaml");
  const auto refusal = [](const Pattern& of) -> std::string {
    return test::refusalOf([&] { requireSound(of, "made"); });
  };
  Pattern broken = pattern;
  broken.panels.clear();
  EXPECT_EQ(refusal(broken), "made: has 0 panels: allowed are 1 to 500");
  broken = pattern;
  broken.panels[0].outlines[1].clear();
  EXPECT_EQ(refusal(broken), "made: panel 'front': outline 1 has no edge: allowed are 1 or more");
  broken = pattern;
  broken.panels[0].warp *= std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal(broken),
            "made: panel 'front': the direction of the grain is (nan, nan): must be of length 1");
  broken = pattern;
  broken.panels[0].marks.assign(2001, {Eigen::Vector2d::Zero()});
  EXPECT_EQ(refusal(broken), "made: panel 'front': has 2001 marks: allowed are up to 2000");
  broken.panels[0].marks = {{Eigen::Vector2d(0.0, 21.0)}};
  EXPECT_EQ(refusal(broken),
            "made: panel 'front': a mark: has the point (0, 21): allowed are up to 20 m in each "
            "direction");
  broken = pattern;
  broken.seams[0].sides[0].panel = 2;
  EXPECT_EQ(refusal(broken), "made: seam 0: has panel 2: allowed are 0 to 1");
  broken = pattern;
  broken.seams[0].sides[0].outline = 2;
  EXPECT_EQ(refusal(broken), "made: seam 0: has hole 1 of panel 'front': it has 1");
  broken = pattern;
  broken.seams[0].sides[0].last = 7;
  EXPECT_EQ(refusal(broken), "made: seam 0: has edge 7 of panel 'front': allowed are 0 to 6");
}

class PatternText : public testing::Test {
 protected:
  PatternText()
      : path_(std::filesystem::temp_directory_path() /
              ("haptex_pattern_" + std::to_string(getpid()))) {}
  ~PatternText() override { std::filesystem::remove_all(path_); }
  std::filesystem::path path_;
};

TEST_F(PatternText, LargeFilesAreRefusedBeforeTheyAreRead) {
  std::ofstream(path_) << 'x';
  std::filesystem::resize_file(path_, kLargestPatternFile + 1);
  try {
    readPatternText(path_.string());
    FAIL() << "not refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(error.what(), path_.string() + ": has 8388609 bytes: allowed are up to 8388608");
  }
}

TEST_F(PatternText, WhatIsNoFileIsRefused) {
  EXPECT_THROW(readPatternText(path_.string()), std::runtime_error);
  std::filesystem::create_directory(path_);
  EXPECT_THROW(readPatternText(path_.string()), std::runtime_error);
  std::filesystem::remove(path_);
  ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
  EXPECT_THROW(readPatternText(path_.string()), std::runtime_error);
}

}  // namespace
}  // namespace haptex::garment::test_garment_refusals
