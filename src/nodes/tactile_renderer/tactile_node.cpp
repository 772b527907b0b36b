#include "haptex/nodes/tactile_renderer/tactile_node.h"

#include <algorithm>
#include <stdexcept>

#include "haptex/nodes/common/node_parameters.h"
#include "haptex/nodes/common/service_answer.h"
#include "haptex/nodes/wire/checked_topics.h"
#include "haptex/realtime/steady_clock.h"
#include "haptex/scene/scene.h"
#include "haptex/tactile/drive_waveform.h"

namespace haptex::nodes {
namespace {

using base::Finger;
using base::kFingers;
using base::Time;

constexpr std::uint32_t kContactQueue = 25;  // messages at 1 kHz: those of one step
constexpr std::uint32_t kTactileQueue = 2;
constexpr double kMarkerPeriod = 2 * tactile::kTactileStep;  // s

tactile::ArrayLimits readLimits(const ros::NodeHandle& private_node) {
  tactile::ArrayLimits limits;
  limits.lowest_frequency = readPositive(private_node, "lowest_frequency", limits.lowest_frequency);
  limits.highest_frequency =
      readPositive(private_node, "highest_frequency", limits.highest_frequency);
  limits.largest_displacement =
      readPositive(private_node, "largest_displacement", limits.largest_displacement);
  try {
    tactile::requireSound(limits);
  } catch (const std::invalid_argument& error) {  // which only the order of the two can cause
    throw std::invalid_argument("parameter " + private_node.resolveName("highest_frequency") +
                                ": " + error.what());
  }
  return limits;
}

std::string topic(Finger finger, const char* of_finger) {
  return std::string(base::name(finger)) + "/" + of_finger;
}

}  // namespace

TactileParameters TactileParameters::read(const ros::NodeHandle& private_node) {
  TactileParameters parameters;
  parameters.limits = readLimits(private_node);
  if (private_node.hasParam("scene")) {
    const std::string path = readScenePath(private_node);
    const scene::Scene scene = scene::loadScene(path);
    requireListed(path, scene.tactile, "tactile", "tactile_renderer");
    parameters.scene_fabric = scene.fabric_path;
  }
  return parameters;
}

TactileNode::TactileNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : TactileNode(node, private_node, TactileParameters::read(private_node)) {}

TactileNode::TactileNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                         const TactileParameters& parameters)
    : node_(node),
      choice_(parameters.scene_fabric),
      loop_(parameters.limits),
      diagnostics_(node, private_node) {
  for (const Finger finger : kFingers) {
    publishers_[finger] = node_.advertise<haptex::Tactile>(topic(finger, "tactile"), kTactileQueue);
  }
  marker_publisher_ = node_.advertise<visualization_msgs::MarkerArray>("tactile/markers", 2);
  subscribe();
  service_ = node_.advertiseService("tactile/set_surface", &TactileNode::setSurface, this);
  step_timer_ = node_.createSteadyTimer(ros::WallDuration(tactile::kTactileStep),
                                        [this](const ros::SteadyTimerEvent&) { step(); });
  marker_timer_ = node_.createSteadyTimer(
      ros::WallDuration(kMarkerPeriod), [this](const ros::SteadyTimerEvent&) { publishMarkers(); });
  addDiagnostics();
}

void TactileNode::subscribe() {
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  for (const Finger finger : kFingers) {
    const boost::function<void(const haptex::Contact&)> take =
        [this, finger](const haptex::Contact& message) {
          loop_.receive(finger, message, realtime::steadyNow());
        };
    subscribers_[finger] = node_.subscribe<haptex::Contact>(topic(finger, "contact"), kContactQueue,
                                                            take, ros::VoidConstPtr(), hints);
  }
  const boost::function<void(const haptex::ClothMesh&)> take_mesh =
      [this](const haptex::ClothMesh& message) { receiveMesh(message); };
  mesh_subscriber_ = subscribeChecked(node_, "cloth/mesh", 1, take_mesh);
  const boost::function<void(const haptex::ArrayState&)> take_array =
      [this](const haptex::ArrayState& message) { array_message_ = message.message; };
  array_subscriber_ = node_.subscribe<haptex::ArrayState>("tactile/array_state", 1, take_array);
}

void TactileNode::receiveMesh(const haptex::ClothMesh& message) {
  if (choice_.receiveCloth(message) && !choice_.trouble().empty()) {
    ROS_WARN("The contactors are silent: %s", choice_.trouble().c_str());
  }
}

bool TactileNode::setSurface(haptex::SetSurface::Request& request,
                             haptex::SetSurface::Response& response) {
  return answer("set_surface", response, [&] {
    choice_.ask(request.fabric);
    return "the surface is that of " + choice_.fabric();
  });
}

void TactileNode::step() {
  const Time begin = realtime::steadyNow();
  // For nobody it is as without a surface: contacts are taken, and nothing is computed.
  base::PerFinger<const tactile::Surface*> surfaces{};
  if (isWatched()) {
    for (const Finger finger : kFingers) surfaces[finger] = choice_.surface(loop_.fabric(finger));
  }
  loop_.step(surfaces, begin, ros::Time::now());
  for (const Finger finger : kFingers) {
    if (publishers_[finger].getNumSubscribers() == 0) continue;
    publishers_[finger].publish(loop_.messages()[finger]);
  }
  computing_times_.add(realtime::steadyNow() - begin);
}

bool TactileNode::isWatched() const {
  return marker_publisher_.getNumSubscribers() > 0 ||
         std::any_of(kFingers.begin(), kFingers.end(),
                     [this](Finger finger) { return publishers_[finger].getNumSubscribers() > 0; });
}

void TactileNode::publishMarkers() {
  const double rate = rate_.update(loop_.steps(), realtime::steadyNow());
  if (marker_publisher_.getNumSubscribers() == 0) return;
  marker_publisher_.publish(markers_.update(loop_.messages(), rate, ros::Time::now()));
}

}  // namespace haptex::nodes
