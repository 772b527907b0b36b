#include <gtest/gtest.h>

#include <algorithm>
#include <exception>
#include <functional>
#include <string>

#include "dxf_text.h"
#include "garment_fixtures.h"
#include "haptex/garment/importers/dxf_pattern.h"
#include "haptex/garment/importers/garment_code.h"
#include "haptex/garment/triangulation/panel_mesh.h"
#include "malformed_text.h"

namespace haptex::garment::test_malformed_patterns {
namespace {

struct Outcome {
  int accepted = 0, refused = 0;
};

// Each is read and its panels are triangulated, or refused with what was wrong where.
Outcome readMalformed(const std::string& text,
                      const std::function<Pattern(const std::string&)>& read) {
  Outcome outcome;
  for (int seed = 0; seed < 200; ++seed) {
    const std::string malformed = malformedText(text, 1000 + seed);
    try {
      const Pattern pattern = read(malformed);
      requireSound(pattern, "again");
      for (const Panel& panel : pattern.panels) {
        const double edge_length = std::max(0.01, std::sqrt(areaOf(panel)) / 4.0);
        requireSound(triangulate(panel, edge_length).mesh);
      }
      ++outcome.accepted;
    } catch (const std::exception& error) {
      EXPECT_GT(std::string(error.what()).size(), 20u) << "seed " << seed;
      ++outcome.refused;
    }
  }
  return outcome;
}

void expectBoth(const Outcome& outcome) {
  EXPECT_EQ(outcome.accepted + outcome.refused, 200);
  EXPECT_GT(outcome.accepted, 0);
  EXPECT_GT(outcome.refused, 100);
}

TEST(MalformedPatterns, GarmentFilesAreReadOrRefused) {
  expectBoth(readMalformed(
      kSmallGarment, [](const std::string& text) { return parsePattern(text, "malformed.yaml"); }));
}

TEST(MalformedPatterns, JsonFilesAreReadOrRefused) {
  expectBoth(readMalformed(kTwoSquares, [](const std::string& text) {
    return importGarmentCode(text, "malformed.json", "wool");
  }));
}

TEST(MalformedPatterns, DxfFilesAreReadOrRefused) {
  expectBoth(readMalformed(smallDxf(), [](const std::string& text) {
    return importDxf(text, "malformed.dxf", "", "", "wool").pattern;
  }));
}

TEST(MalformedPatterns, SidecarsAreReadOrRefused) {
  const std::string sidecar =
      "unit: mm\nseams: [{sides: [{panel: front, edges: [0]}, {panel: back, edges: [3], reversed: "
      "true}], easing: 0.02}]\ndarts: []\n";
  expectBoth(readMalformed(sidecar, [](const std::string& text) {
    return importDxf(smallDxf(), "small.dxf", text, "malformed.seams.yaml", "wool").pattern;
  }));
}

TEST(MalformedPatterns, DeepNestingIsRefused) {
  const std::string deep(100000, '[');
  EXPECT_THROW(parsePattern(deep, "deep.yaml"), std::runtime_error);
  EXPECT_THROW(importGarmentCode(deep, "deep.json", "wool"), std::invalid_argument);
  const std::string closed = deep + std::string(100000, ']');
  EXPECT_THROW(importGarmentCode(closed, "deep.json", "wool"), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::garment::test_malformed_patterns
