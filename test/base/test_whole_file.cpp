#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>

#include "haptex/base/whole_file.h"
#include "haptex/base/yaml_reader.h"

namespace haptex::base::test_whole_file {
namespace {

namespace fs = std::filesystem;

class WholeFile : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(directory_); }
  void TearDown() override { fs::remove_all(directory_); }

  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(directory_), fs::directory_iterator()));
  }

  const std::string directory_ = testing::TempDir() + "whole_file_" + std::to_string(getpid());
};

TEST_F(WholeFile, ReplacesAFileAndLeavesNothingBeside) {
  const std::string path = directory_ + "/file";
  writeWholeFile(path, "old");
  writeWholeFile(path, std::string("n\0w", 3));
  EXPECT_EQ(readTextFile(path), std::string("n\0w", 3));
  EXPECT_EQ(files(), 1u);
}

TEST_F(WholeFile, SaysWhatCannotBeWrittenAndLeavesNothing) {
  const std::string path = directory_ + "/none/file";
  try {
    writeWholeFile(path, "text");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), path + ": cannot be written: No such file or directory");
  }
  fs::create_directories(directory_ + "/taken/by");
  EXPECT_THROW(writeWholeFile(directory_ + "/taken", "text"), std::runtime_error);
  EXPECT_EQ(files(), 1u);
}

}  // namespace
}  // namespace haptex::base::test_whole_file
