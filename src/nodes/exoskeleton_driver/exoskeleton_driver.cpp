// The node exoskeleton_driver, see haptex/nodes/exoskeleton_driver/driver_node.h.
#include "haptex/nodes/common/node_process.h"
#include "haptex/nodes/exoskeleton_driver/driver_node.h"

int main(int argc, char** argv) {
  haptex::nodes::ProcessTraits traits;
  traits.name = "exoskeleton_driver";
  traits.spinners = 4;  // one homes, the others answer meanwhile
  traits.on_force_path = true;
  return haptex::nodes::runNode<haptex::nodes::DriverNode>(argc, argv, traits);
}
