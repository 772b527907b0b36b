// The programs of examples/ run as a reader starts them.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <string>

namespace haptex::oracles::test_examples {
namespace {

struct Outcome {
  int status;
  std::string output;
};

Outcome run(const std::string& command) {
  Outcome outcome{-1, ""};
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return outcome;
  for (int c = fgetc(pipe); c != EOF; c = fgetc(pipe)) outcome.output += static_cast<char>(c);
  const int status = pclose(pipe);
  if (WIFEXITED(status)) outcome.status = WEXITSTATUS(status);
  return outcome;
}

/// The number after the last occurrence of some words.
double numberAfter(const std::string& output, const std::string& words) {
  const std::size_t at = output.rfind(words);
  return at == std::string::npos ? -1.0 : std::stod(output.substr(at + words.size()));
}

const std::string kWool = HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml";

TEST(Examples, ClothHangsAsFarAsItsSideIsLongAndALittleMore) {
  const Outcome outcome = run(HANG_CLOTH " " + kWool);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  const double length = numberAfter(outcome.output, "hangs ");
  EXPECT_GT(length, 200.0) << outcome.output;
  EXPECT_LT(length, 204.0) << outcome.output;  // wool stretches by less than 2 % of its own weight
}

TEST(Examples, APatchPushesBackTheMoreTheDeeperItIsPressed) {
  const Outcome outcome = run(PRESS_PATCH " " + kWool);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  const double half = numberAfter(outcome.output, "1.00 mm: ");
  const double whole = numberAfter(outcome.output, "2.00 mm: ");
  EXPECT_GT(half, 0.0) << outcome.output;
  EXPECT_GT(whole, 2.0 * half) << outcome.output;  // it stiffens, as a sheet does
  EXPECT_LT(whole, 5.0) << outcome.output;         // what a finger bears
}

TEST(Examples, RefuseAFabricThatIsNotThere) {
  EXPECT_EQ(run(HANG_CLOTH " nothing").status, 1);
  EXPECT_EQ(run(PRESS_PATCH " nothing").status, 1);
}

}  // namespace
}  // namespace haptex::oracles::test_examples
