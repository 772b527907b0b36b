#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "fixtures.h"

namespace haptex::tactile::test_height_field {
namespace {

std::string refusalOf(const HeightField& field) {
  return test::refusalOf([&] { requireSound(field); });
}

TEST(HeightField, IsRowByRow) {
  const HeightField field{2, 3, 1e-4, 1e-4, {0.0, 1.0, 2.0, 3.0, 4.0, 5.0}};
  EXPECT_EQ(field.at(1, 0), 1.0);
  EXPECT_EQ(field.at(0, 2), 4.0);
}

TEST(HeightField, OfTheSmallestAndOfTheLargestSideIsSound) {
  EXPECT_EQ(refusalOf(flatField(2, 2)), test::kNotRefused);
  EXPECT_EQ(refusalOf(flatField(kMaxSamples, 2)), test::kNotRefused);
}

TEST(HeightField, RefusalsNameFieldValueAndWhatIsAllowed) {
  EXPECT_EQ(refusalOf(flatField(1, 8)), "the height field has 1 columns: allowed are 2 to 4096");
  EXPECT_EQ(refusalOf(flatField(8, 4097)), "the height field has 4097 rows: allowed are 2 to 4096");
  EXPECT_EQ(refusalOf(flatField(8, 8, 0.0)),
            "the weft_spacing of the height field is 0 m: it must be finite and > 0");
  EXPECT_EQ(refusalOf(flatField(8, 8, 1e-4, std::numeric_limits<double>::infinity())),
            "the warp_spacing of the height field is inf m: it must be finite and > 0");
  HeightField field = flatField(4, 3);
  field.heights.pop_back();
  EXPECT_EQ(refusalOf(field), "the height field has 11 heights: 4 columns and 3 rows need 12");
  field = flatField(4, 3);
  field.heights[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusalOf(field), "heights[7] of the height field is nan: it must be finite");
}

}  // namespace
}  // namespace haptex::tactile::test_height_field
