// The node exoskeleton_emulator, see haptex/nodes/exoskeleton_emulator/emulator_node.h.
#include "haptex/nodes/common/node_process.h"
#include "haptex/nodes/exoskeleton_emulator/emulator_node.h"

int main(int argc, char** argv) {
  haptex::nodes::ProcessTraits traits;
  traits.name = "exoskeleton_emulator";
  traits.spinners = 2;  // services, and the rest
  traits.on_force_path = true;
  return haptex::nodes::runNode<haptex::nodes::EmulatorNode>(argc, argv, traits);
}
