// What is refused in files of readings, with file, line, what is wrong and what is allowed.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "haptex/material/tester_fabric.h"

namespace haptex::material::test_tester_refusals {
namespace {

struct Case {
  std::string name;
  std::string text;  ///< from the fifth line on, below kHead
  std::string message;
};

void PrintTo(const Case& refused, std::ostream* stream) { *stream << refused.name; }

const std::string kHead =
    "# units: tensile % gf/cm\n# units: shear deg N/m\n# units: compression mm gf/cm2\n"
    "test,direction,branch,x,y\n";

/// Of a file with the text, whose name is left out.
std::string refusalOf(const std::string& text, int pieces = 8) {
  const std::string path = testing::TempDir() + "haptex_" + std::to_string(getpid()) + ".csv";
  std::ofstream(path) << text;
  std::string message = "not refused";
  try {
    fitFabric(readTesterFile(path), "sample", pieces);
  } catch (const std::invalid_argument& error) {
    message = error.what();
    EXPECT_EQ(message.substr(0, path.size()), path);
    message = message.substr(path.size());
  }
  std::remove(path.c_str());
  return message;
}

class LineRefusals : public testing::TestWithParam<Case> {};

TEST_P(LineRefusals, NameLineAndWhatIsAllowed) {
  EXPECT_EQ(refusalOf(kHead + GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Readings, LineRefusals,
    testing::Values(
        Case{"NotFinite", "tensile,weft,loading,1,nan\n",
             ":5: y is nan, in SI nan; it must be finite"},
        Case{"Infinite", "tensile,weft,loading,inf,1\n",
             ":5: x is inf, in SI inf; it must be finite and >= 0"},
        Case{"NoNumber", "tensile,weft,loading,1,\n",
             ":5: y '' must be a number with a point for decimals"},
        Case{"UnknownTest", "tensil,weft,loading,1,1\n",
             ":5: test 'tensil' is unknown; allowed are bending, compression, shear, surface, "
             "tensile, value"},
        Case{"UnknownDirection", "tensile,bias,loading,1,1\n",
             ":5: direction 'bias' is unknown; allowed are weft, warp, or nothing"},
        Case{"NoDirection", "tensile,,loading,1,1\n",
             ":5: the direction of tensile is missing; allowed are weft, warp"},
        Case{"NeedlessDirection", "compression,weft,loading,1,1\n",
             ":5: compression has no direction; 'weft' must be left out"},
        Case{"UnknownBranch", "tensile,weft,up,1,1\n",
             ":5: branch 'up' is unknown; allowed are loading, unloading"},
        Case{"Columns", "tensile,weft,loading,1\n",
             ":5: has 4 columns, must have 5: test,direction,branch,x,y"},
        Case{"NoUnits", "bending,weft,loading,1,1\n",
             ":5: no units of bending before this line; write '# units: bending X Y' with X one of "
             "1/m, 1/cm and Y one of N, gf.cm/cm"},
        Case{"UnknownUnit", "# units: tensile % lbf\n",
             ":5: unit 'lbf' of tensile's y is unknown; allowed are N/m, gf/cm, N"},
        Case{
            "NoWidth", "# units: tensile % N\ntensile,weft,loading,1,1\n",
            ":6: no width before this line; with forces in N write, for example, '# width: 50 mm'"},
        Case{"UnknownValue", "value,weft,E50,1,%\n",
             ":5: value 'E50' is unknown; allowed are 2HB, 2HG, 2HG5, B, C, E100, E20, E5, EB5, "
             "EMT, "
             "G, LC, LT, MIU, MMD, RC, RT, SMD, T0, T100, T2, TM, W, WC, WT"},
        Case{"UnitOfValue", "value,,W,150,oz\n",
             ":5: unit 'oz' of W is unknown; allowed are kg/m2, g/m2, mg/cm2"},
        Case{"NegativeThickness", "compression,,loading,-0.4,1\n",
             ":5: x is -0.4, in SI -0.0004; it must be finite and > 0"},
        Case{"NegativePressure", "compression,,loading,0.4,-1\n",
             ":5: y is -1, in SI -98.0665; it must be finite and >= 0"},
        Case{"NegativeStatedThickness", "value,,T0,-0.4,mm\n",
             ":5: T0 is -0.4, in SI -0.0004; it must be finite and > 0"},
        Case{"ResilienceOfMoreThanAll", "value,weft,RT,130,%\n",
             ":5: RT is 130, in SI 1.3; it must be from 0.1 to 1"},
        Case{"TwiceStated", "value,weft,B,1,N.m\nvalue,weft,B,2,N.m\n",
             ":6: B of the same direction is there twice; it must be there once"},
        Case{"Provenance", "# provenance: guessed\n",
             ":5: provenance 'guessed' is unknown; allowed are measured, representative"},
        Case{"FallingStress",
             "tensile,weft,loading,1,100\ntensile,weft,loading,2,500\ntensile,weft,loading,3,400\n",
             ":7: the stress falls from 490.3325 to 392.266 (SI) while the branch is loading; it "
             "may "
             "fall by at most 5 % of 490.3325: leave out what is torn or slips"},
        Case{"FallingOnTheOtherSide",
             "shear,weft,loading,-1,-1\nshear,weft,loading,-2,-2\nshear,weft,loading,-3,-1\n",
             ":7: the stress falls from 2 to 1 (SI) while the branch is loading; it may fall by at "
             "most 5 % of 2: leave out what is torn or slips"}),
    [](const auto& info) { return info.param.name; });

TEST(TesterFile, NeedsTheLineOfColumns) {
  EXPECT_EQ(refusalOf("strain,stress\n"),
            ":1: must be the line of columns, test,direction,branch,x,y");
  EXPECT_EQ(refusalOf("# nothing\n"),
            ":1: the line of columns is missing, test,direction,branch,x,y");
}

// A second specimen starts from nothing again.
TEST(TesterFile, TakesSeveralSpecimensAndFilesOfSpreadsheets) {
  const std::string path = testing::TempDir() + "haptex_" + std::to_string(getpid()) + "_2.csv";
  std::ofstream(path) << "\xef\xbb\xbf# units: tensile 1 N/m\r\ntest,direction,branch,x,y\r\n"
                         "tensile,weft,loading,0.01,1\r\ntensile,weft,loading,0.02,3\r\n"
                         "tensile, weft ,loading,0.005,0.4\r\ntensile,weft,loading,0.02,2.8\r\n"
                         "tensile,weft,unloading,0.01,0.5\r\nvalue,weft,B,1,uN.m\r\n"
                         "value,warp,B,3,uN.m\r\n";
  const TesterFile file = readTesterFile(path);
  std::remove(path.c_str());
  EXPECT_EQ(file.loop(TesterTest::kTensile, "weft").loading.size(), 4U);
  EXPECT_EQ(file.loop(TesterTest::kTensile, "weft").unloading.at(0).line, 7U);
  EXPECT_TRUE(file.loop(TesterTest::kTensile, "warp").loading.empty());
  EXPECT_DOUBLE_EQ(*file.value("B", "warp"), 3e-6);
  EXPECT_DOUBLE_EQ(*file.value("B"), 2e-6);
  EXPECT_FALSE(file.value("2HB", "warp"));
}

const std::string kStretch =
    "value,,W,0.2,kg/m2\nvalue,,EMT,5,%\nvalue,,LT,0.6,1\nvalue,,G,40,N/m\n";

TEST(TesterFabric, SaysWhatIsMissingOrDoesNotFit) {
  const auto with = [](const std::string& text) { return refusalOf(kHead + kStretch + text); };
  EXPECT_EQ(with(""), "not refused");
  EXPECT_EQ(refusalOf(kHead), ": areal density is missing: give the value W");
  EXPECT_EQ(
      refusalOf(kHead + "value,,W,0.2,kg/m2\n"),
      ": tensile weft is missing: give readings of tensile, the KES values EMT and LT or WT, or "
      "the FAST values E5, E20 and E100");
  EXPECT_EQ(refusalOf(kHead + "value,,W,0.2,kg/m2\nvalue,,EMT,5,%\nvalue,,LT,0.6,1\n"),
            ": shear is missing: give readings of shear, the value G, or the FAST value EB5");
  EXPECT_EQ(
      with("value,weft,RT,60,%\n"),
      ": resilience is there of one direction only: give unloading readings of tensile or RT of "
      "both, or of none");
  EXPECT_EQ(with("value,,2HG,1,N/m\n"), ": shear has one of 2HG and 2HG5 only: give both or none");
  EXPECT_EQ(with("value,weft,B,1,N.m\n"),
            ": bending has the rigidity of one direction only: give both or none");
  EXPECT_EQ(with("value,,T0,0.4,mm\n"),
            ": compression has T0 without the rest: give T0, TM and WC or LC, or T2 and T100");
  EXPECT_EQ(with("value,,T2,0.4,mm\nvalue,,T100,0.1,mm\n"),
            ": compression has T2 0.0004 m and T100 0.0001 m; T2 must be greater than T100 and at "
            "most 3.68 times as much");
  EXPECT_EQ(with("compression,,loading,0.4,1\ncompression,,loading,0.3,50\n"),
            ": compression has pressures from 98.0665 to 4903.325 Pa; readings must reach from "
            "49.03325 (or between that and its half) to 4903.325 Pa, 0.5 and 50 gf/cm2");
  EXPECT_EQ(with("tensile,weft,loading,1,10\ntensile,weft,loading,2,30\n"),
            ": tensile weft has 2 different readings, must have at least 4");
  EXPECT_EQ(with("shear,weft,loading,3,1\nshear,weft,unloading,3,1\n"),
            ": shear reaches 3 degrees; a loop must reach 5 degrees, where 2HG5 is read");
  EXPECT_EQ(
      with("# units: bending 1/m N\nbending,weft,loading,60,1e-3\nbending,weft,loading,140,2e-3\n"
           "bending,weft,unloading,60,2e-3\nbending,weft,unloading,140,3e-3\n"),
      ": bending weft has a larger moment while unloading than while loading, by 0.001 N at 100 "
      "1/m: loading is where the amount of curvature grows");
}

}  // namespace
}  // namespace haptex::material::test_tester_refusals
