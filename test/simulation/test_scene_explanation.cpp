#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "haptex/simulation/scene_explanation.h"

namespace haptex::simulation::test_scene_explanation {
namespace {

std::vector<std::string> listedIn(const scene::Scene& scene) {
  std::vector<std::string> names;
  for (const Effect& effect : effectsOf(scene)) {
    if (effect.listed) names.push_back(effect.name);
  }
  return names;
}

scene::Scene sceneWithEverything() {
  scene::Scene scene;
  scene.effects.gravity = {0.0, 0.0, -9.8};
  scene.effects.viscosity = scene.effects.membrane_hysteresis = true;
  scene.effects.bending = scene.effects.bending_hysteresis = true;
  scene.effects.self_collision = true;
  scene.effects.contraction = scene.effects.contacts = scene.effects.point_loads = true;
  scene.effects.air = cloth::Air();
  scene.effects.air->wind.mean = {1.0, 0.0, 0.0};
  scene.fingers = scene.tactile = scene.recording = true;
  return scene;
}

scene::Scene stuffed(scene::Scene scene) {
  scene.effects.stuffing.emplace();
  return scene;
}

using Names = std::vector<std::string>;

TEST(EffectsOf, AreThoseThatTheSceneLists) {
  EXPECT_EQ(listedIn(scene::Scene()), Names());
  EXPECT_EQ(listedIn(stuffed(sceneWithEverything())).size(), effectsOf(scene::Scene()).size());
  EXPECT_EQ(listedIn(scene::loadScene(HAPTEX_CONFIG_DIRECTORY "/scenes/wool_sample.yaml")),
            Names({"gravity", "viscosity", "bending", "fingers", "tactile"}));
  EXPECT_EQ(listedIn(scene::loadScene(HAPTEX_CONFIG_DIRECTORY "/scenes/wool_in_wind.yaml")),
            Names({"gravity", "viscosity", "bending", "air", "wind"}));
}

TEST(WithoutEffect, TakesAwayWhatBuildsOnItAndNothingElse) {
  const auto gone_from = [](const scene::Scene& scene, const std::string& name) {
    const Names left = listedIn(withoutEffect(scene, name));
    Names gone;
    for (const std::string& all : listedIn(scene)) {
      if (std::find(left.begin(), left.end(), all) == left.end()) gone.push_back(all);
    }
    return gone;
  };
  const auto gone = [&](const std::string& name) { return gone_from(sceneWithEverything(), name); };
  for (const char* name : {"gravity", "viscosity", "membrane_hysteresis", "bending_hysteresis",
                           "contraction", "self_collision", "wind", "obstacles"}) {
    EXPECT_EQ(gone(name), Names({name}));
  }
  EXPECT_EQ(gone("bending"), Names({"bending", "bending_hysteresis"}));
  EXPECT_EQ(gone("air"), Names({"air", "wind"}));
  EXPECT_EQ(gone("fingers"), Names({"fingers", "tactile"}));
  EXPECT_EQ(gone_from(stuffed(sceneWithEverything()), "stuffing"), Names({"stuffing"}));
  // What is stuffed touches obstacles as it touches itself.
  EXPECT_EQ(gone_from(stuffed(sceneWithEverything()), "self_collision"),
            Names({"self_collision", "obstacles"}));
  EXPECT_FALSE(withoutEffect(sceneWithEverything(), "fingers").effects.point_loads);
  for (const char* name : {"tactile", "recording", "magnetism"}) {
    EXPECT_THROW(withoutEffect(sceneWithEverything(), name), std::invalid_argument);
  }
}

TEST(CellSize, IsTheLongerEdgeOfACell) {
  const auto size = [](double width, double height, int cells_u, int cells_v) {
    return medianCellSize(
        mesh::makeRectangle(width, height, cells_u, cells_v, mesh::Triangulation::kAlternating));
  };
  EXPECT_NEAR(size(0.2, 0.2, 32, 32), 0.00625, 1e-12);
  EXPECT_NEAR(size(0.2, 0.1, 4, 10), 0.05, 1e-12);
}

TEST(NearestQuality, IsTheOneThatDiffersLeastAmongThoseThatCompute) {
  scene::Scene scene;
  scene.mesh = mesh::makeRectangle(0.2, 0.2, 20, 20, mesh::Triangulation::kOneWay);  // 10 mm
  scene.time_step = 0.01;
  std::vector<scene::Quality> studied(5);
  const auto set = [&](int i, const char* name, double cells, double step) {
    studied[i].name = name;
    studied[i].cell_size = cells;
    studied[i].time_step = step;
  };
  set(0, "coarse", 0.014, 0.01);
  set(1, "near", 0.01, 0.012);
  set(2, "far", 0.01, 0.002);
  set(3, "another method", 0.01, 0.01);
  set(4, "more solves", 0.01, 0.01);
  studied[3].step.method = cloth::IntegrationMethod::kTrBdf2;
  studied[4].step.newton_iterations = 3;
  const auto nearest = [&] {
    const scene::Quality* quality = nearestQuality(scene, studied);
    return quality ? quality->name : "none";
  };
  EXPECT_EQ(nearest(), "near");
  scene.time_step = 0.0021;
  EXPECT_EQ(nearest(), "far");
  scene.time_step = 0.1;
  EXPECT_EQ(nearest(), "none");
  scene.time_step = 0.01;
  scene.mesh = mesh::makeRectangle(0.2, 0.2, 10, 10, mesh::Triangulation::kOneWay);
  EXPECT_EQ(nearest(), "coarse");
  scene.mesh = mesh::makeRectangle(0.2, 0.2, 5, 5, mesh::Triangulation::kOneWay);
  EXPECT_EQ(nearest(), "none") << "as coarse as 40 mm";
  scene.mesh = mesh::makeRectangle(0.2, 0.2, 100, 100, mesh::Triangulation::kOneWay);
  EXPECT_EQ(nearest(), "near") << "as fine as 2 mm";
  scene.time_step = 0.01;
  scene.effects.elasticity = cloth::Elasticity::kCorotational;
  EXPECT_EQ(nearest(), "none") << "which was not studied";
}

class ExplainedScene : public testing::Test {
 protected:
  ExplainedScene()
      : path_(testing::TempDir() + "haptex_explained_" + std::to_string(getpid()) + ".yaml") {}
  ~ExplainedScene() override { std::remove(path_.c_str()); }

