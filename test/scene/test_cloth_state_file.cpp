// States that are saved, and scenes that start from them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "../refusal.h"
#include "haptex/contact/obstacles/obstacles.h"
#include "haptex/scene/cloth_state_file.h"
#include "scene_fixtures.h"

namespace haptex::scene::test_cloth_state_file {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using Vectors = std::vector<Vector3d>;

const std::string kFromState = kValid + "state: ./cloth.state\n";

bool sameBits(const Vectors& a, const Vectors& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Vector3d)) == 0;
}

class StateFile : public SceneFile {
 protected:
  StateFile() {
    state_.positions = load(kValid).mesh.initial_positions;  // 4 x 3, of which the last 4 are held
    state_.velocities.assign(state_.positions.size(), Vector3d::Zero());
    state_.time = 0.1 + 0.2;
    const double tiny = std::numeric_limits<double>::denorm_min();
    state_.positions[0] = {1.0 / 3.0, -0.0, tiny};
    state_.positions[5] = {0.1, 1e9, std::nextafter(1.0, 2.0)};
    state_.velocities[1] = {-1e-300, 12345678.901234567, 2.0 / 3.0};
    state_.positions[11] += Vector3d(0.0, 0.0, 0.9e-9);
  }

  std::string statePath() const { return (root_ / "scenes/cloth.state").string(); }
  std::string savedText() const {
    saveState(statePath(), state_);
    std::ostringstream text;
    text << std::ifstream(statePath()).rdbuf();
    return text.str();
  }
  std::string refusalOfState(const std::string& text) const {
    std::ofstream(statePath()) << text;
    return refusalOf(kFromState);
  }

  cloth::ClothState state_;
};

TEST_F(StateFile, IsReadBackToTheLastBit) {
  saveState(statePath(), state_);
  const cloth::ClothState read = loadState(statePath());
  EXPECT_TRUE(sameBits(read.positions, state_.positions));
  EXPECT_TRUE(sameBits(read.velocities, state_.velocities));
  EXPECT_EQ(read.time, state_.time);
  const std::string text = savedText();
  saveState(statePath(), read);  // in the place of the first
  EXPECT_EQ(savedText(), text);
  for (const auto& entry : fs::directory_iterator(root_ / "scenes")) {
    EXPECT_NE(entry.path().extension(), ".part");
  }
}

TEST_F(StateFile, IsWhatASceneStartsFrom) {
  saveState(statePath(), state_);
  const Scene scene = load(kFromState);
  EXPECT_TRUE(sameBits(scene.mesh.initial_positions, state_.positions));
  EXPECT_TRUE(sameBits(scene.start_velocities, state_.velocities));
  EXPECT_EQ(scene.start_time, state_.time);
  EXPECT_FALSE(scene.any_cells);
  const Scene without = load(kValid);
  EXPECT_TRUE(without.start_velocities.empty());
  EXPECT_EQ(without.start_time, 0.0);
  EXPECT_TRUE(without.any_cells);
  EXPECT_EQ(scene.attached_particles, without.attached_particles);
  EXPECT_EQ(scene.mesh.rest_coordinates, without.mesh.rest_coordinates);
  load(kFromState);
  EXPECT_EQ(loadScene(path(), 0.01).mesh.triangles, scene.mesh.triangles);
  fs::create_directories(root_ / "states");
  fs::rename(statePath(), root_ / "states/draped.state");
  EXPECT_EQ(load(kValid + "state: draped\n").start_time, state_.time);
}

/// A sheet that starts in an obstacle is moved outside of where that is at the time of the state.
TEST_F(StateFile, IsMovedOutOfObstaclesWhereTheyAreThen) {
  state_.positions = load(kValid).mesh.initial_positions;
  state_.time = 2.0;
  saveState(statePath(), state_);
  const std::string text =
      replaced(replaced(kFromState, "viscosity]", "self_collision, obstacles]"), "[top]", "[]") +
      "obstacles: [{name: ball, sphere: 0.02, position: [-0.19, 0.0, -0.1], "
      "velocity: [0.1, 0, 0], friction: 0.1}]\n";
  const Scene scene = load(text);
  EXPECT_GT(scene.start_move.particles, 0);
  EXPECT_EQ(contact::firstTouching(scene.mesh.triangles, scene.mesh.initial_positions,
                                   contact::makeObstacle(scene.obstacles[0], 2.0)),
            -1);
  EXPECT_EQ(load(replaced(text, "state: ./cloth.state\n", "")).start_move.particles, 0);
}

