#include "haptex/nodes/cloth_simulation/heartbeat.h"

#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes {

Heartbeat::Heartbeat(const ros::NodeHandle& node, const std::string& topic)
    : publisher_(ros::NodeHandle(node).advertise<std_msgs::Header>(topic, 1)),
      thread_(kPeriod, [this](realtime::PeriodicThread::Time) { beat(); }) {}

void Heartbeat::beat() {
  if (publisher_.getNumSubscribers() == 0) return;
  message_.frame_id = fixedFrame();
  message_.stamp = ros::Time::now();
  ++message_.seq;
  publisher_.publish(message_);
}

}  // namespace haptex::nodes