  std::string explain(const std::string& fabric, const std::string& model,
                      const std::vector<scene::Quality>& studied = {}) {
    std::ofstream(path_) << "fabric: " << HAPTEX_CONFIG_DIRECTORY << "/fabrics/" << fabric
                         << ".yaml\n"
                         << "sheet: {size: [0.1, 0.1], cells: [4, 4], diagonals: one_way}\n"
                         << "attach: [top]\nmodel: [" << model << "]\ntime_step: 0.02\n";
    std::ostringstream out, progress;
    explainScene(path_, studied, out, progress);
    EXPECT_NE(progress.str(), "");
    return out.str();
  }

  static void expectIn(const std::string& text, const std::string& expected) {
    EXPECT_NE(text.find(expected), std::string::npos) << expected << " is not in\n" << text;
  }

  std::string path_;
};

TEST_F(ExplainedScene, NamesWhatIsModelledAndWhatIsNot) {
  const std::string text = explain("wool", "gravity, fingers, tactile");
  expectIn(text, path_);
  expectIn(text, "32 triangles, 25 particles of which 5 are attached, cells of 25 mm");
  expectIn(text, "20 ms, backward_euler, 1 linear solve by the cheaper solver to 1e-06, 1 thread");
  const std::size_t modelled = text.find("\nmodelled"), not_modelled = text.find("\nnot modelled"),
                    machine = text.find("\non this machine");
  ASSERT_LT(modelled, not_modelled);
  ASSERT_LT(not_modelled, machine);
  for (const Effect& effect : effectsOf(scene::loadScene(path_))) {
    const std::size_t place = text.find("\n  " + effect.name + " ", modelled);
    EXPECT_GT(place, effect.listed ? modelled : not_modelled - 1) << effect.name;
    EXPECT_LT(place, effect.listed ? not_modelled : machine) << effect.name;
  }
  expectIn(text, "of every millisecond while two fingertips touch");
  expectIn(text, "of every 25 ms");
  expectIn(text, "times as fast as real time");
  expectIn(text, "not studied");
}

TEST_F(ExplainedScene, TellsTheErrorOfTheNearestStudiedSetting) {
  scene::Quality quality;
  quality.name = "coarse_1";
  quality.cell_size = 0.025;
  quality.time_step = 0.025;
  quality.measured = {{"swing", "linear", 3e-3, 0.02, 1e-3, 0.01},
                      {"swing", "wool", 5e-3, 0.04, 2e-3, 0.01}};
  const std::string linear = explain("linear", "gravity", {quality});
  expectIn(linear, "coarse_1: cells of 25 mm, steps of 25 ms, backward_euler");
  expectIn(linear, "linear: 3 mm in position, 0.02 N in the force that holds it, 1 mJ in energy");
  EXPECT_EQ(linear.find("wool"), std::string::npos);
  const std::string denim = explain("denim", "gravity", {quality});
  expectIn(denim, "not with denim");
  expectIn(denim, "wool: 5 mm in position");
}

TEST_F(ExplainedScene, IsRefusedAsTheNodesRefuseIt) {
  const auto refusal = [this](const std::string& fabric, const std::string& model) {
    return test::refusalOf<std::exception>([&] { explain(fabric, model); });
  };
  EXPECT_EQ(refusal("wool", "magic").rfind(path_ + ": model[0]: 'magic' must be one of ", 0), 0u);
  EXPECT_EQ(refusal("linear", "fingers, tactile")
                .rfind(path_ + ": model: lists tactile, but fabric 'linear' has no surface", 0),
            0u);
}

}  // namespace
}  // namespace haptex::simulation::test_scene_explanation
