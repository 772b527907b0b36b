#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes::test_frame_names {
namespace {

using base::Finger;

struct FrameNames : testing::Test {
  void TearDown() override { setFramePrefix(""); }
};

TEST_F(FrameNames, AreThoseOfTheUrdfWithoutAPrefix) {
  EXPECT_EQ(fixedFrame(), "world");
  EXPECT_EQ(handFrame(), "hand_base");
  EXPECT_EQ(tipFrame(Finger::kIndex), "index_tip");
  EXPECT_EQ(arrayFrame(Finger::kThumb), "thumb_tactile");
}

TEST_F(FrameNames, HaveThePrefixBeforeASlash) {
  setFramePrefix("left");
  EXPECT_EQ(fixedFrame(), "left/world");
  EXPECT_EQ(handFrame(), "left/hand_base");
  EXPECT_EQ(tipFrame(Finger::kThumb), "left/thumb_tip");
  EXPECT_EQ(arrayFrame(Finger::kIndex), "left/index_tactile");
  setFramePrefix("rig_2/left");
  EXPECT_EQ(fixedFrame(), "rig_2/left/world");
}

TEST_F(FrameNames, CarryingFramesAreNamedAsScenesDo) {
  EXPECT_EQ(carryingFrame("bow_1"), "bow_1");
  setFramePrefix("left");
  EXPECT_EQ(carryingFrame("left/bow_1"), "bow_1");
  EXPECT_EQ(frameCalled(carryingFrame("left/bow_1")), "left/bow_1");
}

TEST_F(FrameNames, CarryingFramesThatAreNoneAreRefused) {
  const auto refusal_of = [](const std::string& frame_id) -> std::string {
    try {
      return "accepted " + carryingFrame(frame_id);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
  };
  EXPECT_EQ(refusal_of(""),
            "header.frame_id = '': allowed is 'world', or a frame that carries the particles: a "
            "letter, then letters, digits and _, up to 200 characters");
  EXPECT_EQ(refusal_of("a/b").find("header.frame_id = 'a/b': allowed is 'world'"), 0u);
  EXPECT_LT(refusal_of(std::string(10'000'000, 'a')).size(), 500u);
  setFramePrefix("left");
  EXPECT_EQ(refusal_of("bow"),
            "header.frame_id = 'bow': allowed is 'left/world', or a frame that carries the "
            "particles: 'left/' and a letter, then letters, digits and _, up to 200 characters");
}

TEST_F(FrameNames, ARefusedPrefixIsNamedAndChangesNothing) {
  for (const std::string wrong : {"/left", "left/", "a//b", "a b", "a-b", "\xc3\xa4"}) {
    try {
      setFramePrefix(wrong);
      ADD_FAILURE() << "accepted " << wrong;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(error.what(), "tf_prefix = '" + wrong +
                                  "': allowed are letters, digits and _, in parts between slashes, "
                                  "up to 200 characters, or nothing");
    }
  }
  EXPECT_THROW(setFramePrefix(std::string(10'000'000, 'a')), std::invalid_argument);
  EXPECT_EQ(fixedFrame(), "world");
}

}  // namespace
}  // namespace haptex::nodes::test_frame_names
