#include "haptex/nodes/cloth_simulation/frame_links.h"

#include <geometry_msgs/WrenchStamped.h>

#include <stdexcept>

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
    if (!followed.follower.knowsPose()) continue;
    try {
      simulation.moveFrame(i, followed.follower.at(realtime::steadyNow()).pose);
    } catch (const std::invalid_argument&) {
      // Extrapolated beyond what is allowed; the pose itself was not, and the next one tells.
    }
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
  followed.stamp = last.header.stamp;
  followed.known = true;
  followed.poses.count("the pose of frame " + frame, [&] {
    const Eigen::Isometry3d pose = fromMessage(last.transform);
    simulation::requireFramePose(name, pose);  // one that is not finite would stay in the motion
    const base::Time now = realtime::steadyNow();
    followed.follower.receive(pose, now - ageOf(followed.stamp), now);
  });
}

void FrameLinks::publish(const simulation::SimulatedCloth& simulation, const ros::Time& stamp,
                         cloth::ForcesOnce& forces) {
  const simulation::CarryingFrames& frames = simulation.frames();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    ros::Publisher& publisher = publishers_[frames.name(i)];
    if (!publisher) {
      publisher =
          node_.advertise<geometry_msgs::WrenchStamped>("cloth/frames/" + frames.name(i), 10);
    }
    if (publisher.getNumSubscribers() == 0) continue;
    const simulation::FrameWrench wrench =
        frames.wrench(i, simulation.cloth(), simulation.state(), forces.get());
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

std::vector<FrameStatus> FrameLinks::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<FrameStatus> all;
  for (const auto& [name, followed] : followed_) {
    const double age = followed.known ? base::seconds(ageOf(followed.stamp)) : 0.0;
    all.push_back({name, followed.known, age, followed.poses.status()});
  }
  return all;
}

}  // namespace haptex::nodes
