// The node tactile_renderer, see haptex/nodes/tactile_renderer/tactile_node.h.
#include "haptex/nodes/common/node_process.h"
#include "haptex/nodes/tactile_renderer/tactile_node.h"

int main(int argc, char** argv) {
  haptex::nodes::ProcessTraits traits;
  traits.name = "tactile_renderer";
  return haptex::nodes::runNode<haptex::nodes::TactileNode>(argc, argv, traits);
}
