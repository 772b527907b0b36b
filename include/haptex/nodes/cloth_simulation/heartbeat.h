// A topic whose silence tells that a process has died.
#pragma once

#include <ros/ros.h>
#include <std_msgs/Header.h>

#include <string>

#include "haptex/realtime/periodic_thread.h"

namespace haptex::nodes {

/// Publishes a std_msgs/Header with the time and fixedFrame() every kPeriod from a thread of its
/// own, whatever the rest of the process does, as long as someone subscribes.
class Heartbeat {
 public:
  static constexpr realtime::PeriodicThread::Time kPeriod = std::chrono::milliseconds(5);

  Heartbeat(const ros::NodeHandle& node, const std::string& topic);

 private:
  void beat();

  ros::Publisher publisher_;
  std_msgs::Header message_;
  realtime::PeriodicThread thread_;  // last: it uses the members above
};

}  // namespace haptex::nodes
