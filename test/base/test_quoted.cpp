#include <gtest/gtest.h>

#include <string>

#include "haptex/base/quoted.h"

namespace haptex::base::test_quoted {
namespace {

TEST(Quoted, TextUpToTheLimitStandsWhole) {
  EXPECT_EQ(quoted("wool"), "'wool'");
  EXPECT_EQ(shortened("wool"), "wool");
  const std::string longest(kLongestQuote, 'a');
  EXPECT_EQ(quoted(longest), "'" + longest + "'");
  EXPECT_EQ(shortened(longest), longest);
}

TEST(Quoted, OfALongerTextTheBeginStandsAndHowLongItIs) {
  const std::string text(100'000'000, 'a');
  const std::string begin(kLongestQuote, 'a');
  EXPECT_EQ(quoted(text), "'" + begin + "'... (100000000 characters)");
  EXPECT_EQ(shortened(text), begin + "... (100000000 characters)");
}

TEST(Quoted, ControlCharactersAreWrittenOut) {
  EXPECT_EQ(quoted(std::string("a\nb\tc\x1b[31m\0d\x7f", 13)), "'a\\nb\\tc\\x1b[31m\\x00d\\x7f'");
  const std::string lines(150, '\n');
  EXPECT_EQ(quoted(lines).size(), kLongestQuote + std::string("''... (150 characters)").size());
}

TEST(Quoted, Utf8IsNotCutWithinACharacter) {
  std::string text(kLongestQuote - 1, 'a');
  EXPECT_EQ(shortened(text + "\xc3\xa4"), text + "... (201 characters)");
  text.pop_back();
  EXPECT_EQ(shortened(text + "\xc3\xa4"), text + "\xc3\xa4");
}

TEST(Quoted, BytesThatAreNoUtf8AreBoundedToo) {
  EXPECT_LE(shortened(std::string(1000, '\x80')).size(), kLongestQuote + 30);
}

}  // namespace
}  // namespace haptex::base::test_quoted
