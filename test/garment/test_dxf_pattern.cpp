#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "dxf_text.h"
#include "haptex/garment/importers/dxf_pattern.h"
#include "haptex/garment/importers/dxf_reader.h"

namespace haptex::garment::test_dxf_pattern {
namespace {

using Eigen::Vector2d;

ImportedPattern import(const std::string& text, const std::string& sidecar = "") {
  return importDxf(text, "skirt.dxf", sidecar, "skirt.seams.yaml", "denim");
}

std::string refusal(const std::string& text, const std::string& sidecar = "") {
  return test::refusalOf([&] { import(text, sidecar); });
}

DxfText square() {
  return DxfText().block("A").polyline("1", {{0, 0}, {99, 0}, {99, 99}, {0, 99}});
}

TEST(DxfPattern, AHalfPieceIsUnfoldedAtItsMirrorLine) {
  const Panel front = import(smallDxf()).pattern.panels[0];
  EXPECT_EQ(front.name, "front");
  EXPECT_EQ(front.fabric, "denim");
  ASSERT_EQ(front.outlines.size(), 3u);  // its hole, twice
  EXPECT_NEAR(areaOf(front), 2.0 * (0.2 * 0.115 - 0.0002), 1e-15);
  // The fold is gone: corners are the four of the whole, with a notch on each half of the top.
  EXPECT_EQ(front.outlines[0].size(), 6u);
  double width = 0.0;
  for (const Edge& edge : front.outlines[0]) width = std::max(width, edge.curve.start().x());
  EXPECT_NEAR(width, 0.12, 1e-15);
  ASSERT_EQ(front.marks.size(), 4u);
  EXPECT_EQ(front.marks[0], (std::vector<Vector2d>{{0.03, 0.1}}));
  EXPECT_EQ(front.marks[3][0], Vector2d(-0.03, 0.1));
}

TEST(DxfPattern, ASewLineIsTheOutlineAndTurnPointsDivideIt) {
  const ImportedPattern imported = import(smallDxf());
  const Panel& back = imported.pattern.panels[1];
  EXPECT_EQ(back.name, "back");
  ASSERT_EQ(back.outlines[0].size(), 4u);
  // The side of three lines is one edge.
  EXPECT_EQ(back.outlines[0][1].curve.points().size(), 4u);
  EXPECT_NEAR(areaOf(back), 0.24 * 0.201 + 0.5 * 0.002 * 0.101, 1e-15);
  // The grain points downwards.
  EXPECT_EQ(back.warp, Vector2d(0.0, -1.0));
  EXPECT_EQ(imported.notes, std::vector<std::string>{
                                "skirt.dxf: piece 'BACK-M': is cut 2 times: one panel is made"});
}

TEST(DxfPattern, CornersDivideAnOutlineWithoutTurnPoints) {
  // A bend of 27 degrees is none, and one of 90 with a curve point is none either.
  const auto edges = [](const std::string& text) {
    return import(text).pattern.panels[0].outlines[0].size();
  };
  EXPECT_EQ(edges(square().str()), 4u);
  EXPECT_EQ(edges(square().point("3", {99, 99}).str()), 3u);
  EXPECT_EQ(edges(DxfText()
                      .block("A")
                      .polyline("1", {{0, 0}, {90, 0}, {110, 40}, {110, 80}, {0, 80}})
                      .str()),
            4u);
}

TEST(DxfPattern, LengthsAreInTheUnitOfTheFileOrOfItsSidecar) {
  const auto area = [](const std::string& units, const std::string& sidecar) {
    const std::string text =
        DxfText(units).block("A").polyline("1", {{0, 0}, {5, 0}, {5, 5}, {0, 5}}).str();
    return areaOf(import(text, sidecar).pattern.panels[0]);
  };
  EXPECT_NEAR(area("METRIC", ""), 25e-6, 1e-18);
  EXPECT_NEAR(area("English", ""), std::pow(5 * 0.0254, 2), 1e-15);
  EXPECT_NEAR(area("", "unit: cm"), 25e-4, 1e-15);
  EXPECT_NEAR(area("METRIC", "unit: inch"), std::pow(5 * 0.0254, 2), 1e-15);
  EXPECT_EQ(refusal(DxfText("").block("A").polyline("1", {{0, 0}, {5, 0}, {5, 5}}).str()),
            "skirt.dxf: does not say its unit ('', $INSUNITS 0): a sidecar with unit: mm, cm, m or "
            "inch must");
}

TEST(DxfPattern, SeamsAreThoseOfTheSidecar) {
  const std::string sidecar = R"(seams:
  - {sides: [{panel: front, edges: [0]}, {panel: back, edges: [3], reversed: true}]}
)";
  const Pattern pattern = import(smallDxf(), sidecar).pattern;
  ASSERT_EQ(pattern.seams.size(), 1u);
  EXPECT_EQ(pattern.seams[0].sides[1].panel, 1);
  EXPECT_EQ(refusal(smallDxf(),
                    "seams: [{sides: [{panel: front, edges: [9]}, {panel: back, edges: "
                    "[3]}]}]"),
            "skirt.seams.yaml: seams[0].sides[0].edges[0]: '9' is no edge: allowed are names of "
            "edges and 0 to 5");
  EXPECT_EQ(refusal(smallDxf(), "unit: mm\nunits: mm"),
            "skirt.seams.yaml: units: unknown key, allowed here: unit, size, seams, darts");
  EXPECT_THROW(import(smallDxf(), "seams: ["), std::runtime_error);
}

TEST(DxfPattern, AnOutlineMayBeSeveralLinesThatFollowEachOther) {
  // A quarter of a disc as AAMA files have it: a polyline per side, one of them turned around.
  DxfText::Points arc;
  for (int i = 0; i <= 12; ++i) {
    const double angle = 0.5 * M_PI * i / 12;
    arc.emplace_back(100 * std::cos(angle), 100 * std::sin(angle));
  }
  const auto text = [&] {
    return DxfText().block("A").polyline("1", {{0, 0}, {100, 0}}, false).polyline("1", arc, false);
  };
  const auto whole = text().line("1", {0, 0}, {0, 100});
  const Panel panel = import(whole.str()).pattern.panels[0];
  ASSERT_EQ(panel.outlines[0].size(), 3u);
  EXPECT_EQ(panel.outlines[0][1].curve.points().size(), 13u);
  EXPECT_NEAR(areaOf(panel), 0.5 * 0.01 * 12.0 * std::sin(M_PI / 24.0), 1e-7);
  EXPECT_EQ(refusal(text().str()),
            "skirt.dxf: piece 'A': the outline of layer 1 is open, its ends are 0.1 m apart: "
            "allowed are 0.0001 m");
}

TEST(DxfPattern, PanelsShowTheirRightSideWhicheverWayTheyAreDrawn) {
  const auto drawn = [](const DxfText::Points& points) {
    return import(DxfText().block("A").polyline("1", points).point("4", {50, 0}).str())
        .pattern.panels[0];
  };
  const Panel forwards = drawn({{0, 0}, {99, 0}, {99, 60}, {0, 60}});
  const Panel backwards = drawn({{0, 0}, {0, 60}, {99, 60}, {99, 0}});
  EXPECT_FALSE(isTurnedOver(backwards));
  EXPECT_EQ(backwards.outlines[0].size(), 5u);
  EXPECT_EQ(areaOf(backwards), areaOf(forwards));
}

TEST(DxfPattern, OnlyTheSampleSizeIsTaken) {
  DxfText text;
  for (const char* size : {"S", "M"}) {
    text.block(std::string("A-") + size).text(std::string("Size: ") + size);
    text.polyline("1", {{0, 0}, {99, 0}, {99, 99}});
  }
  EXPECT_EQ(import(text.str()).pattern.panels.size(), 2u);
  const ImportedPattern small = import(text.str(), "size: S");
  ASSERT_EQ(small.pattern.panels.size(), 1u);
  EXPECT_EQ(small.pattern.panels[0].name, "A-S");
  EXPECT_EQ(small.notes[0], "skirt.dxf: 1 pieces of other sizes than S are left out");
  text.text("Sample Size: M");
  EXPECT_EQ(import(text.str()).pattern.panels[0].name, "A-M");
}

TEST(DxfPattern, PiecesOfTheSameNameAreNamedByTheirBlocks) {
  DxfText text;
  for (const char* block : {"A-S", "A-M"}) {
    text.block(block).text("Piece Name: A").polyline("1", {{0, 0}, {99, 0}, {99, 99}});
  }
  const Pattern pattern = import(text.str()).pattern;
  EXPECT_EQ(pattern.panels[0].name, "A-S");
  EXPECT_EQ(pattern.panels[1].name, "A-M");
}

TEST(DxfPattern, ArcsOfPolylinesAreFollowed) {
  // A half circle above a line, as a light polyline.
  DxfText text;
  text.block("A").polyline("1", {{0, 0}, {0, 0}, {0, 0}});
  std::string drawn = text.str();
  const std::string light = "0\nLWPOLYLINE\n8\n1\n70\n1\n10\n100\n20\n0\n42\n1\n10\n-100\n20\n0\n";
  const std::size_t begin = drawn.find("0\r\nPOLYLINE"), end = drawn.find("0\r\nENDBLK");
  drawn.replace(begin, end - begin, light);
  const Panel panel = import(drawn).pattern.panels[0];
  EXPECT_NEAR(areaOf(panel), 0.5 * M_PI * 0.01, 3e-6);
  EXPECT_EQ(panel.outlines[0].size(), 2u);
}

TEST(DxfPattern, RefusesWhatIsNoPattern) {
  EXPECT_EQ(refusal(DxfText().block("A").polyline("1", {{0, 0}, {50, 0}, {50, 60}}, false).str()),
            "skirt.dxf: piece 'A': the outline of layer 1 is open, its ends are 0.0781024967591 m "
            "apart: allowed are 0.0001 m");
  EXPECT_EQ(refusal(square().polyline("1", {{0, 0}, {50, 0}, {50, 60}}).str()),
            "skirt.dxf: piece 'A': has 2 outlines (layer 1): allowed is one");
  EXPECT_EQ(refusal(DxfText().block("A").polyline("1", {{0, 0}, {50, 0}}).str()),
            "skirt.dxf: piece 'A': the outline of layer 1 has 2 points: allowed are 3 or more");
  EXPECT_EQ(
      refusal(DxfText().block("A").polyline("1", {{0, 0}, {90, 0}, {0, 80}, {90, 80}}).str()),
      "skirt.dxf: panel 'A', edge 1: crosses or touches panel 'A', edge 3: outlines may meet in "
      "the corners between successive edges only");
  DxfText lines;
  lines.block("A");
  for (int i = 0; i <= 2000; ++i) lines.line("1", {i, 0}, {i, 1});
  EXPECT_EQ(refusal(lines.str()),
            "skirt.dxf: piece 'A': layer 1 has 2001 lines: allowed are up to 2000");
  EXPECT_EQ(refusal(square().line("7", {5, 5}, {5, 5}).str()),
            "skirt.dxf: piece 'A': the grain line (layer 7) has no length");
  EXPECT_EQ(refusal(DxfText().str()), "skirt.dxf: has 0 panels: allowed are 1 to 500");
}

TEST(DxfReader, NamesTheLine) {
  const auto refused = [](const std::string& text) -> std::string {
    return test::refusalOf([&] { readDxf(text, "x.dxf"); });
  };
  const std::string begin = "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\n1\n10\n";
  EXPECT_EQ(refused(begin + "abc\n"), "x.dxf: line 10: 'abc' must be a number");
  EXPECT_EQ(refused(begin + "nan\n"), "x.dxf: line 10: nan: allowed are numbers up to 1000000000");
  EXPECT_EQ(refused(begin + "5\nx\n"), "x.dxf: line 11: 'x' must be a group code, a whole number");
  EXPECT_EQ(refused(begin + "5\n20"), "x.dxf: line 11: ends after the group code 20");
  EXPECT_EQ(refused("0\nSECTION\n2\nENTITIES\n0\nPOLYLINE\n8\n1\n0\nEOF\n"),
            "x.dxf: line 6: a POLYLINE without SEQEND");
  const std::string line = "5\n20\n5\n11\n6\n21\n6\n";
  EXPECT_EQ(refused(begin + line), "x.dxf: ends within the section ENTITIES, without ENDSEC");
  EXPECT_EQ(refused("0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n2\nA\n"),
            "x.dxf: ends within the section BLOCKS, without ENDSEC");
  EXPECT_EQ(refused(""), "x.dxf: has no section BLOCKS or ENTITIES: is it a DXF file?");
  EXPECT_EQ(refused("AutoCAD Binary DXF\r\n"),
            "x.dxf: is a binary DXF file: allowed are those in ASCII");
}

}  // namespace
}  // namespace haptex::garment::test_dxf_pattern
