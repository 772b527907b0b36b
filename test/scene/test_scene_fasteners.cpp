// Fasteners in scene files.
#include "scene_fixtures.h"

namespace haptex::scene::test_scene_fasteners {
namespace {

/// kValid is of 3 x 2 cells of 100 mm.
const std::string kButton =
    "{name: collar, kind: button, between: [0, [0.05, 0.02]], stiffness: 500, release_force: 8}";

std::string withFasteners(const std::string& fasteners) {
  return kValid + "fasteners: [" + fasteners + "]\n";
}

class SceneFasteners : public SceneFile {
 protected:
  void expectRefused(const std::string& fasteners, const std::string& reason) const {
    const std::string refusal = refusalOf(withFasteners(fasteners));
    EXPECT_NE(refusal.find(path() + ": fasteners"), std::string::npos) << refusal;
    EXPECT_NE(refusal.find(reason), std::string::npos) << refusal;
  }
  void expectButtonRefused(const std::string& from, const std::string& to,
                           const std::string& reason) const {
    expectRefused(replaced(kButton, from, to), reason);
  }
};

TEST_F(SceneFasteners, AreBetweenParticlesAndPlacesInTriangles) {
  const Scene scene = load(withFasteners(
      kButton +
      ", {name: waist, kind: elastic, between: [[0.3, 0.2], [0.1, 0.1]], length: 0.15, "
      "stiffness: 20, release_force: 30, fastened: false}"));
  ASSERT_EQ(scene.effects.fasteners.size(), 2u);
  const cloth::Fastener& button = scene.effects.fasteners[0];
  EXPECT_EQ(button.name, "collar");
  EXPECT_EQ(button.kind, cloth::FastenerKind::kButton);
  EXPECT_EQ(button.stiffness, 500.0);
  EXPECT_EQ(button.release_force, 8.0);
  EXPECT_EQ(button.length, 0.0);
  EXPECT_TRUE(button.fastened);
  EXPECT_EQ(button.places[0].particles[0], 0);
  const cloth::Fastener& waist = scene.effects.fasteners[1];
  EXPECT_EQ(waist.length, 0.15);
  EXPECT_FALSE(waist.fastened);
  const auto rest_of = [&](const cloth::ClothPlace& place) {
    Eigen::Vector2d rest = Eigen::Vector2d::Zero();
    for (int i = 0; i < 3; ++i) {
      rest += place.weights[i] * scene.mesh.rest_coordinates[place.particles[i]];
    }
    return rest;
  };
  EXPECT_LT((rest_of(button.places[1]) - Eigen::Vector2d(0.05, 0.02)).norm(), 1e-12);
  EXPECT_LT((rest_of(waist.places[0]) - Eigen::Vector2d(0.3, 0.2)).norm(), 1e-12);
  EXPECT_LT((rest_of(waist.places[1]) - Eigen::Vector2d(0.1, 0.1)).norm(), 1e-12);
}

TEST_F(SceneFasteners, ADrawstringRunsThroughSeveralPlaces) {
  const std::string cord =
      "{name: cord, kind: drawstring, between: [0, [0.1, 0.1], [0.2, 0.1], 3, 0], length: 0.3, "
      "stiffness: 20, release_force: 30}";
  const Scene scene = load(withFasteners(cord));
  const cloth::Fastener& fastener = scene.effects.fasteners.at(0);
  EXPECT_EQ(fastener.kind, cloth::FastenerKind::kDrawstring);
  EXPECT_EQ(fastener.length, 0.3);
  ASSERT_EQ(fastener.places.size(), 5u);
  EXPECT_EQ(fastener.places[3].particles[0], 3);
  EXPECT_EQ(fastener.places[4].particles[0], 0);
  expectRefused(replaced(cord, "between: [0, ", "between: [0, 0, "),
                "two places in a row are the same");
  expectRefused(replaced(cord, "between: [0, [0.1, 0.1], [0.2, 0.1], 3, 0]", "between: [0]"),
                "has 1 places; allowed are 2 to 32");
  expectRefused(replaced(cord, ", length: 0.3", ""), "lacks the key length");
}

TEST_F(SceneFasteners, ByRestCoordinatesAllowAnyCells) {
  EXPECT_FALSE(load(withFasteners(kButton)).any_cells);
  EXPECT_TRUE(load(withFasteners(replaced(kButton, "[0, ", "[[0, 0], "))).any_cells);
}

TEST_F(SceneFasteners, OfGarmentsAreInGroups) {
  std::ofstream(root_ / "scenes/sewn.obj")
      << "v 0 0 0\nv 0 0.1 0\nv 0 0.1 0.1\nv 0 0 0.1\n"
         "vt 0 0\nvt 0.1 0\nvt 0.1 0.1\nvt 0 0.1\nvt 5 0\nvt 5.1 0.1\n"
         "g one\nf 1/1 2/2 3/3\ng two\nf 1/5 3/6 4/4\n";
  const auto scene = [](const std::string& between) {
    return "fabric: silk\nmesh: ./sewn.obj\nattach: []\nmodel: [gravity]\ntime_step: 0.01\n"
           "fasteners: [{name: hook, kind: hook, between: " +
           between + ", stiffness: 500, release_force: 8}]\n";
  };
  const Scene loaded =
      load(scene("[{group: one, at: [0.08, 0.02]}, {group: two, at: [5.0, 0.0]}]"));
  const cloth::Fastener& hook = loaded.effects.fasteners.at(0);
  EXPECT_EQ(hook.kind, cloth::FastenerKind::kHook);
  EXPECT_EQ(hook.places[0].particles, (std::array<int, 3>{0, 1, 2}));
  EXPECT_NEAR(hook.places[0].weights[1], 0.6, 1e-12);
  EXPECT_NEAR(hook.places[1].weights[0], 1.0, 1e-12);
  EXPECT_NE(refusalOf(scene("[[0.08, 0.02], 3]")).find("the mesh has seams"), std::string::npos);
  EXPECT_NE(refusalOf(scene("[{group: three, at: [0, 0]}, 3]")).find("one, two"),
            std::string::npos);
  EXPECT_NE(refusalOf(scene("[{group: one, at: [0, 0.1]}, 3]")).find("within the cloth"),
            std::string::npos);
}

TEST_F(SceneFasteners, RefusalsNameWhatIsWrong) {
  expectRefused(kButton + ", " + kButton, "is the name of another fastener");
  expectButtonRefused("collar", "a/b", "must be a letter");
  expectButtonRefused("button", "zip", "button, hook, elastic, drawstring");
  expectButtonRefused("[0, ", "[99, ", "must be a particle from 0 to 11");
  expectButtonRefused("[0.05, 0.02]", "[0.05, 0.3]", "within the cloth");
  expectButtonRefused("[0.05, 0.02]", "[0.0, 0.0]", "both places are the same");
  expectButtonRefused("[0, [0.05, 0.02]]", "[0]", "must be a list of 2");
  expectButtonRefused("stiffness: 500", "stiffness: 0", "must be > 0 and <= 1000000 N/m");
  expectButtonRefused("stiffness: 500", "stiffness: .nan", "stiffness");
  expectButtonRefused("release_force: 8", "release_force: -1", "must be > 0 and <= 10000 N");
  expectButtonRefused(", release_force: 8", "", "release_force");
  expectButtonRefused("release_force: 8", "release_force: 8, length: 0.1",
                      "of the kinds elastic and drawstring only");
  expectButtonRefused("button", "elastic", "lacks the key length");
  expectButtonRefused("release_force: 8", "release_force: 8, fastened: 3", "true, false");
}

}  // namespace
}  // namespace haptex::scene::test_scene_fasteners
