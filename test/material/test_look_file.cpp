// The section `look` of fabric files.
#include <gtest/gtest.h>

#include <string>

#include "fabric_file_fixtures.h"
#include "haptex/material/fabric_file.h"
#include "haptex/material/glued_layers.h"

namespace haptex::material::test_look_file {
namespace {

const std::string kLook = R"(look:
  provenance: measured
  source: spectrophotometer
  warp: [0.02, 0.04, 0.12]
  weft: [0.6, 0.58, 0.52]
  gloss: 0.03
  width: 0.7
)";
const std::string kKnit = R"(surface:
  kes: {unit: m, provenance: measured, source: KES-FB4, SMD: 4e-6, MMD: 0.016}
  knit: {unit: m, provenance: measured, source: counted, wale: 2e-3, course: 2e-3, irregularity: 0}
)";
const std::string kDyed = kFull + kLook;

TEST(LookFile, ReadsEveryNumberWithItsProvenance) {
  const Fabric fabric = loadFabric(TemporaryFile(kDyed).path());
  ASSERT_TRUE(fabric.look);
  EXPECT_EQ(fabric.look->warp, (Colour{0.02, 0.04, 0.12}));
  EXPECT_EQ(fabric.look->weft, (Colour{0.6, 0.58, 0.52}));
  EXPECT_EQ(fabric.look->gloss, 0.03);
  EXPECT_EQ(fabric.look->width, 0.7);
  EXPECT_EQ(fabric.provenance.at("look").kind, Provenance::Kind::kMeasured);
  EXPECT_EQ(fabric.provenance.at("look").source, "spectrophotometer");
}

TEST(LookFile, LeavesOutALookThatIsNotThere) {
  EXPECT_FALSE(loadFabric(TemporaryFile(kFull).path()).look);
}

TEST(LookFile, AcceptsTheEndsOfEveryRange) {
  std::string text = replaced(kDyed, "[0.02, 0.04, 0.12]", "[0, 1, 0]");
  text = replaced(replaced(text, "gloss: 0.03", "gloss: 1"), "width: 0.7", "width: 1");
  EXPECT_NO_THROW(loadFabric(TemporaryFile(text).path()));
  EXPECT_NO_THROW(loadFabric(TemporaryFile(replaced(kDyed, "gloss: 0.03", "gloss: 0")).path()));
}

TEST(LookFile, OfGluedLayersIsThatOfTheFace) {
  const Fabric face = loadFabric(TemporaryFile(kDyed).path());
  const Fabric back = loadFabric(TemporaryFile(kFull).path());
  const Fabric glued = glue({face, back}, "two");
  ASSERT_TRUE(glued.look);
  EXPECT_EQ(glued.look->weft, face.look->weft);
  EXPECT_EQ(glued.provenance.at("look").source, "spectrophotometer");
  EXPECT_FALSE(glue({back, face}, "two").look);
}

class LookFileRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(LookFileRefuses, NamingFileKeyValueAndWhatIsAllowed) { expectRefusal(kDyed, GetParam()); }

const std::string kKeys = "provenance, source, warp, weft, gloss, width";

INSTANTIATE_TEST_SUITE_P(
    Values, LookFileRefuses,
    testing::Values(
        Refusal{"UnknownKey", "gloss: 0.03", "shine: 0.03", "look.shine",
                "unknown key, allowed here: " + kKeys},
        Refusal{"MissingColour", "  weft: [0.6, 0.58, 0.52]\n", "", "look",
                "the key 'weft' is missing, required here: " + kKeys},
        Refusal{"NoProvenance", "  provenance: measured\n  source: spectro", "  source: spectro",
                "look", "the key 'provenance' is missing, required here: " + kKeys},
        Refusal{"ColourOfTwoShares", "[0.6, 0.58, 0.52]", "[0.6, 0.58]", "look.weft",
                "a list of 2 must be a list of 3"},
        Refusal{"ColourInBytes", "[0.6, 0.58, 0.52]", "[153, 0.58, 0.52]", "look.weft[0]",
                "'153' must be from 0 to 1"},
        Refusal{"NegativeColour", "[0.02, 0.04", "[0.02, -0.04", "look.warp[1]",
                "'-0.04' must be from 0 to 1"},
        Refusal{"NanColour", "[0.02, 0.04", "[.nan, 0.04", "look.warp[0]",
                "'.nan' must be a finite number"},
        Refusal{"MoreThanAllTheLight", "gloss: 0.03", "gloss: 1.01", "look.gloss",
                "'1.01' must be from 0 to 1"},
        Refusal{"NoWidth", "width: 0.7", "width: 0", "look.width", "'0' must be > 0 and at most 1"},
        Refusal{"InfiniteWidth", "width: 0.7", "width: .inf", "look.width",
                "'.inf' must be a finite number"},
        Refusal{"KnitOfTwoColours", "look:\n", kKnit + "look:\n", "look.weft",
                "[0.6, 0.58, 0.52] must be as warp, [0.02, 0.04, 0.12]: a knit has one yarn"}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace haptex::material::test_look_file