TEST_F(StateFile, OfAnotherClothIsRefused) {
  saveState(statePath(), state_);
  EXPECT_EQ(refusalOf(replaced(kFromState, "[3, 2]", "[3, 3]")),
            path() + ": state: " + statePath() +
                " has 12 particles: allowed are 16, those of the scene's cloth");
  state_.positions[9] += Vector3d(0.0, 0.002, 0.0);
  saveState(statePath(), state_);
  EXPECT_EQ(refusalOf(kFromState), path() + ": state: " + statePath() +
                                       " has particle 9 0.002 m from where it is attached, (0, "
                                       "-0.05, 0) m: allowed are 1e-09 m");
  EXPECT_EQ(refusalOf(replaced(kFromState, "[top]", "[]")), test::kNotRefused);
}

TEST_F(StateFile, IsRefusedBesideObstaclesWithMass) {
  saveState(statePath(), state_);
  EXPECT_EQ(refusalOf(replaced(kFromState, "viscosity]", "viscosity, obstacles]") +
                      "obstacles: [{name: ball, sphere: 0.05, position: [1, 0, 0], "
                      "body: {mass: 0.4, friction: 0.5}}]\n"),
            path() +
                ": state: is not allowed with a body among the obstacles: states have the "
                "cloth alone");
}

TEST_F(StateFile, IsRefusedForWhatIsWrongWithIt) {
  const std::string good = savedText();
  const auto expect = [&](const std::string& from, const std::string& to,
                          const std::string& complaint) {
    EXPECT_EQ(refusalOfState(replaced(good, from, to)), statePath() + ": " + complaint);
  };
  expect("haptex cloth state", "haptex mesh", "line 1: must be 'haptex cloth state'");
  expect("particles 12", "particles twelve",
         "line 2: 'twelve' must be a finite number up to 1000000000");
  expect("particles 12\n", "", "line 2: must be 'particles' and a number >= 0");
  expect("particles 12", "particles 13", "has lines of 12 particles, must have 13 as it says");
  expect("particles 12", "particles 11",
         "line 16: one particle more than the 11 that the file says");
  expect("time 0.3", "time -0.3", "line 3: must be 'time' and a number >= 0");
  for (const std::string spoiled : {"nan", "inf", "-inf", "1e400", "1.5e9", "0.3x", "0x1p3"}) {
    expect("0.3333333333333333 -0 5e-324", "0.5 " + spoiled + " 1",
           "line 5: '" + spoiled + "' must be a finite number up to 1000000000");
  }
  expect("0.3333333333333333 -0 5e-324", "0.5 1",
         "line 5: has 5 words, must be 6 numbers: position (m) and velocity (m/s) of a particle");
  EXPECT_EQ(refusalOfState(""), statePath() + ": line 0: must be 'haptex cloth state'");
  const std::string half = good.substr(0, good.size() / 2);
  EXPECT_NE(refusalOfState(half.substr(0, half.rfind('\n') + 1)).find("must have 12 as it says"),
            std::string::npos);
  EXPECT_NE(refusalOf(kValid + "state: ./none.state\n").find("there is no file"),
            std::string::npos);
}

TEST_F(StateFile, IsWrittenToAbsolutePathsOfItsKindOnlyOrNotAtAll) {
  const std::string old = savedText();
  const auto refusal = [&](const std::string& path) -> std::string {
    return test::refusalOf<std::exception>([&] { saveState(path, state_); });
  };
  for (const std::string& path :
       {std::string(), std::string("cloth.state"), std::string("./cloth.state"),
        (root_ / "cloth.yaml").string(), (root_ / "scenes").string()}) {
    EXPECT_EQ(refusal(path),
              "path = '" + path + "': allowed are absolute paths that end with .state");
  }
  const std::string nowhere = (root_ / "none/cloth.state").string();
  EXPECT_EQ(refusal(nowhere), nowhere + ": cannot be written: No such file or directory");
  const std::string directory = (root_ / "directory.state").string();
  fs::create_directories(directory);
  EXPECT_EQ(refusal(directory), directory + ": cannot be written: Is a directory");
  state_.velocities[2].x() = std::numeric_limits<double>::infinity();
  EXPECT_NE(refusal(statePath()).find("particle 2 has a position or a velocity"),
            std::string::npos);
  std::ostringstream text;
  text << std::ifstream(statePath()).rdbuf();
  EXPECT_EQ(text.str(), old);  // still there
  for (const auto& entry : fs::recursive_directory_iterator(root_)) {
    EXPECT_NE(entry.path().extension(), ".part");
  }
}

}  // namespace
}  // namespace haptex::scene::test_cloth_state_file
