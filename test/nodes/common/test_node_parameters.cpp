#include <gtest/gtest.h>

#include "haptex/nodes/common/node_parameters.h"

namespace haptex::nodes::test_node_parameters {
namespace {

TEST(PortOf, PathsStayAsTheyAre) {
  EXPECT_EQ(portOf("/dev/ttyUSB0", "/left/haptex"), "/dev/ttyUSB0");
  EXPECT_EQ(portOf("./exoskeleton", "/left/haptex"), "./exoskeleton");
}

TEST(PortOf, NamesHaveWhatComesBeforeTheLastPartOfTheNamespace) {
  EXPECT_EQ(portOf("haptex_exoskeleton", "/"), "haptex_exoskeleton");
  EXPECT_EQ(portOf("haptex_exoskeleton", "/haptex"), "haptex_exoskeleton");
  EXPECT_EQ(portOf("haptex_exoskeleton", "/left/haptex"), "left_haptex_exoskeleton");
  EXPECT_EQ(portOf("haptex_exoskeleton", "/rig/left/haptex"), "rig_left_haptex_exoskeleton");
}

}  // namespace
}  // namespace haptex::nodes::test_node_parameters
