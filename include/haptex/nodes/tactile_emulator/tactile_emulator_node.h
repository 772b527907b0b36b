// The node tactile_emulator: parameters, topics, service and diagnostics of the emulated drive
// electronics of the contactors.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <haptex/InjectFault.h>
#include <haptex/Tactile.h>
#include <ros/ros.h>

#include <cstdint>
#include <optional>
#include <string>

#include "haptex/base/finger.h"
#include "haptex/tactile/drive/calibration.h"
#include "haptex/tactile/drive/emulated_electronics.h"

namespace haptex::nodes {

/// Parameters of the node, read once at the start.
struct TactileEmulatorParameters {
  std::string link;  ///< ~link: where the symbolic link to the emulator's port is made
  tactile::Calibration calibration;  ///< ~calibration, as of tactile_driver
  /// ~sound (path of a WAV file), ~sound_finger (default index), ~sound_contactor (default
  /// kMiddleContactor); nothing if ~sound is empty or not set
  std::optional<tactile::PlayedContactor> played;

  /// @throws std::exception naming the parameter or file, the value and what is allowed
  static TactileEmulatorParameters read(const ros::NodeHandle& private_node);
};

/// Below the namespace of `node`: advertises tactile_emulator/<finger>/displayed (Tactile, what the
/// contactors do, for subscribers only, once per kDrivePeriod) and the service
/// tactile_emulator/inject_fault (srv/InjectFault). All runs on the one thread that spins.
class TactileEmulatorNode {
 public:
  /// @throws std::exception with a message naming what was wrong with a parameter, file or port
  TactileEmulatorNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

  /// Ends the electronics. Afterwards only to be destroyed.
  void stop() { step_timer_.stop(); }

 private:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  TactileEmulatorNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                      const TactileEmulatorParameters& parameters);

  void step();
  void publishDisplayed(base::Time now);
  bool injectFault(haptex::InjectFault::Request& request, haptex::InjectFault::Response& response);
  void diagnose(Status& status);

  ros::NodeHandle node_;
  std::string link_;
  std::string sound_path_;
  tactile::EmulatedElectronics electronics_;
  base::PerFinger<ros::Publisher> publishers_;
  base::PerFinger<haptex::Tactile> messages_;
  base::Time displayed_due_{0};
  ros::ServiceServer fault_service_;
  ros::SteadyTimer step_timer_;
  diagnostic_updater::Updater diagnostics_;
  ros::SteadyTimer diagnostics_timer_;
};

}  // namespace haptex::nodes
