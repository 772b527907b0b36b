#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "../refusal.h"
#include "haptex/base/command_line.h"

namespace haptex::base::test_command_line {
namespace {

std::string refusalOf(const std::vector<std::string>& arguments,
                      const std::vector<std::string>& options) {
  return test::refusalOf([&] { readCommandLine(arguments, options); });
}

TEST(CommandLine, TellsFilesFromOptions) {
  const CommandLine line =
      readCommandLine({"a", "--edge", "--1", "b", "--edge", "2", "-"}, {"--edge", "--body"});
  EXPECT_EQ(line.files, (std::vector<std::string>{"a", "b", "-"}));
  EXPECT_EQ(line.value("--edge"), "2");
  EXPECT_EQ(line.value("--body", "none"), "none");
}

TEST(CommandLine, NamesWhatIsNotAllowedAndWhatIs) {
  EXPECT_EQ(refusalOf({"--size", "3"}, {"--edge"}), "--size is unknown; allowed is --edge");
  EXPECT_EQ(refusalOf({"--size"}, {"--a", "--b", "--c"}),
            "--size is unknown; allowed are --a, --b and --c");
  EXPECT_EQ(refusalOf({"a", "--edge"}, {"--edge"}), "--edge needs a value");
}

TEST(RunProgram, TellsArgumentsThatAreRefusedFromWorkThatFails) {
  const auto fails = [] { throw std::runtime_error("because"); };
  std::ostringstream err;
  EXPECT_EQ(runProgram("usage\n", err, fails, [] { return 0; }), 2);
  EXPECT_EQ(err.str(), "because\nusage\n");
  err.str("");
  EXPECT_EQ(runProgram(
                "usage\n", err, [] {},
                [&]() -> int {
                  fails();
                  return 0;
                }),
            1);
  EXPECT_EQ(err.str(), "because\n");
  EXPECT_EQ(runProgram(
                "usage\n", err, [] {}, [] { return 3; }),
            3);
}

TEST(RunPlainProgram, CountsItsArguments) {
  const auto run = [](const std::vector<std::string>& arguments) {
    return runPlainProgram("it", "usage\n", arguments, 1, 2, [](const auto& given) {
      if (given[0] == "bad") throw std::runtime_error("because");
    });
  };
  EXPECT_EQ(run({"--help"}), 0);
  EXPECT_EQ(run({}), 2);
  EXPECT_EQ(run({"a", "b", "c"}), 2);
  EXPECT_EQ(run({"bad"}), 1);
  EXPECT_EQ(run({"a", "b"}), 0);
}

}  // namespace
}  // namespace haptex::base::test_command_line
