// The section `surface` of fabric files.
#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "fabric_file_fixtures.h"
#include "haptex/material/fabric_file.h"

namespace haptex::material::test_surface_file {
namespace {

const std::string kKesValues = "SMD: 4e-6, MMD: 0.016";
const std::string kSurface = R"(surface:
  kes: {unit: m, provenance: measured, source: KES-FB4, SMD: 4e-6, MMD: 0.016}
)";
const std::string kWeave = R"(  weave:
    unit: m
    provenance: representative
    source: counted on a similar fabric
    kind: twill_2_2
    weft: {spacing: 5e-4, height: 1e-4}
    warp: {spacing: 4e-4, height: 2e-4}
    irregularity: 0.15
)";
const std::string kHeights = R"(  heights:
    unit: m
    provenance: measured
    source: laser scan
    file: twill.png
    spacing: 5e-5
    height: 3e-4
    periodic: false
)";
const std::string kKnit = R"(  knit:
    unit: m
    provenance: representative
    source: as long as its loops let it be
    wale: 1.8e-3
    course: 1.4e-3
    irregularity: 0.1
)";
const std::string kWoven = kFull + kSurface + kWeave;
const std::string kScanned = kFull + kSurface + kHeights;

Surface surfaceOf(const std::string& text) {
  const Fabric fabric = loadFabric(TemporaryFile(text).path());
  if (!fabric.surface) throw std::runtime_error("the fabric has no surface");
  return *fabric.surface;
}

TEST(SurfaceFile, ReadsEveryNumberOfAWeave) {
  const Surface surface = surfaceOf(kWoven);
  EXPECT_EQ(surface.roughness, 4e-6);
  EXPECT_EQ(surface.friction_deviation, 0.016);
  const Weave& weave = std::get<Weave>(surface.relief);
  EXPECT_EQ(weave.kind, WeaveKind::kTwill22);
  EXPECT_EQ(weave.weft.spacing, 5e-4);
  EXPECT_EQ(weave.weft.height, 1e-4);
  EXPECT_EQ(weave.warp.spacing, 4e-4);
  EXPECT_EQ(weave.warp.height, 2e-4);
  EXPECT_EQ(weave.irregularity, 0.15);
}

TEST(SurfaceFile, ReadsEveryNumberOfAKnit) {
  const Fabric fabric = loadFabric(TemporaryFile(kFull + kSurface + kKnit).path());
  const Knit& knit = std::get<Knit>(fabric.surface->relief);
  EXPECT_EQ(knit.wale, 1.8e-3);
  EXPECT_EQ(knit.course, 1.4e-3);
  EXPECT_EQ(knit.irregularity, 0.1);
  EXPECT_EQ(fabric.provenance.at("surface.knit").source, "as long as its loops let it be");
}

TEST(SurfaceFile, KnowsEveryWeave) {
  const std::vector<std::pair<std::string, WeaveKind>> kinds = {{"plain", WeaveKind::kPlain},
                                                                {"twill_2_2", WeaveKind::kTwill22},
                                                                {"twill_3_1", WeaveKind::kTwill31},
                                                                {"satin_5", WeaveKind::kSatin5},
                                                                {"rib_2", WeaveKind::kRib2}};
  for (const auto& [name, kind] : kinds) {
    const Surface surface = surfaceOf(replaced(kWoven, "kind: twill_2_2", "kind: " + name));
    EXPECT_EQ(std::get<Weave>(surface.relief).kind, kind) << name;
  }
}

TEST(SurfaceFile, FindsItsHeightsFromTheTextOfTheFabricAlone) {
  const Fabric fabric = loadFabric(TemporaryFile(kScanned).path());
  const std::string heights = std::get<HeightFile>(fabric.surface->relief).path;
  const Fabric again = parseFabric(fabric.file, "elsewhere/fabric");
  EXPECT_EQ(std::get<HeightFile>(again.surface->relief).path,
            std::filesystem::absolute(heights).string());
  EXPECT_EQ(again.surface->roughness, fabric.surface->roughness);
}

TEST(SurfaceFile, ReadsEveryNumberOfAFileOfHeights) {
  const HeightFile heights = std::get<HeightFile>(surfaceOf(kScanned).relief);
  EXPECT_EQ(heights.spacing, 5e-5);
  EXPECT_EQ(heights.height, 3e-4);
  EXPECT_FALSE(heights.periodic);
  const Surface tile = surfaceOf(replaced(kScanned, "periodic: false", "periodic: true"));
  EXPECT_TRUE(std::get<HeightFile>(tile.relief).periodic);
}

