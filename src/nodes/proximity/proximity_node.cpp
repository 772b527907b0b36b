#include "haptex/nodes/proximity/proximity_node.h"

#include <optional>
#include <stdexcept>
#include <string>

#include "haptex/contact/obstacles/obstacles.h"
#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/common/diagnostics_timer.h"
#include "haptex/nodes/common/node_parameters.h"
#include "haptex/nodes/common/transforms.h"
#include "haptex/nodes/wire/checked_topics.h"
#include "haptex/nodes/wire/frame_names.h"
#include "haptex/scene/scene.h"

namespace haptex::nodes {
namespace {

constexpr double kDefaultStaleAfter = 0.5;  // s
constexpr double kMarkerPeriod = 0.1;       // s
constexpr int kServiceThreads = 2;          // for the force renderer, and for others

/// dynamic_reconfigure would silently take another value for one that it does not understand.
void requireVolumeLevel(const ros::NodeHandle& private_node) {
  if (!private_node.hasParam("volume_level")) return;
  const std::string name = "parameter " + private_node.resolveName("volume_level");
  const int least = haptex::ProximityConfig::__getMin__().volume_level;
  const int most = haptex::ProximityConfig::__getMax__().volume_level;
  const std::string allowed =
      "allowed are whole numbers from " + std::to_string(least) + " to " + std::to_string(most);
  XmlRpc::XmlRpcValue value;  // getParam() for an int would round
  if (!private_node.getParam("volume_level", value) ||
      value.getType() != XmlRpc::XmlRpcValue::TypeInt) {
    throw std::invalid_argument(name + " is not a whole number: " + allowed);
  }
  const int level = static_cast<int>(value);
  if (level < least || level > most) {
    throw std::invalid_argument(name + " = " + std::to_string(level) + ": " + allowed);
  }
}

ClothProximity::Obstacles makeObstacles(const std::vector<mesh::Obstacle>& obstacles) {
  ClothProximity::Obstacles made;
  for (const mesh::Obstacle& obstacle : obstacles) {
    made.emplace(obstacle.name, contact::makeObstacle(obstacle));
  }
  return made;
}

std::vector<int> trianglesOf(const haptex::QueryProximity::Response& response) {
  std::vector<int> triangles;
  triangles.reserve(response.elements.size());
  for (const haptex::NearElement& element : response.elements) {
    triangles.push_back(static_cast<int>(element.triangle));
  }
  return triangles;
}

}  // namespace

ProximityNodeParameters ProximityNodeParameters::read(const ros::NodeHandle& private_node) {
  ProximityNodeParameters parameters;
  parameters.stale_after = readPositive(private_node, "stale_after", kDefaultStaleAfter);
  if (private_node.hasParam("scene")) {
    parameters.obstacles = scene::loadScene(readScenePath(private_node)).obstacles;
  }
  requireVolumeLevel(private_node);
  return parameters;
}

ProximityNode::ProximityNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : ProximityNode(node, private_node, ProximityNodeParameters::read(private_node)) {}

ProximityNode::ProximityNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                             const ProximityNodeParameters& parameters)
    : node_(node),
      proximity_(parameters.stale_after, makeObstacles(parameters.obstacles), parameters.obstacles),
      transform_listener_(transforms_),
      markers_(parameters.obstacles),
      reconfigure_(private_node),
      diagnostics_(node, private_node) {
  reconfigure_.setCallback([this](haptex::ProximityConfig& config, std::uint32_t /*level*/) {
    volume_level_ = config.volume_level;
    tested_volumes_ = config.tested_volumes;
  });
  diagnostics_.setHardwareID("none");
  diagnostics_.add(
      "proximity queries",
      [this](diagnostic_updater::DiagnosticStatusWrapper& status) { diagnose(status); });
  marker_publisher_ = node_.advertise<visualization_msgs::MarkerArray>("proximity/markers", 2);
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  ros::NodeHandle input_node = input_thread_.handle(node_);
  const boost::function<void(const haptex::ClothMeshConstPtr&)> take_mesh =
      [this](const haptex::ClothMeshConstPtr& message) { receiveMesh(message); };
  mesh_subscriber_ = subscribeChecked(input_node, "cloth/mesh", 1, take_mesh, hints);
  // Only the latest state counts.
  const boost::function<void(const haptex::ClothStateConstPtr&)> take_state =
      [this](const haptex::ClothStateConstPtr& message) { receiveState(message); };
  state_subscriber_ = subscribeChecked(input_node, "cloth/state", 1, take_state, hints);
  query_service_ = advertiseChecked(service_threads_.handle(node_), "proximity/query",
                                    &ProximityNode::query, this);
  marker_timer_ = node_.createSteadyTimer(
      ros::WallDuration(kMarkerPeriod), [this](const ros::SteadyTimerEvent&) { publishMarkers(); });
  diagnostics_timer_ = publishOnceASecond(node_, diagnostics_);
  input_thread_.start();
  service_threads_.start(kServiceThreads);
}

