// The nodes exoskeleton_driver and force_renderer in one process: fingertips and forces go from one
// to the other without a socket, on the threads that make them. Their parameters are those of
// separate processes, in the namespaces exoskeleton_driver and force_renderer.
#include "haptex/nodes/common/node_process.h"
#include "haptex/nodes/exoskeleton_driver/driver_node.h"
#include "haptex/nodes/force_renderer/force_renderer_node.h"

namespace {

using namespace haptex::nodes;

struct Haptics {
  DriverNode driver{ros::NodeHandle(), ros::NodeHandle("exoskeleton_driver")};
  ForceRendererNode renderer{ros::NodeHandle(), ros::NodeHandle("force_renderer")};

  void stop() {
    renderer.stop();
    driver.stop();
  }
};

}  // namespace

int main(int argc, char** argv) {
  ProcessTraits traits;
  traits.name = "haptics";
  traits.spinners = 4;  // one homes, the others answer meanwhile
  traits.on_force_path = true;
  return runNode(argc, argv, traits, [] {
    const auto nodes = std::make_shared<Haptics>();
    return RunningNode{nodes, [nodes] { nodes->stop(); }};
  });
}
