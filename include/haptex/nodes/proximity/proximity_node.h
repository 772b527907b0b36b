// The node proximity: parameters, topics, service and diagnostics of proximity queries.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <dynamic_reconfigure/server.h>
#include <haptex/ClothMesh.h>
#include <haptex/ClothState.h>
#include <haptex/ProximityConfig.h>
#include <haptex/QueryProximity.h>
#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <Eigen/Geometry>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <vector>

#include "haptex/mesh/obstacle.h"
#include "haptex/nodes/common/message_threads.h"
#include "haptex/nodes/proximity/cloth_proximity.h"
#include "haptex/nodes/proximity/proximity_markers.h"

namespace haptex::nodes {

/// Parameters of the node, read once at the start. ~volume_level can be changed while it runs, see
/// cfg/Proximity.cfg.
struct ProximityNodeParameters {
  double stale_after = 0.0;               ///< ~stale_after: s, > 0, default 0.5
  std::vector<mesh::Obstacle> obstacles;  ///< of ~scene, as of cloth_simulation; none if not set

  /// @throws std::exception naming the parameter or file, the value and what is allowed
  static ProximityNodeParameters read(const ros::NodeHandle& private_node);
};

/// Below the namespace of `node`: subscribes to cloth/mesh and cloth/state; advertises the service
/// proximity/query (srv/QueryProximity) and the topic proximity/markers
/// (visualization_msgs/MarkerArray), filled for subscribers only. A query waits neither for a
/// message nor for another connection's query; markers and diagnostics run wherever the caller
/// spins.
class ProximityNode {
 public:
  /// @throws std::exception with a message naming what was wrong with a parameter or a file
  ProximityNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

  /// No more answers. Afterwards only to be destroyed.
  void stop() {
    service_threads_.stop();
    input_thread_.stop();
  }

 private:
  ProximityNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                const ProximityNodeParameters& parameters);

  void receiveMesh(const haptex::ClothMeshConstPtr& message);
  void receiveState(const haptex::ClothStateConstPtr& message);
  bool query(haptex::QueryProximity::Request& request, haptex::QueryProximity::Response& response);
  void publishMarkers();
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  ros::NodeHandle node_;
  MessageThreads input_thread_;     // for mesh and states
  MessageThreads service_threads_;  // for queries
  ClothProximity proximity_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener transform_listener_;

  /// Of an answer.
  struct Shown {
    std::vector<proximity::TaperedCapsule> cursor;  // in the world frame; empty for an obstacle
    std::vector<int> triangles;                     // indices of the elements found
    AnsweredQuery query;
  };

  std::mutex shown_mutex_;      // guards the next
  std::optional<Shown> shown_;  // the last answer while the markers had subscribers
  ProximityMarkers markers_;    // used by the timer only
  std::atomic<int> volume_level_{SceneRequest::kNoLevel};
  std::atomic<bool> tested_volumes_{false};
  dynamic_reconfigure::Server<haptex::ProximityConfig> reconfigure_;

  diagnostic_updater::Updater diagnostics_;  // used by its timer only
  std::uint64_t diagnosed_drops_ = 0;        // likewise

  ros::Publisher marker_publisher_;
  ros::Subscriber mesh_subscriber_;
  ros::Subscriber state_subscriber_;
  ros::ServiceServer query_service_;
  ros::SteadyTimer marker_timer_;
  ros::SteadyTimer diagnostics_timer_;
};

}  // namespace haptex::nodes
