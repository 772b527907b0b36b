#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "haptex/scene/scene_fabric.h"

namespace haptex::scene::test_scene_fabric {
namespace {

const std::string kConfig = HAPTEX_CONFIG_DIRECTORY;

class SceneFabric : public testing::Test {
 protected:
  SceneFabric() : path_(testing::TempDir() + "haptex_scene_fabric_" + std::to_string(getpid())) {}
  ~SceneFabric() override {
    std::remove(scenePath().c_str());
    std::remove(fabricPath().c_str());
  }

  std::string scenePath() const { return path_ + ".yaml"; }
  std::string fabricPath() const { return path_ + "_fabric.yaml"; }

  /// What refuses a scene of a fabric.
  std::string refusal(const std::string& fabric_path, const std::string& model,
                      const std::string& more = "") const {
    std::ofstream(scenePath()) << "fabric: " << fabric_path << "\nmodel: [" << model << "]\n"
                               << "sheet: {size: [1, 1], cells: [2, 2], diagonals: one_way}\n"
                               << "attach: []\ntime_step: 0.01\n"
                               << more;
    return test::refusalOf([&] { loadSceneFabrics(scenePath(), loadScene(scenePath())); });
  }

  /// A shipped fabric without one of its keys.
  std::string without(const std::string& key) const {
    std::ifstream shipped(kConfig + "/fabrics/linear.yaml");
    std::ofstream fabric(fabricPath());
    bool left_out = false;
    for (std::string line; std::getline(shipped, line);) {
      if (!line.empty() && line[0] != ' ' && line[0] != '#')
        left_out = line.rfind(key + ":", 0) == 0;
      if (!left_out) fabric << line << '\n';
    }
    return fabricPath();
  }

 private:
  std::string path_;
};

TEST_F(SceneFabric, IsRefusedForTactileWithoutASurface) {
  EXPECT_EQ(refusal(kConfig + "/fabrics/linear.yaml", "fingers, tactile"),
            scenePath() + ": model: lists tactile, but fabric 'linear' has no surface: " + kConfig +
                "/fabrics/linear.yaml needs the key surface");
  EXPECT_EQ(refusal(kConfig + "/fabrics/linear.yaml", "fingers"), test::kNotRefused);
  EXPECT_EQ(refusal(kConfig + "/fabrics/wool.yaml", "fingers, tactile"), test::kNotRefused);
}

TEST_F(SceneFabric, IsRefusedForFingersThatCannotTouchIt) {
  for (const std::string key : {"friction", "compression"}) {
    EXPECT_EQ(refusal(without(key), "fingers"),
              scenePath() +
                  ": model: lists fingers, but fabric linear: contact needs the property "
                  "'" +
                  key + "'");
    EXPECT_EQ(refusal(without(key), ""), test::kNotRefused) << "nobody touches it";
  }
  EXPECT_EQ(refusal(without("bending"), "fingers"),
            scenePath() +
                ": model: lists fingers, but fabric 'linear' has no bending; a patch "
                "needs it: add the key bending");
  EXPECT_EQ(refusal(without("bending"), "fingers", "haptics: {layer: whole_cloth}\n"),
            test::kNotRefused);
}

TEST_F(SceneFabric, IsRefusedWithAWrongKeyHaptics) {
  EXPECT_EQ(refusal(kConfig + "/fabrics/wool.yaml", "fingers", "haptics: {depth: 3}\n"),
            scenePath() +
                ": haptics.depth: unknown key, allowed here: layer, refinement, margin, "
                "most_elements, surround, predict");
}

TEST(ShippedScenes, HaveFabricsWithWhatTheyList) {
  for (const char* name : {"acrylic_knit_sample", "cotton_knit_sample", "dropped_sheet",
                           "gathered_wool", "linear_sheet", "orbiting_sphere", "hemmed_wool",
                           "wool_among_obstacles", "wool_in_wind", "wool_sample"}) {
    const std::string path = kConfig + "/scenes/" + name + ".yaml";
    EXPECT_NO_THROW(loadSceneFabrics(path, loadScene(path))) << name;
  }
}

}  // namespace
}  // namespace haptex::scene::test_scene_fabric