TEST(SurfaceFile, FindsTheHeightsFromTheDirectoryOfTheFabricFile) {
  const auto path_of = [](const std::string& file) {
    const Surface surface = surfaceOf(replaced(kScanned, "twill.png", file));
    return std::filesystem::path(std::get<HeightFile>(surface.relief).path);
  };
  const std::filesystem::path directory(testing::TempDir());
  EXPECT_EQ(path_of("twill.png"), directory / "twill.png");
  EXPECT_EQ(path_of("scans/twill.raw"), directory / "scans/twill.raw");
  EXPECT_EQ(path_of("/scans/twill.png"), "/scans/twill.png");
}

TEST(SurfaceFile, KeepsTheProvenanceOfKesValuesAndRelief) {
  const auto woven = loadFabric(TemporaryFile(kWoven).path()).provenance;
  ASSERT_EQ(woven.size(), 10u);
  EXPECT_EQ(woven.at("surface.kes").kind, Provenance::Kind::kMeasured);
  EXPECT_EQ(woven.at("surface.kes").source, "KES-FB4");
  EXPECT_EQ(woven.at("surface.weave").kind, Provenance::Kind::kRepresentative);
  EXPECT_EQ(woven.at("surface.weave").source, "counted on a similar fabric");
  const auto scanned = loadFabric(TemporaryFile(kScanned).path()).provenance;
  ASSERT_EQ(scanned.size(), 10u);
  EXPECT_EQ(scanned.at("surface.heights").source, "laser scan");
}

TEST(SurfaceFile, LeavesOutASurfaceThatIsNotThere) {
  EXPECT_FALSE(loadFabric(TemporaryFile(kFull).path()).surface);
}

TEST(SurfaceFile, AcceptsTheEndsOfEveryRange) {
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"SMD: 4e-6", "SMD: 1e-3"},
           {"MMD: 0.016", "MMD: 0"},
           {"MMD: 0.016", "MMD: 0.25"},  // MIU
           {"spacing: 5e-4", "spacing: 2e-4"},
           {"spacing: 5e-4", "spacing: 3e-3"},
           {"height: 1e-4", "height: 0"},
           {"height: 1e-4", "height: 3e-3"},
           {"irregularity: 0.15", "irregularity: 0"},
           {"irregularity: 0.15", "irregularity: 0.5"}}) {
    EXPECT_NO_THROW(surfaceOf(replaced(kWoven, from, to))) << to;
  }
  EXPECT_NO_THROW(surfaceOf(replaced(kScanned, "spacing: 5e-5", "spacing: 1e-3")));
  EXPECT_NO_THROW(surfaceOf(replaced(kScanned, "height: 3e-4", "height: 1e-2")));
}

class WovenSurfaceRefuses : public testing::TestWithParam<Refusal> {};
class ScannedSurfaceRefuses : public testing::TestWithParam<Refusal> {};
class KnittedSurfaceRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(WovenSurfaceRefuses, NamingFileKeyValueAndWhatIsAllowed) {
  expectRefusal(kWoven, GetParam());
}

TEST_P(ScannedSurfaceRefuses, NamingFileKeyValueAndWhatIsAllowed) {
  expectRefusal(kScanned, GetParam());
}

TEST_P(KnittedSurfaceRefuses, NamingFileKeyValueAndWhatIsAllowed) {
  expectRefusal(kFull + kSurface + kKnit, GetParam());
}

const std::string kKesKeys = "unit, provenance, source, SMD, MMD";
const std::string kWeaveKeys = "unit, provenance, source, kind, weft, warp, irregularity";
const std::string kHeightKeys = "unit, provenance, source, file, spacing, height, periodic";
const std::string kFriction =
    "friction: {provenance: representative, source: a guess, value: 0.25}\n";

