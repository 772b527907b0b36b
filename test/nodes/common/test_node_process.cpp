#include <gtest/gtest.h>
#include <unistd.h>

#include "haptex/nodes/common/node_process.h"

namespace haptex::nodes::test_node_process {
namespace {

void workForEver() {
  limitEnding(std::chrono::seconds(1));
  while (true) pause();
}

TEST(NodeProcess, EndsThoughItIsStillAtWork) {
  EXPECT_EXIT(workForEver(), testing::ExitedWithCode(1), "Asked to end, and still at work");
}

}  // namespace
}  // namespace haptex::nodes::test_node_process
