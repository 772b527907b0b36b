// The node tactile_driver, see haptex/nodes/tactile_driver/tactile_driver_node.h.
#include "haptex/nodes/common/node_process.h"
#include "haptex/nodes/tactile_driver/tactile_driver_node.h"

int main(int argc, char** argv) {
  haptex::nodes::ProcessTraits traits;
  traits.name = "tactile_driver";
  return haptex::nodes::runNode<haptex::nodes::TactileDriverNode>(argc, argv, traits);
}