INSTANTIATE_TEST_SUITE_P(
    Kes, WovenSurfaceRefuses,
    testing::Values(
        Refusal{"SurfaceNotAMap", kSurface + kWeave, "surface: smooth\n", "surface",
                "'smooth' must be a map with the keys kes, weave, knit, heights"},
        Refusal{"UnknownSurfaceKey", kSurface, kSurface + "  colour: red\n", "surface.colour",
                "unknown key, allowed here: kes, weave, knit, heights"},
        Refusal{"NoKes", kSurface, "surface:\n", "surface",
                "the key 'kes' is missing, required here: kes"},
        Refusal{"NoRelief", kWeave, "", "surface", "must have exactly one of weave, knit, heights"},
        Refusal{"TwoReliefs", kWeave, kWeave + kHeights, "surface",
                "must have exactly one of weave, knit, heights"},
        Refusal{"WithoutFriction", kFriction, "", "",
                "the key 'friction' is missing, required together with surface"},
        Refusal{"UnknownKesKey", kKesValues, kKesValues + ", MIU: 0.2", "surface.kes.MIU",
                "unknown key, allowed here: " + kKesKeys},
        Refusal{"MissingMmd", ", MMD: 0.016", "", "surface.kes",
                "the key 'MMD' is missing, required here: " + kKesKeys},
        Refusal{"KesWithoutSource", "source: KES-FB4, ", "", "surface.kes",
                "the key 'source' is missing, required here: " + kKesKeys},
        Refusal{"KesUnit", "kes: {unit: m, provenance: measured, source: KES-FB4",
                "kes: {unit: um, provenance: measured, source: KES-FB4", "surface.kes.unit",
                "'um' must be m"},
        Refusal{"UnknownKesProvenance", "measured, source: KES-FB4", "felt, source: KES-FB4",
                "surface.kes.provenance", "'felt' must be one of measured, representative"},
        Refusal{"SmdInMicrometres", "SMD: 4e-6", "SMD: 4", "surface.kes.SMD",
                "'4' must be > 0 and at most 0.001 m"},
        Refusal{"NoSmd", "SMD: 4e-6", "SMD: 0", "surface.kes.SMD",
                "'0' must be > 0 and at most 0.001 m"},
        Refusal{"NanSmd", "SMD: 4e-6", "SMD: .nan", "surface.kes.SMD",
                "'.nan' must be a finite number"},
        Refusal{"NegativeMmd", "MMD: 0.016", "MMD: -0.016", "surface.kes.MMD",
                "'-0.016' must be from 0 to 1"},
        Refusal{"LargeMmd", "MMD: 0.016", "MMD: 1.6", "surface.kes.MMD",
                "'1.6' must be from 0 to 1"},
        Refusal{"InfiniteMmd", "MMD: 0.016", "MMD: .inf", "surface.kes.MMD",
                "'.inf' must be a finite number"},
        Refusal{"MmdAboveMiu", "MMD: 0.016", "MMD: 0.26", "surface.kes.MMD",
                "'0.26' must be at most the coefficient of friction, 0.25"}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Weaves, WovenSurfaceRefuses,
    testing::Values(
        Refusal{"WeaveNotAMap", kWeave, "  weave: plain\n", "surface.weave",
                "'plain' must be a map with the keys " + kWeaveKeys},
        Refusal{"UnknownWeaveKey", "    irregularity", "    twist: 1\n    irregularity",
                "surface.weave.twist", "unknown key, allowed here: " + kWeaveKeys},
        Refusal{"MissingKind", "    kind: twill_2_2\n", "", "surface.weave",
                "the key 'kind' is missing, required here: " + kWeaveKeys},
        Refusal{"UnknownKind", "kind: twill_2_2", "kind: herringbone", "surface.weave.kind",
                "'herringbone' must be one of plain, twill_2_2, twill_3_1, satin_5, rib_2"},
        Refusal{"WeaveUnit", "  weave:\n    unit: m", "  weave:\n    unit: mm",
                "surface.weave.unit", "'mm' must be m"},
        Refusal{"BlankWeaveSource", "source: counted on a similar fabric", "source: ' '",
                "surface.weave.source", "' ' must be a text that is not empty"},
        Refusal{"UnknownYarnKey", "weft: {spacing", "weft: {count: 40, spacing",
                "surface.weave.weft.count", "unknown key, allowed here: spacing, height"},
        Refusal{"MissingHeight", "spacing: 4e-4, height: 2e-4", "spacing: 4e-4",
                "surface.weave.warp",
                "the key 'height' is missing, required here: spacing, height"},
        Refusal{"NarrowSpacing", "spacing: 5e-4", "spacing: 1.9e-4", "surface.weave.weft.spacing",
                "'1.9e-4' must be from 0.0002 to 0.003 m"},
        Refusal{"WideSpacing", "spacing: 4e-4", "spacing: 0.4", "surface.weave.warp.spacing",
                "'0.4' must be from 0.0002 to 0.003 m"},
        Refusal{"NanSpacing", "spacing: 4e-4", "spacing: .nan", "surface.weave.warp.spacing",
                "'.nan' must be a finite number"},
        Refusal{"NegativeHeight", "height: 1e-4", "height: -1e-4", "surface.weave.weft.height",
                "'-1e-4' must be from 0 to 0.003 m"},
        Refusal{"TallYarns", "height: 2e-4", "height: 0.2", "surface.weave.warp.height",
                "'0.2' must be from 0 to 0.003 m"},
        Refusal{"InfiniteHeight", "height: 2e-4", "height: .inf", "surface.weave.warp.height",
                "'.inf' must be a finite number"},
        Refusal{"FlatRelief", "1e-4}\n    warp: {spacing: 4e-4, height: 2e-4}",
                "0}\n    warp: {spacing: 4e-4, height: 0}", "surface.weave",
                "the height of weft or warp must be > 0: the relief is flat"},
        Refusal{"NegativeIrregularity", "irregularity: 0.15", "irregularity: -0.1",
                "surface.weave.irregularity", "'-0.1' must be from 0 to 0.5"},
        Refusal{"IrregularityInPercent", "irregularity: 0.15", "irregularity: 15",
                "surface.weave.irregularity", "'15' must be from 0 to 0.5"},
        Refusal{"NanIrregularity", "irregularity: 0.15", "irregularity: .nan",
                "surface.weave.irregularity", "'.nan' must be a finite number"}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Knit, KnittedSurfaceRefuses,
    testing::Values(
        Refusal{"BesideAWeave", "  knit:", kWeave + "  knit:", "surface",
                "must have exactly one of weave, knit, heights"},
        Refusal{
            "MissingCourse", "    course: 1.4e-3\n", "", "surface.knit",
            "the key 'course' is missing, required here: unit, provenance, source, wale, course, "
            "irregularity"},
        Refusal{"KnitUnit", "  knit:\n    unit: m", "  knit:\n    unit: mm", "surface.knit.unit",
                "'mm' must be m"},
        Refusal{"NarrowWale", "wale: 1.8e-3", "wale: 1e-4", "surface.knit.wale",
                "'1e-4' must be from 0.0004 to 0.006 m"},
        Refusal{"NanCourse", "course: 1.4e-3", "course: .nan", "surface.knit.course",
                "'.nan' must be a finite number"},
        Refusal{"KnitInPercent", "irregularity: 0.1", "irregularity: 10",
                "surface.knit.irregularity", "'10' must be from 0 to 0.5"}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Heights, ScannedSurfaceRefuses,
    testing::Values(Refusal{"HeightsNotAMap", kHeights, "  heights: twill.png\n", "surface.heights",
                            "'twill.png' must be a map with the keys " + kHeightKeys},
                    Refusal{"UnknownHeightKey", "    file", "    columns: 100\n    file",
                            "surface.heights.columns", "unknown key, allowed here: " + kHeightKeys},
                    Refusal{"MissingFile", "    file: twill.png\n", "", "surface.heights",
                            "the key 'file' is missing, required here: " + kHeightKeys},
                    Refusal{"HeightUnit", "  heights:\n    unit: m", "  heights:\n    unit: um",
                            "surface.heights.unit", "'um' must be m"},
                    Refusal{"UnknownFormat", "twill.png", "twill.tiff", "surface.heights.file",
                            "'twill.tiff' must end in .png or .raw"},
                    Refusal{"NoFileName", "twill.png", "''", "surface.heights.file",
                            "'' must be a text that is not empty"},
                    Refusal{"NoSampleSpacing", "spacing: 5e-5", "spacing: 0",
                            "surface.heights.spacing", "'0' must be > 0 and at most 0.001 m"},
                    Refusal{"SampleSpacingInMillimetres", "spacing: 5e-5", "spacing: 0.05",
                            "surface.heights.spacing", "'0.05' must be > 0 and at most 0.001 m"},
                    Refusal{"NanSampleSpacing", "spacing: 5e-5", "spacing: .nan",
                            "surface.heights.spacing", "'.nan' must be a finite number"},
                    Refusal{"NoFieldHeight", "height: 3e-4", "height: 0", "surface.heights.height",
                            "'0' must be > 0 and at most 0.01 m"},
                    Refusal{"FieldHeightInMillimetres", "height: 3e-4", "height: 0.3",
                            "surface.heights.height", "'0.3' must be > 0 and at most 0.01 m"},
                    Refusal{"InfiniteFieldHeight", "height: 3e-4", "height: .inf",
                            "surface.heights.height", "'.inf' must be a finite number"},
                    Refusal{"PeriodicNotABoolean", "periodic: false", "periodic: 0",
                            "surface.heights.periodic", "'0' must be one of true, false"}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace haptex::material::test_surface_file
