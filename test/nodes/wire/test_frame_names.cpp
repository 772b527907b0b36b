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