void ProximityNode::receiveMesh(const haptex::ClothMeshConstPtr& message) {
  proximity_.setMesh(*message);
}

void ProximityNode::receiveState(const haptex::ClothStateConstPtr& message) {
  proximity_.setState(message, ClothProximity::Clock::now());
}

bool ProximityNode::query(haptex::QueryProximity::Request& request,
                          haptex::QueryProximity::Response& response) {
  std::optional<Eigen::Isometry3d> world_from_frame;
  response = proximity_.answer(
      request,
      [&] {
        return *(world_from_frame = transformFrom(request.header, fixedFrame(), transforms_));
      },
      ClothProximity::Clock::now());
  if (!response.success) {
    ROS_WARN_THROTTLE(1.0, "proximity/query refused: %s", response.message.c_str());
  } else if (marker_publisher_.getNumSubscribers() > 0) {
    Shown shown;
    shown.query.request = request;
    if (world_from_frame) shown.query.world_from_frame = *world_from_frame;
    if (request.shape != haptex::QueryProximity::Request::OBSTACLE) {
      shown.cursor = cursorInWorld(request, *world_from_frame).parts();
    }
    shown.triangles = trianglesOf(response);
    const std::lock_guard<std::mutex> lock(shown_mutex_);
    shown_ = std::move(shown);
  }
  return true;
}

void ProximityNode::publishMarkers() {
  if (marker_publisher_.getNumSubscribers() == 0) return;
  std::optional<Shown> shown;
  {
    const std::lock_guard<std::mutex> lock(shown_mutex_);
    shown = shown_;
  }
  SceneRequest request;
  request.level = volume_level_;
  std::vector<proximity::TaperedCapsule> cursor;
  if (shown) {
    request.triangles = std::move(shown->triangles);
    cursor = std::move(shown->cursor);
    if (tested_volumes_) request.tested = std::move(shown->query);
  }
  const auto scene = proximity_.scene(request);
  if (scene) marker_publisher_.publish(markers_.update(*scene, cursor));
}

void ProximityNode::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const ProximityStatus now = proximity_.status(ClothProximity::Clock::now());
  if (!now.trouble.empty()) {
    status.summary(DiagnosticStatus::ERROR, "refuses queries: " + now.trouble);
  } else if (now.dropped > diagnosed_drops_) {
    status.summary(DiagnosticStatus::WARN, "answers queries, but dropped " + now.dropped_why);
  } else {
    status.summary(DiagnosticStatus::OK, "answers queries");
  }
  diagnosed_drops_ = now.dropped;
  status.add("triangles", now.triangles);
  status.add("age of the cloth (s)", now.cloth_age);
  status.add("meshes received", now.meshes);
  status.add("hierarchies built", now.builds);
  status.add("states received", now.states);
  status.add("messages dropped", now.dropped);
  status.add("why the last message was dropped", now.dropped_why);
  status.add("queries answered", now.answered);
  status.add("queries refused", now.refused);
  status.add("why the last query was refused", now.refused_why);
  status.add("refits of the hierarchy", now.refits);
  status.add("computing time of the last refit (ms)", 1e3 * now.refit_seconds);
  status.add("computing time of the last answer (ms)", 1e3 * now.answer_seconds);
}

}  // namespace haptex::nodes
