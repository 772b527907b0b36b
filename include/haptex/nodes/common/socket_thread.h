// roscpp's thread that reads and writes the sockets.
#pragma once

namespace haptex::nodes {

/// After ros::start(): roscpp's thread that reads and writes the sockets comes before what is
/// ordinary. Its other threads (services of the graph, console) stay as they are.
void preferMessages(bool on_force_path);

}  // namespace haptex::nodes
