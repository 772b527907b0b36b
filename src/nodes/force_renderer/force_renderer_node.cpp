#include "haptex/nodes/force_renderer/force_renderer_node.h"

#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "haptex/base/quoted.h"
#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/common/driver_messages.h"
#include "haptex/nodes/common/node_parameters.h"
#include "haptex/nodes/common/ros_time.h"
#include "haptex/nodes/common/transforms.h"
#include "haptex/nodes/force_renderer/renderer_messages.h"
#include "haptex/nodes/wire/checked_topics.h"
#include "haptex/nodes/wire/frame_names.h"
#include "haptex/realtime/steady_clock.h"
#include "haptex/scene/scene.h"

namespace haptex::nodes {
namespace {

using base::Finger;
using base::kFingers;
using base::Time;

// Spheres at the ends of the fingers in urdf/hand_exoskeleton.urdf.
constexpr double kIndexRadius = 0.0075;       // m
constexpr double kThumbRadius = 0.009;        // m
constexpr double kMaxRadius = 0.1;            // m
constexpr double kMarkerPeriod = 1.0 / 30.0;  // s
constexpr std::uint32_t kContactQueue = 5;    // messages, for a subscriber that is slow for 20 ms
constexpr int kTicksPerContact = 4;
constexpr std::uint32_t kTransformQueue = 100;  // messages
constexpr int kLastCommands = 5;                // of no force, before the loop ends
/// For them, of a machine whose kernel holds real-time threads back.
constexpr Time kEndPatience = std::chrono::milliseconds(200);
constexpr Time kEndLook = std::chrono::milliseconds(1);
/// Of a transform whose stamp is to be believed.
constexpr Time kOldestTransform = std::chrono::milliseconds(20);

double readRadius(const ros::NodeHandle& private_node, const std::string& name, double fallback) {
  const double radius = readPositive(private_node, name, fallback);
  if (radius <= kMaxRadius) return radius;
  std::ostringstream message;
  message << "parameter " << private_node.resolveName(name) << " = " << radius
          << ": allowed are numbers > 0 and up to " << kMaxRadius << " m";
  throw std::invalid_argument(message.str());
}

base::PerFinger<bool> readFingers(const ros::NodeHandle& private_node) {
  if (!private_node.hasParam("fingers")) return {{true, true}};
  const std::string allowed = "allowed are both, index and thumb";
  const std::string fingers = readText(private_node, "fingers", allowed);
  if (fingers == "both") return {{true, true}};
  base::PerFinger<bool> touches;
  for (const Finger finger : kFingers) touches[finger] = fingers == base::name(finger);
  if (touches[Finger::kIndex] || touches[Finger::kThumb]) return touches;
  throw std::invalid_argument("parameter " + private_node.resolveName("fingers") + " = " +
                              base::quoted(fingers) + ": " + allowed);
}

std::string topic(Finger finger, const char* of_finger) {
  return std::string(base::name(finger)) + "/" + of_finger;
}

}  // namespace

ForceRendererParameters ForceRendererParameters::read(const ros::NodeHandle& private_node) {
  ForceRendererParameters parameters;
  parameters.scene_path = readScenePath(private_node);
  parameters.radii = {{readRadius(private_node, "index_radius", kIndexRadius),
                       readRadius(private_node, "thumb_radius", kThumbRadius)}};
  parameters.touches = readFingers(private_node);
  const scene::Scene scene = scene::loadScene(parameters.scene_path);
  requireListed(parameters.scene_path, scene.fingers, "fingers", "force_renderer");
  parameters.tactile = scene.tactile;
  return parameters;
}

ForceRendererNode::ForceRendererNode(const ros::NodeHandle& node,
                                     const ros::NodeHandle& private_node)
    : ForceRendererNode(node, private_node, ForceRendererParameters::read(private_node)) {}

ForceRendererNode::ForceRendererNode(const ros::NodeHandle& node,
                                     const ros::NodeHandle& private_node,
                                     const ForceRendererParameters& parameters)
    : node_(node),
      device_node_(node),
      input_node_(input_thread_.handle(node)),
      transform_listener_(transforms_, input_node_, false),
      touches_(parameters.touches),
      tactile_(parameters.tactile),
      loop_(parameters.radii),
      diagnostics_(node, private_node),
      supplier_(node, LayerBuilder(parameters.scene_path), loop_),
      loop_thread_(simulation::ForceLoop::kPeriod, [this](Time now) { work(now); },
                   {{}, realtime::kForcePriority, true}) {
  if (!loop_thread_.refusedScheduler().empty()) {
    ROS_WARN("The loop runs without SCHED_FIFO, on a busy machine it will be late: %s",
             loop_thread_.refusedScheduler().c_str());
  }
  advertise();
  subscribe();
  marker_timer_ = node_.createSteadyTimer(
      ros::WallDuration(kMarkerPeriod), [this](const ros::SteadyTimerEvent&) { publishMarkers(); });
  addDiagnostics();
  input_thread_.start();
}

ForceRendererNode::~ForceRendererNode() { stop(); }

void ForceRendererNode::stop() {
  if (stopping_.exchange(true)) return;  // from now on the loop commands no force
  const Time end = realtime::steadyNow() + kEndPatience;
  while (last_commands_ < kLastCommands && realtime::steadyNow() < end) {
    std::this_thread::sleep_for(kEndLook);
  }
  fingertip_subscriber_.shutdown();
  for (FingerTopics& topics : fingers_.values) {
    topics.pose.shutdown();
    topics.twist.shutdown();
  }
  loop_thread_.stop();
  supplier_.stop();
  input_thread_.stop();
}

void ForceRendererNode::advertise() {
  // Only the latest force counts.
  both_forces_publisher_ = advertiseLatest<haptex::ServoForces>(
      node_, "exoskeleton/servo_cf", both_forces_subscribers_, [this] { findWhoTakesSingles(); });
  for (const Finger finger : kFingers) {
    FingerTopics& topics = fingers_[finger];
    topics.force = advertiseLatest<haptex::ServoForce>(node_, topic(finger, "servo_cf"),
                                                       topics.force_subscribers,
                                                       [this] { findWhoTakesSingles(); });
    topics.contact = node_.advertise<haptex::Contact>(topic(finger, "contact"), kContactQueue);
  }
  marker_publisher_ = node_.advertise<visualization_msgs::MarkerArray>("contact/markers", 2);
}

void ForceRendererNode::findWhoTakesSingles() {
  for (FingerTopics& topics : fingers_.values) {
    topics.force_wanted = !topics.force_subscribers.areAllAmong(both_forces_subscribers_);
  }
}

void ForceRendererNode::subscribe() {
  device_node_.setCallbackQueue(&device_queue_);
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  for (const Finger finger : kFingers) {
    if (touches_[finger]) subscribeToFinger(finger);
  }
  const boost::function<void(const haptex::Fingertips&)> take_fingertips =
      [this](const haptex::Fingertips& message) { receiveFingertips(message); };
  fingertip_subscriber_ = device_node_.subscribe<haptex::Fingertips>(
      "exoskeleton/fingertips", 1, take_fingertips, ros::VoidConstPtr(), hints);
  const boost::function<void(const haptex::ClothState&)> take_state =
      [this](const haptex::ClothState& message) { receiveState(message); };
  state_subscriber_ = subscribeChecked(input_node_, "cloth/state", 1, take_state, hints);
  const boost::function<void(const std_msgs::Header&)> take_heartbeat =
      [this](const std_msgs::Header&) { loop_.receiveHeartbeat(realtime::steadyNow()); };
  heartbeat_subscriber_ = device_node_.subscribe<std_msgs::Header>(
      "cloth/heartbeat", 1, take_heartbeat, ros::VoidConstPtr(), hints);
  const boost::function<void(const haptex::ClothMeshConstPtr&)> take_mesh =
      [this](const haptex::ClothMeshConstPtr& message) { supplier_.setMesh(message); };
  mesh_subscriber_ = subscribeChecked(node_, "cloth/mesh", 1, take_mesh, hints);
  // After the listener, which subscribed before on the same thread: the buffer knows them then.
  const boost::function<void(const tf2_msgs::TFMessage&)> take_transforms =
      [this](const tf2_msgs::TFMessage&) { receiveTransforms(); };
  transform_subscriber_ =
      subscribeChecked(input_node_, "/tf", kTransformQueue, take_transforms, hints);
  static_transform_subscriber_ =
      subscribeChecked(input_node_, "/tf_static", kTransformQueue, take_transforms);
}

void ForceRendererNode::subscribeToFinger(Finger finger) {
  FingerTopics& topics = fingers_[finger];
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  const boost::function<void(const geometry_msgs::PoseStamped&)> take_pose =
      [this, finger, &topics](const geometry_msgs::PoseStamped& message) {
        const Time arrival = realtime::steadyNow();
        const auto pose = topics.filter.receive(message, ros::Time::now(), arrival);
        if (!pose || !receivesSingly(arrival)) return;
        loop_.receivePose(finger, *pose, arrival, Time(message.header.stamp.toNSec()));
        topics.poses.fetch_add(1, std::memory_order_relaxed);
      };
  const boost::function<void(const geometry_msgs::TwistStamped&)> take_twist =
      [this, finger, &topics](const geometry_msgs::TwistStamped& message) {
        const Time arrival = realtime::steadyNow();
        const auto twist = topics.filter.receive(message, ros::Time::now(), arrival);
        if (twist && receivesSingly(arrival)) loop_.receiveTwist(finger, *twist, arrival);
      };
  // Only the latest counts.
  topics.pose = device_node_.subscribe<geometry_msgs::PoseStamped>(
      topic(finger, "measured_cp"), 1, take_pose, ros::VoidConstPtr(), hints);
  topics.twist = device_node_.subscribe<geometry_msgs::TwistStamped>(
      topic(finger, "measured_cv"), 1, take_twist, ros::VoidConstPtr(), hints);
}

void ForceRendererNode::receiveFingertips(const haptex::Fingertips& message) {
  const Time arrival = realtime::steadyNow();
  const ros::Time now = ros::Time::now();
  for (const Finger finger : kFingers) {
    if (!touches_[finger]) continue;
    FingerTopics& topics = fingers_[finger];
    const auto motion = topics.filter.receive(message, finger, now, arrival);
    if (!motion) continue;
    loop_.receivePose(finger, motion->pose, arrival, Time(message.header.stamp.toNSec()));
    loop_.receiveTwist(finger, motion->twist, arrival);
    topics.poses.fetch_add(1, std::memory_order_relaxed);
    last_fingertips_ = arrival;
  }
  loop_thread_.call();
}

/// Whether the device tells of its fingers one by one only.
bool ForceRendererNode::receivesSingly(Time arrival) const {
  return arrival - last_fingertips_.load() > FingertipFilter::kForgetAfter;
}

void ForceRendererNode::receiveState(const haptex::ClothState& message) {
  const Time arrival = realtime::steadyNow();
  try {
    readState(message, state_);
  } catch (const std::invalid_argument& error) {
    ROS_WARN_THROTTLE(1.0, "cloth/state dropped: %s", error.what());
    const std::lock_guard<std::mutex> lock(mutex_);
    ++dropped_states_;
    last_dropped_state_ = error.what();
    return;
  }
  supplier_.setAttached(state_.attached);
  loop_.receiveState(state_, arrival);
}

void ForceRendererNode::receiveTransforms() {
  receiveHandBase();
  if (!tactile_) return;
  for (const Finger finger : kFingers) receiveArray(finger);
}

void ForceRendererNode::receiveHandBase() {
  if (!transforms_.canTransform(fixedFrame(), handFrame(), ros::Time(0))) return;
  try {
    const geometry_msgs::TransformStamped transform =
        transforms_.lookupTransform(fixedFrame(), handFrame(), ros::Time(0));
    const Eigen::Isometry3d pose = fromMessage(transform.transform);
    const Time now = realtime::steadyNow();
    const bool fixed = transform.header.stamp.isZero();
    const bool is_new =
        fixed ? !pose.isApprox(fixed_hand_base_, 0.0) : transform.header.stamp != hand_base_stamp_;
    if (has_hand_base_ && !is_new) return;
    has_hand_base_ = true;
    hand_base_stamp_ = transform.header.stamp;
    fixed_hand_base_ = pose;
    const Time age = std::min(ageOf(transform.header.stamp), kOldestTransform);
    loop_.receiveHandBase(pose, now - age, now, fixed);
  } catch (const tf2::TransformException&) {
    // Replaced between the two calls: the next look finds it.
  }
}

/// Fixed to the fingertip: once is enough.
void ForceRendererNode::receiveArray(Finger finger) {
  FingerTopics& topics = fingers_[finger];
  if (topics.has_array) return;
  const std::string tip = tipFrame(finger);
  const std::string array = arrayFrame(finger);
  if (!transforms_.canTransform(tip, array, ros::Time(0))) return;
  try {
    const auto transform = transforms_.lookupTransform(tip, array, ros::Time(0));
    loop_.receiveArray(finger, fromMessage(transform.transform));
    topics.has_array = true;
  } catch (const tf2::TransformException&) {
    // As above.
  }
}

void ForceRendererNode::work(Time now) {
  const bool contact_due = ++ticks_to_contact_ >= kTicksPerContact;
  if (contact_due) ticks_to_contact_ = 0;
  for (const Finger finger : kFingers) {
    loop_.wantContactors(finger, contact_due && fingers_[finger].contact.getNumSubscribers() > 0);
  }
  loop_.tick(now);
  const ros::Time stamp = ros::Time::now();
  const bool is_last = stopping_;  // looked at before: they are all of no force then
  publishForces(stamp);
  if (is_last) ++last_commands_;
  for (const Finger finger : kFingers) {
    if (contact_due) publishContact(finger, stamp);
  }
  tick_durations_.add(realtime::steadyNow() - now);
}

/// Both in one message: every message of 1 kHz takes a thread of the sockets of both sides out of
/// its sleep.
void ForceRendererNode::publishForces(const ros::Time& stamp) {
  const boost::shared_ptr<haptex::ServoForces>& both = both_forces_messages_.next();
  for (const Finger finger : kFingers) {
    const simulation::ForceLoop::Rendered& rendered = loop_.rendered(finger);
    haptex::ServoForce& force = both->forces[static_cast<std::size_t>(finger)];
    fillServoForce(rendered.contact, stopping_ ? 0.0 : rendered.gain, loop_.hand(), stamp, force);
    force.measured.fromNSec(static_cast<std::uint64_t>(rendered.measured.count()));
  }
  if (both_forces_publisher_.getNumSubscribers() > 0) both_forces_publisher_.publish(both);
  for (const Finger finger : kFingers) {
    FingerTopics& topics = fingers_[finger];
    if (!topics.force_wanted) continue;
    const boost::shared_ptr<haptex::ServoForce>& message = topics.force_messages.next();
    *message = both->forces[static_cast<std::size_t>(finger)];
    topics.force.publish(message);
  }
}

void ForceRendererNode::publishContact(Finger finger, const ros::Time& stamp) {
  FingerTopics& topics = fingers_[finger];
  if (topics.contact.getNumSubscribers() == 0) return;
  const simulation::ForceLoop::Rendered& rendered = loop_.rendered(finger);
  fillContact(rendered.contact, rendered.contactor_forces, rendered.array, rendered.gain, stamp,
              topics.contact_message);
  topics.contact.publish(topics.contact_message);
}

void ForceRendererNode::publishMarkers() {
  const Time now = realtime::steadyNow();
  const Finger felt = touches_[Finger::kIndex] ? Finger::kIndex : Finger::kThumb;
  const LoopRates rates = {force_rate_.update(loop_thread_.periods(), now),
                           cloth_rate_.update(loop_.status().states, now),
                           proximity_rate_.update(supplier_.status().queries, now),
                           exoskeleton_rate_.update(fingers_[felt].poses, now)};
  if (marker_publisher_.getNumSubscribers() == 0) return;
  const simulation::ForceLoopStatus status = loop_.status();
  const base::PerFinger<std::string> why{
      {whyNoForce(Finger::kIndex, status.news, now), whyNoForce(Finger::kThumb, status.news, now)}};
  marker_publisher_.publish(markers_.update(loop_.picture(), rates, ros::Time::now(), why));
  loop_.askForPicture();
}

}  // namespace haptex::nodes
