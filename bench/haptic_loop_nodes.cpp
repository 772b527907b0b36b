// The way from the device's position to its force through the real nodes.
// bench/haptic_loop_nodes.launch starts them; the emulated hand pinches, lifts and moves wool.
#include <geometry_msgs/PoseStamped.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/ServoForce.h"
#include "haptex/nodes/scheduling.h"
#include "tab_lines.h"

namespace {

using haptex::bench::printLine;

constexpr std::size_t kSamples = 8000;
constexpr double kPatience = 90.0;   // s, for all of them
constexpr double kSamePlace = 1e-9;  // m: the force is for this measured position
constexpr std::size_t kRemembered = 200;
// A state of 50 bytes and a command of 20 bytes at 921600 baud (docs/serial_protocol.md).
constexpr double kLine = 0.54e-3 + 0.22e-3;  // s

/// Follows measured positions of one finger to the forces that are computed from them, and on to
/// the driver's next tick, which renders them.
class Chain {
 public:
  Chain(ros::NodeHandle& node, const std::string& finger)
      : poses_(node.subscribe(finger + "/measured_cp", 100, &Chain::takePose, this,
                              ros::TransportHints().tcpNoDelay())),
        forces_(node.subscribe(finger + "/servo_cf", 100, &Chain::takeForce, this,
                               ros::TransportHints().tcpNoDelay())) {}

  std::vector<double> to_force;  // s, from the position's stamp to the force's arrival
  std::vector<double>
      to_device;  // s, and on to the driver's next tick, both ways on the line with it

 private:
  void takePose(const geometry_msgs::PoseStamped& message) {
    const ros::Time now = ros::Time::now();
    for (const ros::Time& measured : waiting_) {
      to_device.push_back((now - measured).toSec() + kLine);
    }
    waiting_.clear();
    poses_seen_.push_back(message);
    if (poses_seen_.size() > kRemembered) poses_seen_.pop_front();
  }

  void takeForce(const haptex::ServoForce& message) {
    const auto& force = message.force;
    if (force.x == 0.0 && force.y == 0.0 && force.z == 0.0) return;
    for (auto pose = poses_seen_.rbegin(); pose != poses_seen_.rend(); ++pose) {
      const auto& place = pose->pose.position;
      const double distance = std::hypot(place.x - message.position.x, place.y - message.position.y,
                                         place.z - message.position.z);
      if (distance > kSamePlace) continue;
      to_force.push_back((ros::Time::now() - pose->header.stamp).toSec());
      waiting_.push_back(pose->header.stamp);
      return;
    }
  }

  std::deque<geometry_msgs::PoseStamped> poses_seen_;
  std::vector<ros::Time> waiting_;
  ros::Subscriber poses_, forces_;
};

void print(const std::string& name, std::vector<double> times) {
  std::sort(times.begin(), times.end());
  const auto quantile = [&](double share) {
    return 1e3 * times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
  };
  const std::string prefix = "haptic_loop/nodes/" + name;
  printLine(prefix + "/p50", quantile(0.5), "ms");
  printLine(prefix + "/p99", quantile(0.99), "ms");
  printLine(prefix + "/p999", quantile(0.999), "ms");
  printLine(prefix + "/max", quantile(1.0), "ms");
}

void run() {
  ros::NodeHandle node("haptex");
  Chain chain(node, "index");
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(kPatience);
  while (chain.to_device.size() < kSamples && ros::ok() && ros::WallTime::now() < deadline) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
  }
  if (chain.to_device.size() < kSamples / 2) {
    throw std::runtime_error("only " + std::to_string(chain.to_device.size()) +
                             " forces came: bench/haptic_loop_nodes.launch starts the nodes");
  }
  print("position_to_force", chain.to_force);
  print("device_to_device", chain.to_device);
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "bench_haptic_loop_nodes");
  // Information goes to standard output, which is for the lines only.
  ros::console::set_logger_level(ROSCONSOLE_ROOT_LOGGER_NAME, ros::console::levels::Warn);
  try {
    run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_haptic_loop_nodes: %s\n", error.what());
    return 1;
  }
  return 0;
}
