#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "haptex/tactile/height_file.h"
#include "haptex/tactile/relief_picture.h"
#include "haptex/tactile/weave_relief.h"
#include "temporary_file.h"

namespace haptex::tactile::test_relief_picture {
namespace {

using material::Knit;
using material::Weave;
using material::WeaveKind;

const Weave kTwill{WeaveKind::kTwill31, {4e-4, 8e-5}, {4e-4, 8e-5}, 0.1};

material::Surface surfaceOf(const std::variant<Weave, Knit, material::HeightFile>& relief) {
  return {4e-6, 0.01, relief};
}

TEST(ReliefPicture, HoldsTheHeightsToHalfAStepOfItsSamples) {
  const HeightField field = weaveRelief(kTwill);
  const TemporaryFile file(".png");
  const double height = writeHeights(field, file.path());
  const double lowest = *std::min_element(field.heights.begin(), field.heights.end());
  const HeightField read = loadHeights({file.path(), field.weft_spacing, height, true});
  ASSERT_EQ(read.columns, field.columns);
  ASSERT_EQ(read.rows, field.rows);
  for (std::size_t i = 0; i < field.heights.size(); ++i) {
    ASSERT_NEAR(read.heights[i] + lowest, field.heights[i], 0.51 * height / 65535) << i;
  }
}

TEST(ReliefPicture, OfAFlatFieldIsFlat) {
  const TemporaryFile file(".png");
  EXPECT_EQ(writeHeights(makeField(4, 3, 1e-4, 1e-4, [](int, int) { return 2e-5; }), file.path()),
            0.0);
  for (const double height : loadHeights({file.path(), 1e-4, 1e-3, true}).heights) {
    EXPECT_EQ(height, 0.0);
  }
}

TEST(ReliefPicture, ShowsTheYarnOnTopAtEveryCrossing) {
  // Yarns are 4 samples wide. A 3/1 twill goes under where i - j is 3 modulo 4.
  const FaceRelief relief = faceRelief(surfaceOf(kTwill));
  const int columns = relief.heights.columns;
  for (int weft = 0; weft < relief.heights.rows / 4; ++weft) {
    for (int warp = 0; warp < columns / 4; ++warp) {
      EXPECT_EQ(relief.warp_on_top[columns * 4 * weft + 4 * warp], (warp - weft + 400) % 4 != 3)
          << warp << ", " << weft;
    }
  }
}

TEST(ReliefPicture, ShowsAsMuchWarpAsTheWeaveHas) {
  const auto share = [](WeaveKind kind) {
    const std::vector<bool> on_top = warpsOnTop({kind, {4e-4, 5e-5}, {4e-4, 5e-5}, 0.0});
    return static_cast<double>(std::count(on_top.begin(), on_top.end(), true)) / on_top.size();
  };
  // Half of a plain weave, but for the lines where both are as high; floats of a satin cover more
  // than the four fifths of its crossings at which the warp is on top.
  EXPECT_NEAR(share(WeaveKind::kPlain), 0.5, 0.07);
  EXPECT_GT(share(WeaveKind::kTwill31), 0.7);
  EXPECT_GT(share(WeaveKind::kSatin5), 0.8);
  EXPECT_LT(share(WeaveKind::kSatin5), 1.0);
}

TEST(ReliefPicture, OfYarnsThatDoNotStandOutShowsThemWhereTheyCross) {
  const std::vector<bool> on_top = warpsOnTop({WeaveKind::kPlain, {4e-4, 0.0}, {4e-4, 5e-5}, 0.0});
  EXPECT_TRUE(on_top[0]);
  EXPECT_FALSE(on_top[4]);  // the next crossing along the weft, where the warp goes under
}

TEST(ReliefPicture, OfAKnitIsOfOneYarn) {
  const FaceRelief relief = faceRelief(surfaceOf(Knit{3.2e-3, 2.4e-3, 0.0}));
  const std::vector<double>& heights = relief.heights.heights;
  EXPECT_NEAR(*std::max_element(heights.begin(), heights.end()), 8e-4, 2e-5);
  EXPECT_EQ(std::count(relief.warp_on_top.begin(), relief.warp_on_top.end(), true),
            static_cast<std::ptrdiff_t>(relief.heights.heights.size()));
}

TEST(ReliefPicture, IsRefusedWhereItCannotBeWritten) {
  const FaceRelief relief = faceRelief(surfaceOf(kTwill));
  const std::string nowhere =
      (std::filesystem::temp_directory_path() / "no such folder" / "x.png").string();
  for (const auto& write :
       {+[](const FaceRelief&r, const std::string&p) { writeHeights(r.heights, p); },
        +[](const FaceRelief&r, const std::string&p) { writeYarns(r, p); }}) {
    try {
      write(relief, nowhere);
      ADD_FAILURE() << "written";
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(nowhere + ": cannot be written"), std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace haptex::tactile::test_relief_picture
