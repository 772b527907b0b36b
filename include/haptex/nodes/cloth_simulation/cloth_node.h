// The node cloth_simulation: parameters, topics, services and diagnostics of a simulated cloth.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <dynamic_reconfigure/server.h>
#include <haptex/AttachParticles.h>
#include <haptex/ClothConfig.h>
#include <haptex/ClothState.h>
#include <haptex/GetJacobian.h>
#include <haptex/MoveParticles.h>
#include <haptex/QueryBudget.h>
#include <haptex/ReleaseParticles.h>
#include <haptex/SaveState.h>
#include <haptex/SelectFasteners.h>
#include <haptex/SelectParticles.h>
#include <haptex/SetFabric.h>
#include <haptex/SetProperties.h>
#include <haptex/SetQuality.h>
#include <haptex/SetSheet.h>
#include <haptex/SetState.h>
#include <haptex/StepCloth.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <Eigen/Core>
#include <atomic>
#include <boost/thread/recursive_mutex.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "haptex/nodes/cloth_simulation/cloth_markers.h"
#include "haptex/nodes/cloth_simulation/contact_input.h"
#include "haptex/nodes/cloth_simulation/external_force_input.h"
#include "haptex/nodes/cloth_simulation/fastener_topics.h"
#include "haptex/nodes/cloth_simulation/frame_links.h"
#include "haptex/nodes/cloth_simulation/heartbeat.h"
#include "haptex/nodes/cloth_simulation/runtime_quality.h"
#include "haptex/scene/scene.h"
#include "haptex/simulation/real_time_loop.h"

namespace haptex::nodes {

/// Parameters of the node, read once at the start.
struct ClothNodeParameters {
  std::string scene_path;     ///< ~scene: path of a scene file, or a name in config/scenes
  double state_rate = 0.0;    ///< ~state_rate: Hz of simulated time; 0, the default: every step
  double marker_rate = 0.0;   ///< ~marker_rate: Hz of simulated time, default 25
  double strain_scale = 0.0;  ///< ~strain_scale: strain with the last colour, default 0.01
  ClothColours colour_by = ClothColours::kStrain;  ///< ~colour_by: strain, the default, or fabric
  QualityRequest quality;  ///< ~quality, ~budget_ms; by default the scene's own settings,
                           ///< which ~quality = scene with a budget lets be reduced

  /// Rates are rounded to whole numbers of steps between two messages.
  /// @throws std::invalid_argument naming the parameter, its value and what is allowed
  static ClothNodeParameters read(const ros::NodeHandle& private_node);
};

/// Advertises, below the namespace of `node`:
///   cloth/mesh (ClothMesh, latched), cloth/state (ClothState),
///   cloth/markers and cloth/obstacle_markers, of those that move
///   (visualization_msgs/MarkerArray), each filled only for subscribers, and while
///   the simulation is paused or its steps are rejected ten times a second;
///   cloth/heartbeat (std_msgs/Header, 200 Hz), whether it is paused or not;
///   cloth/quality (ClothQuality, latched), with ~quality or ~budget_ms;
///   cloth/frames/<name> (geometry_msgs/WrenchStamped) of each frame that carries particles;
///   cloth/fasteners and cloth/fastener_events, in a scene with fasteners (FastenerTopics);
///   services cloth/reset (std_srvs/Trigger), cloth/pause (std_srvs/SetBool), cloth/step,
///   cloth/set_fabric, cloth/attach, cloth/move, cloth/release, cloth/fasten, cloth/unfasten,
///   cloth/get_jacobian, cloth/query_budget, cloth/set_quality, cloth/set_state, cloth/save_state,
///   cloth/set_sheet, cloth/set_properties (srv/). By dynamic_reconfigure the same properties can
///   be set (cfg/Cloth.cfg), which begin with the scene's.
/// It subscribes to cloth/external_forces (ExternalForces; simulation::ForceSources). In a scene
/// with fingers it subscribes to cloth/contact_forces (ContactForces), which act for
/// NewestLoads::kLifetime.
/// A refused request is answered with success = false and changes nothing. The services may be
/// called from several threads at once.
class ClothNode {
 public:
  /// Starts simulating.
  /// @throws std::exception with a message naming what was wrong with a parameter or a file
  ClothNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

  /// Ends the simulation; services that wait for it return. Afterwards only to be destroyed.
  void stop() { loop_.stop(); }

