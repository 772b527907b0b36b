// The node cloth_simulation, see haptex/nodes/cloth_simulation/cloth_node.h.
#include "haptex/nodes/cloth_simulation/cloth_node.h"
#include "haptex/nodes/common/node_process.h"

int main(int argc, char** argv) {
  haptex::nodes::ProcessTraits traits;
  traits.name = "cloth_simulation";
  traits.spinners = 4;  // a service that waits must not hold up the others
  return haptex::nodes::runNode<haptex::nodes::ClothNode>(argc, argv, traits);
}
