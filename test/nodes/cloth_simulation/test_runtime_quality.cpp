#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>

#include "haptex/nodes/cloth_simulation/runtime_quality.h"
#include "haptex/scene/quality_file.h"

namespace haptex::nodes::test_runtime_quality {
namespace {

namespace fs = std::filesystem;

const std::string kConfig = HAPTEX_SOURCE_DIRECTORY "/config/";
const std::string kFast = kConfig + "presets/fast.yaml";

/// What fast.yaml has for a fabric.
scene::Quality fastOf(const std::string& fabric) {
  for (const scene::Quality& quality : scene::loadQualities(kFast)) {
    if (quality.fabric == fabric) return quality;
  }
  throw std::invalid_argument("fast.yaml has nothing for " + fabric);
}

/// A sheet so small that it takes no time to calibrate.
class RuntimeQualityOfAScene : public testing::Test {
 protected:
  ~RuntimeQualityOfAScene() override { fs::remove(path_); }

  std::string scene(const std::string& attached) const {
    std::ofstream(path_) << "fabric: " << kConfig << "fabrics/linear.yaml\n"
                         << "sheet: {size: [0.05, 0.05], cells: [3, 3], diagonals: one_way}\n"
                         << "attach: [" << attached << "]\nmodel: [gravity]\ntime_step: 0.0125\n";
    return path_.string();
  }