 private:
  ClothNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
            const ClothNodeParameters& parameters);
  ClothNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
            const ClothNodeParameters& parameters, const std::optional<RuntimeQuality>& quality);
  ClothNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
            const ClothNodeParameters& parameters, const std::optional<RuntimeQuality>& quality,
            const scene::Scene& scene);

  void advertiseTopics();
  void advertiseServices();
  void publishMesh(const cloth::Cloth& cloth);
  void publishStep(const simulation::SimulatedCloth& simulation, double until_next);
  void publishState(const simulation::SimulatedCloth& simulation, double until_next,
                    cloth::ForcesOnce& forces);
  void republishIfResting();
  void publishQuality(const simulation::SimulatedCloth& simulation);
  void publishQualityIfDue(const simulation::SimulatedCloth& simulation);
  void takeForces(simulation::SimulatedCloth& simulation);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);
  void diagnoseFrames(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void diagnoseQuality(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  bool reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response);
  bool pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool step(StepCloth::Request& request, StepCloth::Response& response);
  bool setFabric(SetFabric::Request& request, SetFabric::Response& response);
  bool setSheet(SetSheet::Request& request, SetSheet::Response& response);
  bool setProperties(SetProperties::Request& request, SetProperties::Response& response);
  void offerProperties(const ros::NodeHandle& private_node);
  void apply(const haptex::ClothConfig& properties);
  void exchange(simulation::SimulatedCloth next, const scene::Scene& scene);
  bool attach(AttachParticles::Request& request, AttachParticles::Response& response);
  bool move(MoveParticles::Request& request, MoveParticles::Response& response);
  bool release(ReleaseParticles::Request& request, ReleaseParticles::Response& response);
  bool fasten(SelectFasteners::Request& request, SelectFasteners::Response& response);
  bool unfasten(SelectFasteners::Request& request, SelectFasteners::Response& response);
  using ChangeFasteners = void (simulation::SimulatedCloth::*)(const std::vector<std::string>&);
  bool changeFasteners(const char* service, ChangeFasteners change,
                       const SelectFasteners::Request& request,
                       SelectFasteners::Response& response);
  bool exclude(SelectParticles::Request& request, SelectParticles::Response& response);
  bool include(SelectParticles::Request& request, SelectParticles::Response& response);
  bool getJacobian(GetJacobian::Request& request, GetJacobian::Response& response);
  bool setState(SetState::Request& request, SetState::Response& response);
  bool saveState(SaveState::Request& request, SaveState::Response& response);
  void requireQuality() const;
  bool setQuality(SetQuality::Request& request, SetQuality::Response& response);
  bool queryBudget(QueryBudget::Request& request, QueryBudget::Response& response);

  ros::NodeHandle node_;
  std::vector<ros::ServiceServer> services_;
  ros::Publisher mesh_publisher_;
  ros::Publisher state_publisher_;
  ros::Publisher marker_publisher_;
  ros::Publisher obstacle_publisher_;
  ros::Publisher quality_publisher_;
  diagnostic_updater::Updater diagnostics_;
  ros::SteadyTimer diagnostics_timer_;
  ros::SteadyTimer rest_timer_;
  double diagnosed_drop_ = 0.0;  // s of simulated time, at the last diagnostics

  // Used by the loop's thread only.
  std::uint64_t steps_per_state_;
  std::uint64_t steps_per_markers_;
  ClothMarkers markers_;
  std::uint32_t mesh_ = 0;  // its number
  haptex::ClothState state_message_;
  std::vector<Eigen::Vector3d> forces_;  // N, buffer
  ros::Time state_stamp_;
  std::uint64_t stamped_step_ = 0;
  // SimulatedCloth::computedSteps() in state_message_; nothing: it is of no state of this cloth.
  std::optional<std::uint64_t> filled_step_;
  std::vector<cloth::PointLoad> loads_;
  std::size_t published_changes_ = 0;  // of the quality
  base::Time quality_due_{0};          // when its message is published without a change

  mutable std::mutex quality_mutex_;
  haptex::ClothQuality quality_message_;  // the last; guarded by quality_mutex_

  std::optional<RuntimeQuality> quality_;  // changed by the loop's thread only

  // Constant.
  double time_step_;  // s
  double tolerance_;
  std::string scene_path_;
  double strain_scale_;
  ClothColours colour_by_;

  std::atomic<std::size_t> particle_count_;
  std::atomic<std::size_t> triangle_count_;

  ExternalForceInput force_input_;
  std::unique_ptr<ContactInput> contact_input_;  // null in a scene without fingers
  FrameLinks frames_;
  FastenerTopics fasteners_;
  Heartbeat heartbeat_;

  simulation::RealTimeLoop loop_;  // its thread uses the members above

  // One change of fabrics, properties or sheet at a time.
  boost::recursive_mutex changing_;
  std::vector<material::Fabric> fabrics_;  // as their files say, without factors; guarded by it
  haptex::ClothConfig properties_;         // that act; likewise, changed by the loop's thread
  std::unique_ptr<dynamic_reconfigure::Server<haptex::ClothConfig>> reconfigure_;  // likewise
};

}  // namespace haptex::nodes
