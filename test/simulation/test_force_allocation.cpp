// An executable of its own, because it counts every call of malloc in the process.
#include <gtest/gtest.h>

#include "../malloc_counter.h"
#include "force_loop_fixtures.h"

namespace haptex::simulation::test_force_allocation {
namespace {

TEST(ForceAllocation, TheLoopDoesNotAllocateWhileAFingertipComesTouchesAndGoes) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  TouchedSheet sheet;
  sheet.giveLayer();
  sheet.run(100);  // also fills the buffers of what comes in
  const long before = allocations;
  sheet.loop().askForPicture();
  sheet.touch();
  sheet.run(200);
  EXPECT_GT(sheet.force().norm(), 0.01);
  sheet.loop().askForPicture();
  sheet.silence(RendererSource::kFingertip);
  sheet.run(50);
  EXPECT_EQ(sheet.force().norm(), 0.0);
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(before, 0) << "the count does not work";
}

}  // namespace
}  // namespace haptex::simulation::test_force_allocation
