// Which node commands a finger, and whether it has died. Knows no ROS and reads no clock.
#pragma once

#include <string>

#include "haptex/exoskeleton/finger.h"

namespace haptex::exoskeleton {

/// Silence does not tell a dead commander from a late message, but its connections do: the system
/// closes those of a process that has died at once. A subscription does not show that (roscpp goes
/// on trying to reach its publisher), but the commander's own subscription to what the driver
/// measures does: roscpp tells when a subscriber has gone. A commander that does not subscribe, and
/// one that only stands still, are known by their silence.
///
/// Not thread-safe; allocates when another node commands only.
class CommanderWatch {
 public:
  /// This node has commanded the finger.
  void commanded(Finger finger, const std::string& node) {
    if (commanders_[finger] != node) commanders_[finger] = node;
  }

  /// Whether this node is the one that commanded the finger last.
  bool commands(Finger finger, const std::string& node) const {
    return commanders_[finger] == node;
  }

  /// This node's subscription to what is measured of some finger has ended.
  /// @returns whether it is the one that has commanded this finger, said once
  bool hasDied(Finger finger, const std::string& node) {
    if (node.empty() || commanders_[finger] != node) return false;
    commanders_[finger].clear();
    return true;
  }

 private:
  PerFinger<std::string> commanders_;
};

}  // namespace haptex::exoskeleton
