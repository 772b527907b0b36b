// The node hand_tracker, see haptex/nodes/hand_tracker/hand_tracker_node.h.
#include "haptex/nodes/common/node_process.h"
#include "haptex/nodes/hand_tracker/hand_tracker_node.h"

int main(int argc, char** argv) {
  haptex::nodes::ProcessTraits traits;
  traits.name = "hand_tracker";
  traits.on_force_path = true;
  return haptex::nodes::runNode<haptex::nodes::HandTrackerNode>(argc, argv, traits);
}
