// Frames that carry particles in scene files.
#include <gtest/gtest.h>

#include "haptex/scene/frame_name.h"
#include "scene_fixtures.h"

namespace haptex::scene::test_scene_frames {
namespace {

/// kValid is of 3 x 2 cells of 100 mm.
std::string withFrames(const std::string& attach, const std::string& frames) {
  const std::string scene = replaced(kValid, "attach: [top]", "attach: " + attach);
  return frames.empty() ? scene : scene + "frames: " + frames + "\n";
}

class SceneFrames : public SceneFile {
 protected:
  void expectRefused(const std::string& attach, const std::string& frames,
                     const std::string& reason) const {
    const std::string refusal = refusalOf(withFrames(attach, frames));
    EXPECT_NE(refusal.find(path() + ": "), std::string::npos) << refusal;
    EXPECT_NE(refusal.find(reason), std::string::npos) << refusal;
  }
};

TEST_F(SceneFrames, CarrySidesRangesAndParticles) {
  const Scene scene = load(withFrames(
      "[{frame: bow, side: top}, {frame: car, from: [0, 0], to: [0.3, 0]}, {particles: [5]}]",
      "[{name: bow, position: [1, 2, 3], rpy: [0, 0, 1.5707963267948966]}, {name: car}]"));
  ASSERT_EQ(scene.frames.size(), 2u);
  EXPECT_EQ(scene.frames[0].name, "bow");
  EXPECT_EQ(scene.frames[0].particles, (std::vector<int>{8, 9, 10, 11}));
  EXPECT_EQ(scene.frames[1].particles, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(scene.attached_particles, (std::vector<int>{0, 1, 2, 3, 5, 8, 9, 10, 11}));
  const CarryingFrame& bow = scene.frames[0];
  for (std::size_t i = 0; i < bow.particles.size(); ++i) {
    EXPECT_LT((bow.start * bow.places[i] - scene.mesh.initial_positions[bow.particles[i]]).norm(),
              1e-12);
  }
  // A quarter turn about z: what is along x in the frame is along y in the world.
  EXPECT_LT((bow.start.linear() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(),
            1e-12);
}

TEST_F(SceneFrames, RangesHoldParticlesInTheWorldToo) {
  const Scene scene = load(withFrames("[{from: [0.1, 0.1], to: [0.2, 0.2]}]", ""));
  EXPECT_EQ(scene.attached_particles, (std::vector<int>{5, 6, 9, 10}));
  EXPECT_TRUE(scene.frames.empty());
}

TEST(FrameNamesOfScenes, AreALetterThenLettersDigitsAndUnderscores) {
  const std::string longest(kLongestFrameName, 'a');
  for (const std::string& name :
       {std::string("a"), std::string("Bow_2"), std::string("b9"), longest}) {
    EXPECT_TRUE(isFrameName(name)) << name;
  }
  for (const std::string& name : {std::string(), std::string("2nd"), std::string("_a"),
                                  std::string("a/b"), std::string("a b"), std::string("a-b"),
                                  std::string("\xc3\xa4"), std::string("a\0", 2), longest + "a"}) {
    EXPECT_FALSE(isFrameName(name)) << name;
  }
  EXPECT_NE(std::string(kFrameNames).find(std::to_string(kLongestFrameName)), std::string::npos);
}

TEST_F(SceneFrames, RefusalsNameWhatIsWrong) {
  const std::string bow = "[{name: bow}]";
  expectRefused("[{frame: boom, side: top}]", bow, "must be one of the key frames: bow");
  expectRefused("[{frame: bow, side: top}]", "", "there is none");
  expectRefused("[top]", bow, "carries nothing");
  expectRefused("[{frame: bow, side: top}, top]", bow, "attaches particle");
  expectRefused("[{frame: bow, side: top}]", "[{name: bow}, {name: bow}]", "another frame");
  expectRefused("[{frame: a/b, side: top}]", "[{name: a/b}]", "must be a letter, then letters");
  expectRefused("[{frame: bow, from: [1, 1], to: [2, 2]}]", bow, "has no particle");
  expectRefused("[{frame: bow, from: [1, 1]}]", bow, "to");
  expectRefused("[{frame: bow}]", bow, "exactly one of particles, side, from");
  expectRefused("[{frame: bow, particles: [99]}]", bow, "must be a particle");
  expectRefused("[{frame: bow, side: top}]", "[{name: bow, position: [1, 2]}]", "position");
}

}  // namespace
}  // namespace haptex::scene::test_scene_frames
