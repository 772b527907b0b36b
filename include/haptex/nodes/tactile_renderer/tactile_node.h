// The node tactile_renderer: parameters, topics, service and diagnostics of what the contactors of
// the tactile arrays do.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <haptex/ArrayState.h>
#include <haptex/ClothMesh.h>
#include <haptex/Contact.h>
#include <haptex/SetSurface.h>
#include <ros/ros.h>

#include <cstdint>
#include <string>

#include "haptex/base/finger.h"
#include "haptex/nodes/tactile_renderer/surface_choice.h"
#include "haptex/nodes/tactile_renderer/tactile_loop.h"
#include "haptex/nodes/tactile_renderer/tactile_markers.h"
#include "haptex/realtime/duration_histogram.h"
#include "haptex/realtime/rate_meter.h"

namespace haptex::nodes {

/// Parameters of the node, read once at the start.
struct TactileParameters {
  std::string scene_fabric;  ///< path, of ~scene, as of cloth_simulation; empty if not set
  /// ~lowest_frequency, ~highest_frequency (Hz), ~largest_displacement (m); defaults of ArrayLimits
  tactile::ArrayLimits limits;

  /// @throws std::exception naming the parameter or file, the value and what is allowed
  static TactileParameters read(const ros::NodeHandle& private_node);
};

/// Below the namespace of `node`: subscribes to <finger>/contact of each finger, and to cloth/mesh
/// for the name of the cloth's fabric, and to tactile/array_state (ArrayState), by which the driver
/// of the contactors sees at once when this node has died; advertises <finger>/tactile (Tactile)
/// every tactile::kTactileStep, whatever comes in, tactile/markers
/// (visualization_msgs/MarkerArray), for subscribers only, and the service tactile/set_surface
/// (SetSurface).
///
/// All runs on the one thread that spins. Reading another surface delays a step by as long as it
/// takes.
class TactileNode {
 public:
  /// @throws std::exception with a message naming what was wrong with a parameter or a file
  TactileNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

  /// No more steps. Afterwards only to be destroyed.
  void stop() { step_timer_.stop(); }

 private:
  using Finger = base::Finger;
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  TactileNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
              const TactileParameters& parameters);

  void subscribe();
  void receiveMesh(const haptex::ClothMesh& message);
  bool setSurface(haptex::SetSurface::Request& request, haptex::SetSurface::Response& response);
  void step();
  bool isWatched() const;  // whether anybody looks at what is computed
  void publishMarkers();

  void addDiagnostics();
  void diagnoseSurface(Status& status);
  void diagnoseSteps(Status& status);
  void diagnoseArray(Finger finger, Status& status);

  ros::NodeHandle node_;
  SurfaceChoice choice_;
  TactileLoop loop_;
  base::PerFinger<ros::Publisher> publishers_;
  base::PerFinger<ros::Subscriber> subscribers_;
  ros::Subscriber mesh_subscriber_;
  ros::Subscriber array_subscriber_;
  std::string array_message_ = "no tactile_driver";  // what the driver of the contactors says
  ros::ServiceServer service_;
  ros::SteadyTimer step_timer_;

  ros::Publisher marker_publisher_;
  TactileMarkers markers_;
  realtime::RateMeter rate_;
  ros::SteadyTimer marker_timer_;

  diagnostic_updater::Updater diagnostics_;
  realtime::DurationHistogram computing_times_;
  realtime::DurationHistogram::Counts diagnosed_times_;
  std::uint64_t diagnosed_steps_ = 0;
  base::PerFinger<std::uint64_t> diagnosed_drops_;
  ros::SteadyTimer diagnostics_timer_;
};

}  // namespace haptex::nodes
