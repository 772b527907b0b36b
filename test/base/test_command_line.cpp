#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
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

TEST(CommandLine, ReadsNumbersThatARuleAllows) {
  const CommandLine line = readCommandLine({"--a", "3", "--b", "0.5", "--c", "-1", "--d", "nan"},
                                           {"--a", "--b", "--c", "--d"});
  const auto is_positive = [](auto number) { return number > 0; };
  const auto refused = [&](const std::string& option) {
    return test::refusalOf([&] { line.number(option, 1, is_positive, "are counts"); });
  };
  EXPECT_EQ(line.number("--a", 1, is_positive, ""), 3);
  EXPECT_EQ(line.number("--b", 1.0, is_positive, ""), 0.5);
  EXPECT_EQ(line.number("--e", 1, is_positive, ""), 1);
  EXPECT_EQ(refused("--b"), "--b is '0.5': allowed are counts");
  EXPECT_EQ(refused("--c"), "--c is '-1': allowed are counts");
  EXPECT_THROW(line.number("--d", 1.0, is_positive, ""), std::invalid_argument);
}

TEST(RequireOutput, RefusesWhereNoFileCanBeWrittenAndWhatIsRead) {
  namespace fs = std::filesystem;
  const fs::path directory = fs::temp_directory_path() / ("haptex_out_" + std::to_string(getpid()));
  fs::create_directory(directory);
  const std::string input = (directory / "in").string(), output = (directory / "out").string();
  std::ofstream(input) << "kept";
  const auto refusal = [&](const std::string& path) {
    return test::refusalOf([&] { requireOutput(path, {input}); });
  };
  EXPECT_NO_THROW(requireOutput(output, {input}));
  EXPECT_FALSE(fs::exists(output));
  EXPECT_EQ(refusal(output + "/deep"),
            output + "/deep: cannot be written: there is no directory " + output);
  EXPECT_EQ(refusal(directory.string()), directory.string() + ": is a directory, not a file");
  EXPECT_EQ(refusal(input), input + ": is read, too: allowed is another file");
  const std::string other = (directory / "." / "in").string();
  EXPECT_EQ(refusal(other), other + ": is read, too: allowed is another file");
  fs::create_symlink(input, output);
  EXPECT_EQ(refusal(output), output + ": is read, too: allowed is another file");
  fs::remove_all(directory);
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

TEST(RunProgram, ShowsItsUsageWhenItIsAskedTo) {
  std::ostringstream err;
  const auto asks = [] { readCommandLine({"file", "--help"}, {"--edge"}); };
  testing::internal::CaptureStdout();
  EXPECT_EQ(runProgram("usage\n", err, asks, [] { return 3; }), 0);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "usage\n");
  EXPECT_EQ(err.str(), "");
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
