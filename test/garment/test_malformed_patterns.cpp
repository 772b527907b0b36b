#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include "dxf_text.h"
#include "garment_fixtures.h"
#include "haptex/base/repeatable_random.h"
#include "haptex/garment/importers/dxf_pattern.h"
#include "haptex/garment/importers/garment_code.h"
#include "haptex/garment/triangulation/panel_mesh.h"

namespace haptex::garment::test_malformed_patterns {
namespace {

using base::RepeatableRandom;

std::size_t below(RepeatableRandom& random, std::size_t count) {
  return static_cast<std::size_t>(random.below(static_cast<int>(count)));
}

// One of the numbers in a text becomes another one.
void replaceNumber(std::string& text, RepeatableRandom& random) {
  const std::array<const char*, 12> others = {"nan", "1e308", "-1e308", "-1",   "0",  "1e-320",
                                              "",    "1e999", "0.3",    "1e-9", "99", "2147483648"};
  const std::size_t begin = text.find_first_of("0123456789", below(random, text.size()));
  if (begin == std::string::npos) return;
  const std::size_t end = text.find_first_not_of("0123456789.-", begin);
  text.replace(begin, std::min(end, text.size()) - begin, others[below(random, others.size())]);
}

void mutate(std::string& text, RepeatableRandom& random) {
  if (text.empty()) return;
  const std::size_t at = below(random, text.size());
  const std::size_t length = 1 + below(random, std::min<std::size_t>(40, text.size() - at));
  switch (below(random, 7)) {
    case 0:
      text.erase(at, length);
      break;
    case 1:
      text.insert(at, text.substr(below(random, text.size()), length));
      break;
    case 2:
      text[at] = static_cast<char>(below(random, 256));
      break;
    case 3:
      text.resize(at);
      break;
    case 4:
      text.insert(at, std::string(length, "[{(:,-\"0"[below(random, 8)]));
      break;
    default:
      replaceNumber(text, random);
      break;
  }
}

struct Outcome {
  int accepted = 0, refused = 0;
};

// Each is read and its panels are triangulated, or refused with what was wrong where.
Outcome readMalformed(const std::string& text,
                      const std::function<Pattern(const std::string&)>& read) {
  Outcome outcome;
  for (int seed = 0; seed < 200; ++seed) {
    RepeatableRandom random(1000 + seed);
    std::string malformed = text;
    const std::size_t mutations = 1 + below(random, 3);
    for (std::size_t i = 0; i < mutations; ++i) mutate(malformed, random);
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
