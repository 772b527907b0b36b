#include "haptex/nodes/tactile_driver/tactile_driver_node.h"

#include <memory>

#include "haptex/base/quoted.h"
#include "haptex/nodes/common/config_files.h"
#include "haptex/nodes/common/driver_messages.h"
#include "haptex/nodes/common/node_parameters.h"
#include "haptex/nodes/tactile_driver/array_messages.h"
#include "haptex/nodes/wire/frame_names.h"
#include "haptex/realtime/steady_clock.h"
#include "haptex/serial/port_keeper.h"

namespace haptex::nodes {
namespace {

using base::Finger;
using base::kFingers;
using base::Time;

constexpr char kCalibrationDirectory[] = "tactile";
constexpr char kDefaultCalibration[] = "representative";
constexpr Time kStatePeriod = std::chrono::seconds(1);

}  // namespace

tactile::Calibration readCalibration(const ros::NodeHandle& private_node) {
  return tactile::loadCalibration(
      private_node.hasParam("calibration")
          ? readConfigPath(private_node, "calibration", kCalibrationDirectory)
          : findConfigFile(kCalibrationDirectory, kDefaultCalibration));
}

TactileDriverParameters TactileDriverParameters::read(const ros::NodeHandle& private_node) {
  return {readPort(private_node, "port", "the path of a serial port, for example /dev/ttyUSB1"),
          readCalibration(private_node)};
}

TactileDriverNode::TactileDriverNode(const ros::NodeHandle& node,
                                     const ros::NodeHandle& private_node)
    : TactileDriverNode(node, private_node, TactileDriverParameters::read(private_node)) {}

TactileDriverNode::TactileDriverNode(const ros::NodeHandle& node,
                                     const ros::NodeHandle& private_node,
                                     const TactileDriverParameters& parameters)
    : node_(node),
      driver_(std::make_unique<serial::PortKeeper>(parameters.port), parameters.calibration),
      diagnostics_(node, private_node) {
  state_publisher_ = node_.advertise<haptex::ArrayState>(
      "tactile/array_state", 1, ros::SubscriberStatusCallback(),
      [this](const ros::SingleSubscriberPublisher& subscriber) { subscriberGone(subscriber); },
      ros::VoidConstPtr(), true);
  for (const Finger finger : kFingers) {
    using Event = const ros::MessageEvent<haptex::Tactile const>&;
    const boost::function<void(Event)> take = [this, finger](Event event) {
      receive(finger, *event.getConstMessage(), event.getPublisherName());
    };
    // Only the latest amplitudes count.
    subscribers_[finger] = node_.subscribe<haptex::Tactile, Event>(
        std::string(base::name(finger)) + "/tactile", 1, take, ros::VoidConstPtr(),
        ros::TransportHints().tcpNoDelay());
  }
  tick_timer_ = node_.createSteadyTimer(ros::WallDuration(base::seconds(tactile::kDrivePeriod)),
                                        [this](const ros::SteadyTimerEvent&) { tick(); });
  addDiagnostics();
}

void TactileDriverNode::stop() {
  tick_timer_.stop();
  for (const Finger finger : kFingers) {
    subscribers_[finger].shutdown();
    driver_.sourceDied(finger);
  }
  driver_.tick(realtime::steadyNow());  // says zero; the electronics' watchdog would later
}

void TactileDriverNode::receive(Finger finger, const haptex::Tactile& message,
                                const std::string& source) {
  inputs_[finger].count(std::string(base::name(finger)) + "/tactile", [&] {
    driver_.receive(finger, amplitudesIn(finger, message), realtime::steadyNow());
    sources_.commanded(finger, source);
  });
}

void TactileDriverNode::subscriberGone(const ros::SingleSubscriberPublisher& subscriber) {
  const std::string node = subscriber.getSubscriberName();
  for (const Finger finger : kFingers) {
    if (!sources_.hasDied(finger, node)) continue;
    driver_.sourceDied(finger);
    ++source_deaths_;
    ROS_WARN("%s, which drove the contactors of the %s, has gone: they rest",
             base::shortened(node).c_str(), base::name(finger));
  }
}

void TactileDriverNode::tick() {
  driver_.tick(realtime::steadyNow());
  publishState();
}

std::string TactileDriverNode::whyNoElectronics() const {
  const tactile::DriverStatus& now = driver_.status();
  if (now.link == serial::LinkStatus::kConnected) return "";
  const std::string trouble = driver_.portTrouble();
  return trouble.empty() ? driver_.port() + ": " + serial::describe(now.link) : trouble;
}

void TactileDriverNode::publishState() {
  const Time now = realtime::steadyNow();
  const bool connected = driver_.status().link == serial::LinkStatus::kConnected;
  const std::string message = connected ? "connected to the drive electronics" : whyNoElectronics();
  if (message == published_message_ && now < state_due_) return;
  if (message != published_message_) ROS_INFO("%s", message.c_str());
  published_message_ = message;
  state_due_ = now + kStatePeriod;
  haptex::ArrayState state;
  state.header.stamp = ros::Time::now();
  state.header.frame_id = handFrame();
  state.connected = static_cast<std::uint8_t>(connected);
  state.message = message;
  state_publisher_.publish(state);
}

}  // namespace haptex::nodes
