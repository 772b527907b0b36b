// The node tactile_emulator, see haptex/nodes/tactile_emulator/tactile_emulator_node.h.
#include "haptex/nodes/common/node_process.h"
#include "haptex/nodes/tactile_emulator/tactile_emulator_node.h"

int main(int argc, char** argv) {
  haptex::nodes::ProcessTraits traits;
  traits.name = "tactile_emulator";
  return haptex::nodes::runNode<haptex::nodes::TactileEmulatorNode>(argc, argv, traits);
}
