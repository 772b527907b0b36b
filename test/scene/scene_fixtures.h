// What the tests of scene files share.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <ostream>
#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "haptex/scene/scene.h"

namespace haptex::scene {

inline const std::filesystem::path kConfig = HAPTEX_CONFIG_DIRECTORY;

const std::string kObj = R"(v 0 0 0
v 0 0.1 0
v 0 0 -0.1
vt 0 0.1
vt 0.1 0.1
vt 0 0
f 1/1 2/2 3/3
)";

// scenes/, fabrics/ and meshes/ as under config/, with one file each.
class SceneFile : public testing::Test {
 protected:
  SceneFile()
      : root_(std::filesystem::path(testing::TempDir()) /
              ("haptex_scene_" + std::to_string(getpid()))) {
    for (const char* kind : {"scenes", "fabrics", "meshes"}) {
      std::filesystem::create_directories(root_ / kind);
    }
    std::filesystem::copy_file(kConfig / "fabrics/linear.yaml", root_ / "fabrics/silk.yaml");
    std::ofstream(root_ / "meshes/corner.obj") << kObj;
  }
  ~SceneFile() override { std::filesystem::remove_all(root_); }

  std::string path() const { return (root_ / "scenes/scene.yaml").string(); }

  Scene load(const std::string& text) const {
    std::ofstream(path()) << text;
    return loadScene(path());
  }

  std::string refusalOf(const std::string& text) const {
    return test::refusalOf([&] { load(text); });
  }

  std::filesystem::path root_;
};

const std::string kValid = R"(fabric: silk
sheet: {size: [0.3, 0.2], cells: [3, 2], diagonals: alternating}
attach: [top]
model: [gravity, viscosity]
time_step: 0.0125
)";

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "the test replaces what is not there: " << from;
  return text.replace(at, from.size(), to);
}

// What makes a valid scene invalid, and what is said then.
struct Refusal {
  std::string name;
  std::string from, to;   // the change
  std::string complaint;  // after the path
};

inline void PrintTo(const Refusal& refusal, std::ostream* stream) { *stream << refusal.name; }

class RefusedScene : public SceneFile, public testing::WithParamInterface<Refusal> {
 protected:
  void expectRefusal(const std::string& valid) const {
    EXPECT_EQ(refusalOf(replaced(valid, GetParam().from, GetParam().to)),
              path() + ": " + GetParam().complaint);
  }
};

static inline std::string meshScene(const std::string& mesh) {
  return replaced(kValid, "sheet: {size: [0.3, 0.2], cells: [3, 2], diagonals: alternating}",
                  "mesh: " + mesh);
}

}  // namespace haptex::scene
