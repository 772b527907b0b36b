// Large, deep and swelling YAML is refused before it takes memory.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "haptex/base/file_size.h"
#include "haptex/base/workload.h"
#include "haptex/base/yaml_reader.h"

namespace haptex::base::test_yaml_size {
namespace {

std::string repeated(const std::string& part, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += part;
  return text;
}

std::string refusal(const std::string& text) {
  return test::refusalOf<std::runtime_error>([&] { YamlValue::parse(text, "file"); });
}

/// Of this process until now, kB.
long largestMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

/// What a refusal takes at most, kB: yaml-cpp reads ahead within a line, and 256 KiB of brackets
/// are 55 MB of its tokens. The sanitizers hold memory back that was freed.
const long kMemory = unlessSanitized(64'000L, 1'000'000L);

void expectRefusedInLittleMemory(const std::string& text, const std::string& says) {
  const long before = largestMemory();
  EXPECT_EQ(refusal(text), says);
  EXPECT_LT(largestMemory() - before, kMemory);
}

TEST(YamlSize, AListOfTwoMillionItemsIsRefusedByItsBytes) {
  expectRefusedInLittleMemory("[" + repeated("1,", 2'000'000) + "]",
                              "file: has 4000002 bytes: allowed are up to 262144");
}

TEST(YamlSize, AListOfTooManyItemsIsRefusedWhileItIsRead) {
  const std::string begin = "[" + repeated("1,", kMostYamlValues - 1);
  EXPECT_EQ(refusal(begin + "]"), test::kNotRefused);
  expectRefusedInLittleMemory(begin + repeated("1,", 30'000) + "]",
                              "file: line 1: more than 100000 values, an alias counted as what "
                              "it stands for");
}

TEST(YamlSize, AliasesCountAsWhatTheyStandFor) {
  std::string laughs = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i <= 4; ++i) {
    const std::string alias = "*a" + std::to_string(i - 1);
    laughs += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" +
              repeated(alias + ", ", 9) + "]\n";
  }
  // 1 + 5 (keys) + 10 + 91 + 820 + 7381 + 66430.
  EXPECT_EQ(refusal(laughs), test::kNotRefused);
  expectRefusedInLittleMemory(laughs + "a5: [*a4, *a4]\n",
                              "file: line 6: more than 100000 values, an alias counted as what it "
                              "stands for");
}

TEST(YamlSize, AnAliasWithinWhatItStandsForIsRefused) {
  EXPECT_EQ(refusal("a: &a [1, *a]"), "file: line 1: an alias within what it stands for");
}

TEST(YamlSize, DeepNestingIsRefusedAtTheLevelThatIsTooMany) {
  EXPECT_EQ(refusal(repeated("[", kDeepestYaml) + repeated("]", kDeepestYaml)), test::kNotRefused);
  for (const std::size_t depth : {kDeepestYaml + 1, std::size_t{10'000}, std::size_t{250'000}}) {
    expectRefusedInLittleMemory(repeated("[", depth), "file: line 1: nested deeper than 32 levels");
    expectRefusedInLittleMemory(repeated("- ", depth / 2 + kDeepestYaml),
                                "file: line 1: nested deeper than 32 levels");
  }
}

TEST(FileSize, AFileOfAGigabyteIsRefusedUnread) {
  const std::string path = testing::TempDir() + "haptex_large_" + std::to_string(getpid());
  std::ofstream(path).close();
  ASSERT_EQ(truncate(path.c_str(), 1'000'000'000), 0);  // takes no room on the disk
  const long before = largestMemory();
  try {
    requireFileSize(path, 1000);
    ADD_FAILURE() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), path + ": has 1000000000 bytes: allowed are up to 1000");
  }
  try {
    YamlValue::load(path);
    ADD_FAILURE() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), path + ": has 1000000000 bytes: allowed are up to 262144");
  }
  EXPECT_LT(largestMemory() - before, kMemory);
  EXPECT_NO_THROW(requireFileSize(path, 1'000'000'000));
  EXPECT_NO_THROW(requireFileSize("/no/such/file", 0));
  std::remove(path.c_str());
}

}  // namespace
}  // namespace haptex::base::test_yaml_size
