// The process of a node: how it starts, and how it ends.
#pragma once

#include <ros/node_handle.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>

namespace haptex::nodes {

/// Makes a node, ready to stop: the function that comes back ends it, first what acts on a person,
/// so that services that wait return and the last owner may destroy it.
struct RunningNode {
  std::shared_ptr<void> node;
  std::function<void()> stop;
};

struct ProcessTraits {
  std::string name;            ///< of the node
  unsigned spinners = 1;       ///< threads for the callbacks of roscpp's own queue
  bool on_force_path = false;  ///< from the device's position to its force, see scheduling.h
};

/// Whether this process has been asked to end. For services that wait.
bool isEnding();

/// From now on the process has so long to end. Then it ends with status 1, whatever it is at: a
/// step of folded cloth may take longer on a busy machine than roslaunch waits before it kills.
/// @param most s, > 0
void limitEnding(std::chrono::seconds most);

/// Everything that main() of a node does. SIGINT, SIGTERM, SIGHUP, `rosnode kill` and a node of the
/// same name that starts end it in this order: the node stops, forces at zero first; all threads
/// give SCHED_FIFO up; the node is destroyed; roscpp shuts down. Left to itself roscpp disables its
/// queue of callbacks first and waits for the master, while its threads look into that queue again
/// and again: with SCHED_FIFO these keep the processors from everybody. All of that has 10 s
/// (limitEnding()).
///
/// @param make the node; may throw what is wrong with its parameters, or that it has nothing to do.
///   That is said on the console. With the parameter ~stay, which launch files set for nodes that
///   they respawn after a crash, the process then waits to be ended: what was refused would be
///   refused again.
/// @returns the status to exit with: 0, or 1 if `make` threw
int runNode(int argc, char** argv, const ProcessTraits& traits,
            const std::function<RunningNode()>& make);

/// The same for a class with the constructor Node(node handle, private node handle) and stop().
template <typename Node>
int runNode(int argc, char** argv, const ProcessTraits& traits) {
  return runNode(argc, argv, traits, [] {
    const auto node = std::make_shared<Node>(ros::NodeHandle(), ros::NodeHandle("~"));
    return RunningNode{node, [node] { node->stop(); }};
  });
}

}  // namespace haptex::nodes
