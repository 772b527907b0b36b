// The node tactile_driver: parameters, topics and diagnostics of the drive electronics of the
// contactors.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <haptex/ArrayState.h>
#include <haptex/Tactile.h>
#include <ros/ros.h>

#include <cstdint>
#include <string>

#include "haptex/base/finger.h"
#include "haptex/exoskeleton/driver/commander_watch.h"
#include "haptex/nodes/common/input_count.h"
#include "haptex/tactile/drive/array_driver.h"
#include "haptex/tactile/drive/calibration.h"

namespace haptex::nodes {

/// Parameters of the node, read once at the start.
struct TactileDriverParameters {
  std::string port;  ///< ~port: path of a serial port, which need not be there yet
  /// ~calibration: path of a file, or a name in config/tactile; default representative
  tactile::Calibration calibration;

  /// @throws std::exception naming the parameter or file, the value and what is allowed
  static TactileDriverParameters read(const ros::NodeHandle& private_node);
};

/// ~calibration, see TactileDriverParameters. @throws likewise
tactile::Calibration readCalibration(const ros::NodeHandle& private_node);

/// Below the namespace of `node`: subscribes to <finger>/tactile (Tactile) of each finger,
/// advertises tactile/array_state (ArrayState). All runs on the one thread that spins, which waits
/// for nothing.
class TactileDriverNode {
 public:
  /// @throws std::exception with a message naming what was wrong with a parameter or a file
  TactileDriverNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

  /// The contactors rest. Afterwards only to be destroyed.
  void stop();

 private:
  using Finger = base::Finger;
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  TactileDriverNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                    const TactileDriverParameters& parameters);

  void receive(Finger finger, const haptex::Tactile& message, const std::string& source);
  void subscriberGone(const ros::SingleSubscriberPublisher& subscriber);
  void tick();
  void publishState();
  std::string whyNoElectronics() const;  // empty if they are there

  void addDiagnostics();
  void diagnoseLink(Status& status);
  void diagnoseArray(Finger finger, Status& status);

  ros::NodeHandle node_;
  tactile::ArrayDriver driver_;
  exoskeleton::CommanderWatch sources_;
  std::uint64_t source_deaths_ = 0;
  base::PerFinger<InputCount> inputs_;
  ros::Publisher state_publisher_;
  std::string published_message_;
  base::Time state_due_{0};
  base::PerFinger<ros::Subscriber> subscribers_;
  ros::SteadyTimer tick_timer_;

  diagnostic_updater::Updater diagnostics_;
  tactile::DriverStatus diagnosed_;
  base::PerFinger<std::uint64_t> diagnosed_refusals_;
  ros::SteadyTimer diagnostics_timer_;
};

}  // namespace haptex::nodes
