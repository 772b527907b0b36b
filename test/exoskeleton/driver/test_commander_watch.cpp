#include <gtest/gtest.h>

#include "haptex/exoskeleton/driver/commander_watch.h"

namespace haptex::exoskeleton::test_commander_watch {
namespace {

using base::Finger;

TEST(CommanderWatch, KnowsTheDeathOfTheOneWhoCommandedLastOnce) {
  CommanderWatch watch;
  EXPECT_FALSE(watch.hasDied(Finger::kIndex, "")) << "nobody has commanded";
  watch.commanded(Finger::kIndex, "/renderer");
  EXPECT_FALSE(watch.hasDied(Finger::kThumb, "/renderer"));
  EXPECT_FALSE(watch.hasDied(Finger::kIndex, "/rviz"));
  EXPECT_TRUE(watch.hasDied(Finger::kIndex, "/renderer"));
  EXPECT_FALSE(watch.hasDied(Finger::kIndex, "/renderer"));
  watch.commanded(Finger::kIndex, "/renderer");
  watch.commanded(Finger::kIndex, "/another");
  EXPECT_FALSE(watch.hasDied(Finger::kIndex, "/renderer"));
  EXPECT_TRUE(watch.hasDied(Finger::kIndex, "/another"));
}

TEST(CommanderWatch, KnowsWhoCommandsAFinger) {
  CommanderWatch watch;
  EXPECT_FALSE(watch.commands(Finger::kIndex, "/renderer"));
  watch.commanded(Finger::kIndex, "/renderer");
  EXPECT_TRUE(watch.commands(Finger::kIndex, "/renderer"));
  EXPECT_FALSE(watch.commands(Finger::kThumb, "/renderer"));
  watch.commanded(Finger::kIndex, "/another");
  EXPECT_FALSE(watch.commands(Finger::kIndex, "/renderer"));
}

}  // namespace
}  // namespace haptex::exoskeleton::test_commander_watch
