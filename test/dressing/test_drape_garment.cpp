// The program drape_garment.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include "dressing_fixtures.h"
#include "haptex/dressing/drape_garment.h"
#include "haptex/mesh/obj_file.h"

namespace haptex::dressing::test_drape_garment {
namespace {

class DrapeGarment : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(directory_);
    std::ofstream(garment_) << garment::writePattern(tube(0.15));
    std::ofstream body(body_);
    const mesh::ObstacleMesh shape = cone(0.2, 0.04, 0.4, 20);
    for (const Eigen::Vector3d& v : shape.vertices) body << "v " << v.transpose() << '\n';
    for (const auto& [a, b, c] : shape.triangles) {
      body << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
    }
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  int run(const std::vector<std::string>& arguments) {
    std::ostringstream out, err;
    const int status = drapeGarment(arguments, HAPTEX_CONFIG_DIRECTORY "/fabrics", out, err);
    out_ = out.str();
    err_ = err.str();
    return status;
  }

  const std::string directory_ = testing::TempDir() + "drape_garment_" + std::to_string(getpid());
  const std::string garment_ = directory_ + "/tube.yaml";
  const std::string body_ = directory_ + "/body.obj";
  const std::string obj_ = directory_ + "/tube.obj";
  std::string out_, err_;
};

TEST_F(DrapeGarment, WritesPanelsAsGroupsAndSaysWhatItTook) {
  ASSERT_EQ(run({garment_, obj_, "--body", body_, "--edge", "0.06"}), 0) << err_;
  std::ifstream file(obj_);
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  EXPECT_NE(text.find("g front\n"), std::string::npos);
  EXPECT_NE(text.find("g back\n"), std::string::npos);
  EXPECT_NO_THROW(mesh::loadObjSurface(obj_));
  for (const char* name :
       {"to_rest\t", "s_per_s\t", "steps\t", "gap_before_sewing\t", "intersections_with_itself\t0",
        "intersections_with_body\t0", "at_rest\tyes"}) {
    EXPECT_NE(out_.find(name), std::string::npos) << name;
  }
}

TEST_F(DrapeGarment, LaysPanelsOnTheirCarriersAroundABodyWithSegments) {
  garment::Pattern pattern = tube(0.15);
  pattern.carriers = {{"torso", garment::Carrier::Shape::kCylinder, "spine"}};
  pattern.panels[0].placement = garment::OnCarrier{"torso", 0.0, 0.625};
  pattern.panels[1].placement = garment::OnCarrier{"torso", M_PI, 0.625};
  // Both look outwards, and what is left of the one is right of the other.
  std::swap(pattern.seams[0].sides[1], pattern.seams[1].sides[1]);
  for (garment::Seam& seam : pattern.seams) seam.sides[1].reversed = true;
  std::ofstream(garment_) << garment::writePattern(pattern);
  EXPECT_EQ(run({garment_, obj_, "--body", body_, "--edge", "0.06"}), 1);
  EXPECT_NE(err_.find("panel 'front' is to be laid on the carrier 'torso'"), std::string::npos)
      << err_;
  const std::string file = directory_ + "/body.yaml";
  std::ofstream(file) << "surface: body.obj\n"
                         "segments:\n"
                         "  - {name: spine, start: [0, 0, 0], end: [0, 0, 0.4], radius: 0.1}\n";
  EXPECT_EQ(run({garment_, obj_, "--body", file, "--edge", "0.06"}), 0) << err_;
  EXPECT_NE(out_.find("intersecting_states\t0"), std::string::npos) << out_;
}

TEST_F(DrapeGarment, SaysWhatIsWrongWithItsArguments) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> refused = {
      {{}, "two files are needed"},
      {{garment_, obj_}, "a body is needed"},
      {{garment_, obj_, "--body"}, "--body needs a value"},
      {{garment_, obj_, "third", "--body", body_}, "third: two files are allowed"},
      {{garment_, obj_, "--body", body_, "--edge", "fine"},
       "--edge is 'fine': allowed are 0.001 to 1 m"},
      {{garment_, obj_, "--body", body_, "--edge", "nan"}, "--edge is 'nan'"},
      {{garment_, obj_, "--body", body_, "--edge", "0"}, "--edge is '0'"},
      {{garment_, obj_, "--size", "3"}, "--size is unknown"}};
  for (const auto& [arguments, message] : refused) {
    EXPECT_EQ(run(arguments), 2);
    EXPECT_NE(err_.find(message), std::string::npos) << err_;
    EXPECT_NE(err_.find("usage: drape_garment"), std::string::npos);
  }
}

TEST_F(DrapeGarment, RefusesFilesThatAreNotThereAndWritesNothing) {
  EXPECT_EQ(run({garment_, obj_, "--body", directory_ + "/none.obj"}), 1);
  EXPECT_NE(err_.find("none.obj"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(obj_));
}

TEST_F(DrapeGarment, RefusesBeforeItWorksWhereItCannotWrite) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> refused = {
      {{garment_, garment_, "--body", body_}, garment_ + ": is read, too"},
      {{garment_, obj_, "--body", body_, "--scene", obj_}, obj_ + ": is read, too"},
      {{garment_, obj_ + "/x", "--body", body_}, "there is no directory"}};
  for (const auto& [arguments, message] : refused) {
    EXPECT_EQ(run(arguments), 1);
    EXPECT_NE(err_.find(message), std::string::npos) << err_;
  }
  EXPECT_FALSE(std::filesystem::exists(obj_));
}

}  // namespace
}  // namespace haptex::dressing::test_drape_garment
