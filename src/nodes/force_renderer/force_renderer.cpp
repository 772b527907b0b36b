// The node force_renderer, see haptex/nodes/force_renderer/force_renderer_node.h.
#include "haptex/nodes/common/node_process.h"
#include "haptex/nodes/force_renderer/force_renderer_node.h"

int main(int argc, char** argv) {
  haptex::nodes::ProcessTraits traits;
  traits.name = "force_renderer";
  traits.on_force_path = true;
  return haptex::nodes::runNode<haptex::nodes::ForceRendererNode>(argc, argv, traits);
}
