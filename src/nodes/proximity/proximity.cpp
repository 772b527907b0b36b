// The node proximity, see haptex/nodes/proximity/proximity_node.h.
#include "haptex/nodes/common/node_process.h"
#include "haptex/nodes/proximity/proximity_node.h"

int main(int argc, char** argv) {
  haptex::nodes::ProcessTraits traits;
  traits.name = "proximity";
  return haptex::nodes::runNode<haptex::nodes::ProximityNode>(argc, argv, traits);
}
