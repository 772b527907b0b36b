#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "haptex/garment/placement/preposition_program.h"
#include "haptex/mesh/obj_file.h"

namespace haptex::garment::test_preposition_program {
namespace {

namespace fs = std::filesystem;

class PrepositionProgram : public testing::Test {
 protected:
  PrepositionProgram()
      : directory_(fs::temp_directory_path() / ("haptex_preposition_" + std::to_string(getpid()))) {
    fs::create_directories(directory_);
  }
  ~PrepositionProgram() override { fs::remove_all(directory_); }

  std::string path(const std::string& name) const { return (directory_ / name).string(); }
  int run(const std::vector<std::string>& arguments) {
    std::ostringstream out, err;
    const int status = prepositionProgram(arguments, out, err);
    out_ = out.str();
    err_ = err.str();
    return status;
  }

  const std::string dress_ = HAPTEX_CONFIG_DIRECTORY "/garments/fitted_dress.yaml";
  const std::string woman_ = HAPTEX_CONFIG_DIRECTORY "/bodies/woman.yaml";
  fs::path directory_;
  std::string out_, err_;
};

TEST_F(PrepositionProgram, WritesPanelsAsGroupsWithRestCoordinatesAndTheBody) {
  ASSERT_EQ(run({dress_, woman_, path("out.obj"), "--edge", "0.04", "--body", path("body.obj")}), 0)
      << err_;
  mesh::MeshGroups groups;
  const mesh::ClothMesh mesh = mesh::loadObj(path("out.obj"), groups);
  EXPECT_EQ(groups.size(), 6u);
  EXPECT_EQ(groups.count("skirt_back"), 1u);
  for (const auto& [a, b, c] : mesh.triangles) {  // laid as they were cut
    EXPECT_NEAR((mesh.initial_positions[a] - mesh.initial_positions[b]).norm(),
                (mesh.rest_coordinates[a] - mesh.rest_coordinates[b]).norm(), 3e-4);
  }
  EXPECT_EQ(mesh::loadObjSurface(path("body.obj")).triangles.size(), 26756u);
  EXPECT_NE(out_.find("panel\tskirt_front\t"), std::string::npos);
}

TEST_F(PrepositionProgram, SaysWhatIsWrong) {
  EXPECT_EQ(run({dress_, woman_}), 2);
  EXPECT_NE(err_.find("2 files: needed are three"), std::string::npos);
  EXPECT_EQ(run({dress_, woman_, path("out.obj"), "--edge", "nan"}), 2);
  EXPECT_NE(err_.find("--edge is 'nan': allowed are 0.001 to 1 m"), std::string::npos);
  EXPECT_EQ(run({dress_, woman_, path("out.obj"), "--speed", "1"}), 2);
  EXPECT_EQ(run({dress_, woman_, path("out.obj"), "--body"}), 2);
  EXPECT_EQ(run({woman_, woman_, path("out.obj")}), 1);
  EXPECT_EQ(run({dress_, dress_, path("out.obj")}), 1);
  EXPECT_EQ(run({dress_, woman_, path("none/out.obj"), "--edge", "0.05"}), 1);
  EXPECT_NE(err_.find("cannot be written"), std::string::npos);
}

}  // namespace
}  // namespace haptex::garment::test_preposition_program
