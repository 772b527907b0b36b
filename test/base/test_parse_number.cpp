#include <gtest/gtest.h>

#include <cmath>

#include "haptex/base/parse_number.h"

namespace haptex::base::test_parse_number {
namespace {

TEST(ParseNumber, ReadsWhatIsANumberFromItsBeginToItsEnd) {
  EXPECT_EQ(parseNumber<double>("-1.5e-3"), -1.5e-3);
  EXPECT_EQ(parseNumber<int>("-7"), -7);
  EXPECT_TRUE(std::isnan(*parseNumber<double>("nan")));
  for (const char* text : {"", " 1", "1 ", "1,5", "+1", "one", "0x10", "1e999"}) {
    EXPECT_EQ(parseNumber<double>(text), std::nullopt) << text;
  }
  for (const char* text : {"1.0", "2147483648", "-"}) {
    EXPECT_EQ(parseNumber<int>(text), std::nullopt) << text;
  }
}

TEST(ParseNumber, WithoutOnePlus) {
  EXPECT_EQ(parseNumber<int>(withoutPlus("+3")), 3);
  EXPECT_EQ(parseNumber<int>(withoutPlus("++3")), std::nullopt);
  EXPECT_EQ(withoutPlus(""), "");
}

}  // namespace
}  // namespace haptex::base::test_parse_number
