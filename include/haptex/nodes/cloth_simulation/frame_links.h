// Frames of tf that carry particles of the cloth, and the cloth's reaction on them.
#pragma once

#include <ros/ros.h>
#include <std_msgs/Header.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "haptex/cloth/dynamics/forces_once.h"
#include "haptex/nodes/common/input_count.h"
#include "haptex/simulation/frame_follower.h"
#include "haptex/simulation/simulated_cloth.h"

namespace haptex::nodes {

/// A frame that carries particles, for diagnostics.
struct FrameStatus {
  std::string name;
  bool known = false;  ///< tf has told its pose
  double age = 0.0;    ///< s, of the last pose; 0 of a static transform
  InputStatus poses;   ///< that tf has told
};

/// Lets the frames of a simulated cloth follow tf, and publishes per frame
///   cloth/frames/<name> (geometry_msgs/WrenchStamped): what the cloth does to the frame, in its
///   axes and about its origin.
/// A frame that tf does not tell stays where it is, and so does one whose pose is refused, which is
/// counted (simulation::requireFramePose()). Without frames nothing listens to tf.
class FrameLinks {
 public:
  explicit FrameLinks(const ros::NodeHandle& node) : node_(node) {}

  /// Before a step; by the simulation's thread.
  void follow(simulation::SimulatedCloth& simulation);
  /// After one; likewise. Computes nothing without subscribers. @param forces of its state
  void publish(const simulation::SimulatedCloth& simulation, const ros::Time& stamp,
               cloth::ForcesOnce& forces);

  /// Where a frame is now, in fixedFrame(). Waits up to kPatience if tf does not tell yet.
  /// @throws std::invalid_argument naming the frame and what is wrong with it
  Eigen::Isometry3d poseOf(const std_msgs::Header& header);

  std::vector<FrameStatus> status() const;

  static constexpr double kPatience = 1.0;  ///< s

 private:
  struct Followed {
    simulation::FrameFollower follower;
    ros::Time stamp;  // of the last pose
    bool known = false;
    InputCount poses;
  };

  const tf2_ros::Buffer& transforms();
  void receive(const std::string& name, Followed& followed);

  ros::NodeHandle node_;
  mutable std::mutex mutex_;  // guards what follows
  std::unique_ptr<tf2_ros::Buffer> buffer_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
  std::map<std::string, Followed> followed_;
  // By the simulation's thread only.
  std::map<std::string, ros::Publisher> publishers_;
};

}  // namespace haptex::nodes