  const fs::path path_ =
      fs::path(testing::TempDir()) / ("haptex_runtime_" + std::to_string(getpid()) + ".yaml");
};

TEST_F(RuntimeQualityOfAScene, APresetRunsOnItsCellsAndStays) {
  const scene::Quality fast = fastOf("linear");
  const RuntimeQuality quality(scene("top"), {kFast, 0.0});
  simulation::SimulatedCloth simulation = quality.simulate();
  const auto cells = static_cast<std::size_t>(std::ceil(0.05 / fast.cell_size - 1e-6));
  EXPECT_EQ(simulation.cloth().mesh().triangles.size(), 2 * cells * cells);
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(simulation.step());
  const haptex::ClothQuality message = quality.message(simulation, ros::Time(1.0));
  EXPECT_EQ(message.quality.name, "fast");
  EXPECT_EQ(message.quality.fabric, "linear");
  EXPECT_TRUE(message.quality.cells_as_measured);
  EXPECT_EQ(message.budget_ms, 0.0);
  EXPECT_EQ(message.changes, 0u);
  EXPECT_EQ(message.within_budget, 1.0);
  EXPECT_GT(message.cycle_ms, 0.0);
}

/// Among obstacles cloth collides with itself in steps of backward Euler alone.
TEST_F(RuntimeQualityOfAScene, APresetIsByAMethodThatKnowsWhatTheSceneModels) {
  scene("top");
  std::ofstream(path_, std::ios::app)
      << "obstacles: [{name: ball, sphere: 0.01, position: [0, 0, -0.3]}]\n";
  std::ifstream file(path_);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  text.replace(text.find("[gravity]"), 9, "[gravity, self_collision, obstacles]");
  std::ofstream(path_) << text;
  for (const QualityRequest& request :
       {QualityRequest{kFast, 0.0}, QualityRequest{kFast, 1e-2}, QualityRequest{"", 1e-2}}) {
    const RuntimeQuality quality(path_.string(), request);
    simulation::SimulatedCloth simulation = quality.simulate();
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(simulation.step());
    const haptex::QualityPoint point = quality.message(simulation, ros::Time(1.0)).quality;
    EXPECT_EQ(point.integrator, "backward_euler") << point.name;
    if (request.preset_path.empty()) continue;  // the front has points of backward Euler, too
    EXPECT_FALSE(point.cells_as_measured) << point.name;
    EXPECT_TRUE(point.motion.empty()) << point.name;
  }
}

TEST_F(RuntimeQualityOfAScene, AMeshWithParticlesByIndexStaysAsItIs) {
  const RuntimeQuality quality(scene("{particles: [12, 15]}"), {"", 5e-3});
  const simulation::SimulatedCloth simulation = quality.simulate();
  EXPECT_EQ(simulation.cloth().mesh().triangles.size(), 2u * 3u * 3u);
  const haptex::ClothQuality message = quality.message(simulation, ros::Time(1.0));
  EXPECT_FALSE(message.quality.cells_as_measured);
  EXPECT_EQ(message.budget_ms, 5.0);
  haptex::QueryBudget::Response response;
  quality.query(simulation, 1e9, response);
  EXPECT_FALSE(response.needs_restart);
  EXPECT_FALSE(response.quality.cells_as_measured);
}

TEST_F(RuntimeQualityOfAScene, ABudgetThatNothingKeepsRunsByTheCheapest) {
  const RuntimeQuality quality(scene("top"), {"", 1e-9});
  simulation::SimulatedCloth simulation = quality.simulate();
  EXPECT_EQ(simulation.plan(), 0u);
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(simulation.step());
  EXPECT_EQ(simulation.plan(), 0u);
  EXPECT_EQ(quality.message(simulation, ros::Time(1.0)).within_budget, 0.0);
  haptex::QueryBudget::Response response;
  const std::string answer = quality.query(simulation, 1e-9, response);
  EXPECT_FALSE(response.affordable);
  EXPECT_NE(answer.find("buy nothing"), std::string::npos) << answer;
}

TEST_F(RuntimeQualityOfAScene, RefusesFilesWithSeveralForItsFabricAndBudgetsThatAreNone) {
  const std::string path = scene("top");
  EXPECT_THROW(RuntimeQuality(path, {kConfig + "presets/front.yaml", 0.0}), std::invalid_argument);
  const RuntimeQuality quality(path, {kFast, 0.0});
  const simulation::SimulatedCloth simulation = quality.simulate();
  haptex::QueryBudget::Response response;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double budget : {0.0, -1.0, kInfinity, std::nan("")}) {
    EXPECT_THROW(quality.query(simulation, budget, response), std::invalid_argument) << budget;
  }
}

TEST_F(RuntimeQualityOfAScene, ABudgetForTheScenesOwnSettingsKeepsItsMeshAndStartsWithThem) {
  const RuntimeQuality quality(scene("top"), {"", 5e-3, true});
  simulation::SimulatedCloth simulation = quality.simulate();
  EXPECT_EQ(simulation.cloth().mesh().triangles.size(), 2u * 3u * 3u);
  haptex::ClothQuality message = quality.message(simulation, ros::Time(1.0));
  EXPECT_EQ(message.quality.name, "scene");
  EXPECT_EQ(message.quality.time_step, 0.0125);
  EXPECT_EQ(message.budget_ms, 5.0);
  EXPECT_FALSE(message.quality.cells_as_measured);
  EXPECT_TRUE(message.quality.motion.empty());
  EXPECT_FALSE(quality.reduced(message));
  EXPECT_EQ(quality.wanted(), "scene");
  simulation::SimulatedCloth alone(scene::loadScene(path_.string()), simulation.cloth().fabric());
  ASSERT_TRUE(simulation.step());
  ASSERT_TRUE(alone.step());
  EXPECT_EQ(simulation.state().positions, alone.state().positions);

  simulation.relieve();
  message = quality.message(simulation, ros::Time(1.0));
  EXPECT_EQ(message.quality.name, "scene, backward_euler, 1 solve in 25 ms");
  EXPECT_EQ(message.quality.time_step, 0.025);
  EXPECT_TRUE(quality.reduced(message));
}

TEST_F(RuntimeQualityOfAScene, RunsByTheQualityOrTheBudgetThatIsAskedForLater) {
  QualityRequest request;
  request.of_scene = true;
  request.budget = 0.005;
  RuntimeQuality quality(scene("top"), request);
  simulation::SimulatedCloth simulation = quality.simulate();
  const ros::Time stamp(1.0);
  const std::vector<std::string> names = quality.message(simulation, stamp).qualities;
  ASSERT_GE(names.size(), 2u);
  EXPECT_EQ(names.back(), "scene");
  EXPECT_EQ(quality.set(simulation, names.front(), 0.002), "runs by " + names.front());
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(simulation.step());
  EXPECT_EQ(quality.message(simulation, stamp).quality.name, names.front()) << "it stays";
  EXPECT_EQ(quality.message(simulation, stamp).budget_ms, 0.0);
  quality.set(simulation, "", 0.0);
  EXPECT_EQ(quality.message(simulation, stamp).quality.name, "scene");
  EXPECT_NE(quality.set(simulation, "", 0.004).find("4 ms"), std::string::npos);
  EXPECT_EQ(quality.message(simulation, stamp).budget_ms, 4.0);
  quality.set(simulation, "", 1.0);
  EXPECT_DOUBLE_EQ(quality.message(simulation, stamp).budget_ms, 10.0) << "four fifths of a cycle";
  for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(quality.set(simulation, "", bad), std::invalid_argument);
  }
  EXPECT_THROW(quality.set(simulation, "finest", 0.0), std::invalid_argument);
  EXPECT_DOUBLE_EQ(quality.message(simulation, stamp).budget_ms, 10.0)
      << "what is refused changes nothing";
}

TEST_F(RuntimeQualityOfAScene, APresetMayBeReducedForABudgetOfAtMostFourFifthsOfACycle) {
  const RuntimeQuality quality(scene("top"), {kFast, 1.0});
  const simulation::SimulatedCloth simulation = quality.simulate();
  const haptex::ClothQuality message = quality.message(simulation, ros::Time(1.0));
  EXPECT_EQ(message.quality.name, "fast");
  EXPECT_TRUE(message.quality.cells_as_measured);
  EXPECT_DOUBLE_EQ(message.budget_ms, 10.0);
  EXPECT_EQ(simulation.controller()->size(),
            simulation::reductions(fastOf("linear"), 0.0125, 1e-3, 2).size());
}

}  // namespace
}  // namespace haptex::nodes::test_runtime_quality
