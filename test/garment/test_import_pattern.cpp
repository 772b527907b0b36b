#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "dxf_text.h"
#include "garment_fixtures.h"
#include "haptex/garment/importers/import_pattern.h"

namespace haptex::garment::test_import_pattern {
namespace {

namespace fs = std::filesystem;

class ImportPattern : public testing::Test {
 protected:
  ImportPattern()
      : directory_(fs::temp_directory_path() / ("haptex_import_" + std::to_string(getpid()))) {
    fs::create_directories(directory_);
  }
  ~ImportPattern() override { fs::remove_all(directory_); }

  std::string path(const std::string& name) const { return (directory_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
    return path(name);
  }

  int run(const std::vector<std::string>& arguments) {
    std::ostringstream out, err;
    const int status = importPattern(arguments, out, err);
    out_ = out.str();
    err_ = err.str();
    return status;
  }

  fs::path directory_;
  std::string out_, err_;
};

TEST_F(ImportPattern, WritesAGarmentFileOfJsonAndSaysWhatIsInIt) {
  const std::string file = write("two.json", kTwoSquares);
  ASSERT_EQ(run({file, path("two.yaml"), "--fabric", "denim"}), 0) << err_;
  const Pattern pattern = loadPattern(path("two.yaml"));
  EXPECT_EQ(pattern.source, "imported from two.json");
  EXPECT_EQ(pattern.panels[1].fabric, "denim");
  EXPECT_EQ(pattern.seams.size(), 1u);
  EXPECT_NE(out_.find("panel\tfront\t0\t0.04\nedge\t0\t0.2\t0\t0\t0.2\t0\n"), std::string::npos);
  EXPECT_NE(out_.find("seam\tfront:1\tback:3\t0.2\t0.2\t0.01\n"), std::string::npos);
}

TEST_F(ImportPattern, TakesTheSeamsOfADxfFileFromItsSidecar) {
  const std::string file = write("skirt.DXF", smallDxf());
  ASSERT_EQ(run({file, path("skirt.yaml")}), 0) << err_;
  EXPECT_EQ(loadPattern(path("skirt.yaml")).seams.size(), 0u);
  EXPECT_NE(out_.find("piece 'BACK-M': is cut 2 times"), std::string::npos);
  write(
      "skirt.seams.yaml",
      "seams: [{sides: [{panel: front, edges: [0]}, {panel: back, edges: [3], reversed: true}]}]");
  ASSERT_EQ(run({file, path("skirt.yaml")}), 0) << err_;
  EXPECT_EQ(loadPattern(path("skirt.yaml")).seams.size(), 1u);
}

TEST_F(ImportPattern, SaysWhatItRefusesAndWritesNothing) {
  const std::string file = write("two.json", "{}");
  EXPECT_EQ(run({file, path("two.yaml")}), 1);
  EXPECT_EQ(err_, file + ": 'pattern' is missing\n");
  EXPECT_FALSE(fs::exists(path("two.yaml")));
  EXPECT_EQ(run({path("two.svg"), path("two.yaml")}), 1);
  EXPECT_EQ(err_, path("two.svg") + ": has the extension '.svg': allowed are .json and .dxf\n");
  EXPECT_EQ(run({path("none.dxf"), path("two.yaml")}), 1);
  EXPECT_EQ(err_, path("none.dxf") + ": there is no such file\n");
  write("two.json", kTwoSquares);
  EXPECT_EQ(run({file, path("none/two.yaml")}), 1);
  EXPECT_EQ(err_, path("none/two.yaml") + ": cannot be written: there is no directory " +
                      path("none") + '\n');
}

TEST_F(ImportPattern, RefusesArgumentsThatItDoesNotKnow) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{},
                                                    {"a.json"},
                                                    {"a.json", "b.yaml", "c.yaml"},
                                                    {"a.json", "b.yaml", "--fabric"},
                                                    {"a.json", "b.yaml", "--size", "M"}}) {
    EXPECT_EQ(run(arguments), 2);
    EXPECT_NE(err_.find("usage: import_pattern"), std::string::npos);
  }
  // Nothing takes the place of what it is made of.
  EXPECT_EQ(run({"a.dxf", "a.dxf"}), 2);
  EXPECT_EQ(run({"a.dxf", "./a.seams.yaml"}), 2);
}

}  // namespace
}  // namespace haptex::garment::test_import_pattern
