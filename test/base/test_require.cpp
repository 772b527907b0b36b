#include <gtest/gtest.h>

#include <stdexcept>

#include "haptex/base/repeatable_random.h"
#include "haptex/base/require.h"

namespace haptex::base::test_require {
namespace {

TEST(Require, NamesFunctionParameterValueAndRange) {
  EXPECT_NO_THROW(require(true, "area", "width", -1.0, "> 0 m"));
  try {
    require(false, "area", "width", -0.25, "> 0 m");
    FAIL() << "not refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "area: width is -0.25; it must be > 0 m");
  }
}

TEST(Require, WritesNumbersInTheirShortestForm) {
  EXPECT_EQ(shortNumber(1000.0), "1000");
  EXPECT_EQ(shortNumber(0.1), "0.1");
  EXPECT_EQ(shortNumber(1.0 / 3.0), "0.3333333333");
}

TEST(RepeatableRandom, IsTheStandardsEngineMappedByItself) {
  // mt19937_64 from 5489 gives 14514284786278117030 first, as the standard's engine of that seed.
  EXPECT_DOUBLE_EQ(RepeatableRandom(5489).uniform(0.0, 1.0), 14514284786278117030.0 * 0x1p-64);
  EXPECT_EQ(RepeatableRandom(5489).below(1000), 30);
}

TEST(RepeatableRandom, StaysInItsRanges) {
  RepeatableRandom random(1);
  for (int i = 0; i < 10000; ++i) {
    const double uniform = random.uniform(-2.0, 3.0), logarithmic = random.logarithmic(1e-3, 1e3);
    EXPECT_TRUE(uniform >= -2.0 && uniform < 3.0) << uniform;
    EXPECT_TRUE(logarithmic > 0.999e-3 && logarithmic < 1.001e3) << logarithmic;
    EXPECT_NEAR(random.direction().norm(), 1.0, 1e-14);
  }
}

}  // namespace
}  // namespace haptex::base::test_require
