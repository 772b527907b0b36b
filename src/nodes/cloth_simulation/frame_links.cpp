#include "haptex/nodes/cloth_simulation/frame_links.h"

#include <geometry_msgs/WrenchStamped.h>

#include <algorithm>
#include <regex>
#include <stdexcept>

#include "haptex/base/quoted.h"
#include "haptex/nodes/common/ros_time.h"
#include "haptex/nodes/common/transforms.h"
#include "haptex/nodes/common/vector_messages.h"
#include "haptex/nodes/wire/frame_names.h"
#include "haptex/realtime/steady_clock.h"

namespace haptex::nodes {

const tf2_ros::Buffer& FrameLinks::transforms() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!buffer_) {
    buffer_ = std::make_unique<tf2_ros::Buffer>();
    listener_ = std::make_unique<tf2_ros::TransformListener>(*buffer_, node_);
  }
  return *buffer_;
}

void FrameLinks::follow(simulation::SimulatedCloth& simulation) {
  const simulation::CarryingFrames& frames = simulation.frames();
  if (frames.size() == 0) return;
  transforms();
  const std::lock_guard<std::mutex> lock(mutex_);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    Followed& followed = followed_[frames.name(i)];
    receive(frames.name(i), followed);
    if (!followed.known) continue;
    const Eigen::Isometry3d pose = followed.follower.at(realtime::steadyNow()).pose;
    const bool near =
        pose.translation().cwiseAbs().maxCoeff() <= simulation::kMaxCoordinate;  // not for NaN
    if (near && pose.matrix().allFinite()) simulation.moveFrame(i, pose);
  }
}

/// Takes the frame's last pose if it is new.
void FrameLinks::receive(const std::string& name, Followed& followed) {
  const std::string frame = frameCalled(name);
  if (!buffer_->canTransform(fixedFrame(), frame, ros::Time(0))) return;
  geometry_msgs::TransformStamped last;
  try {
    last = buffer_->lookupTransform(fixedFrame(), frame, ros::Time(0));
  } catch (const tf2::TransformException&) {
    return;  // tf has forgotten it since
  }
  if (followed.known && last.header.stamp == followed.stamp) return;
  const base::Time now = realtime::steadyNow();
  const base::Time age =
      last.header.stamp.isZero()
          ? base::Time::zero()  // a static transform
          : std::max(base::Time::zero(), between(last.header.stamp, ros::Time::now()));
  followed.follower.receive(fromMessage(last.transform), now - age, now);
  followed.stamp = last.header.stamp;
  followed.known = true;
}

void FrameLinks::publish(const simulation::SimulatedCloth& simulation, const ros::Time& stamp) {
  const simulation::CarryingFrames& frames = simulation.frames();
  bool computed = false;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    ros::Publisher& publisher = publishers_[frames.name(i)];
    if (!publisher) {
      publisher =
          node_.advertise<geometry_msgs::WrenchStamped>("cloth/frames/" + frames.name(i), 10);
    }
    if (publisher.getNumSubscribers() == 0) continue;
    if (!computed) simulation.cloth().computeForces(simulation.state(), forces_);
    computed = true;
    const simulation::FrameWrench wrench =
        frames.wrench(i, simulation.cloth(), simulation.state(), forces_);
    const Eigen::Matrix3d to_frame = frames.pose(i).linear().transpose();
    geometry_msgs::WrenchStamped message;
    message.header.stamp = stamp;
    message.header.frame_id = frameCalled(frames.name(i));
    message.wrench.force = vectorMessage(to_frame * wrench.force);
    message.wrench.torque = vectorMessage(to_frame * wrench.torque);
    publisher.publish(message);
  }
}

Eigen::Isometry3d FrameLinks::poseOf(const std_msgs::Header& header) {
  const tf2_ros::Buffer& buffer = transforms();
  std_msgs::Header latest = header;
  latest.stamp = ros::Time(0);
  buffer.canTransform(fixedFrame(), header.frame_id, latest.stamp, ros::Duration(kPatience));
  return transformFrom(latest, fixedFrame(), buffer);
}

std::string FrameLinks::nameOf(const std_msgs::Header& header) {
  static const std::regex allowed("[A-Za-z][A-Za-z0-9_]*");
  const std::string& prefix = framePrefix();
  const std::string& frame = header.frame_id;
  const bool sound = frame.size() <= base::kLongestQuote && frame.rfind(prefix, 0) == 0 &&
                     std::regex_match(frame.substr(prefix.size()), allowed);
  if (!sound) {
    throw std::invalid_argument("header.frame_id = " + base::quoted(frame) + ": allowed are '" +
                                fixedFrame() + "', or a frame that carries the particles: '" +
                                prefix + "' and a letter with letters, digits and _");
  }
  return frame.substr(prefix.size());
}

std::vector<FrameStatus> FrameLinks::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<FrameStatus> all;
  for (const auto& [name, followed] : followed_) {
    const bool is_static = followed.stamp.isZero();
    const double age =
        followed.known && !is_static ? (ros::Time::now() - followed.stamp).toSec() : 0.0;
    all.push_back({name, followed.known, age});
  }
  return all;
}

}  // namespace haptex::nodes
