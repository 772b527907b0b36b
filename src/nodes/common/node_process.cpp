#include "haptex/nodes/common/node_process.h"

#include <ros/ros.h>
#include <ros/xmlrpc_manager.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <exception>
#include <stdexcept>
#include <string>

#include "haptex/base/quoted.h"
#include "haptex/base/workload.h"
#include "haptex/nodes/common/socket_thread.h"
#include "haptex/nodes/wire/frame_names.h"
#include "haptex/realtime/scheduling.h"
#include "haptex/realtime/semaphore.h"

namespace haptex::nodes {
namespace {

constexpr auto kLook = std::chrono::milliseconds(100);  // at roscpp, which may end by itself
constexpr std::chrono::seconds kMostEnding{10};         // roslaunch kills after 15 and 2 s
std::atomic<bool> ending{false};
static_assert(std::atomic<bool>::is_always_lock_free, "for use in a signal handler");

realtime::Semaphore& endAsked() {
  static realtime::Semaphore semaphore;
  return semaphore;
}

void askToEnd() {
  ending = true;
  endAsked().post();
}

void handleSignal(int /*number*/) { askToEnd(); }

void handleAlarm(int /*number*/) {
  constexpr char kSays[] = "Asked to end, and still at work: the process ends without it\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kSays, sizeof(kSays) - 1);
  _exit(1);
}

/// The second parameter of shutdown(caller, reason), if the caller has sent a text: it may be
/// anybody.
std::string reasonOf(XmlRpc::XmlRpcValue& parameters) {
  using Value = XmlRpc::XmlRpcValue;
  if (parameters.getType() != Value::TypeArray || parameters.size() < 2) return "no reason given";
  Value& reason = parameters[1];
  if (reason.getType() != Value::TypeString) return "the reason given is not a text";
  return reason;
}

/// What the master calls for `rosnode kill` and when another node takes the name. Whatever is wrong
/// with the request, the node ends: that is the safe answer.
void handleShutdown(XmlRpc::XmlRpcValue& parameters, XmlRpc::XmlRpcValue& result) {
  ROS_WARN("Asked to end: %s", base::shortened(reasonOf(parameters)).c_str());
  askToEnd();
  result = ros::xmlrpc::responseInt(1, "", 0);
}

void takeOverEnding() {
  endAsked();  // made before a signal can come
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, handleSignal);
  ros::XMLRPCManager::instance()->unbind("shutdown");
  ros::XMLRPCManager::instance()->bind("shutdown", handleShutdown);
}

/// So that roscpp's own services and tf refuse an array that claims to be long instead of taking
/// all memory for it. Cloth of 2 million triangles takes 2.1 GiB. A limit of the user's
/// that is lower stays.
void limitMemory() {
  constexpr rlim_t kMost = rlim_t{4} << 30;  // bytes of data, without code and shared memory
  rlimit limit{};
  if (base::kSanitized || getrlimit(RLIMIT_DATA, &limit) != 0 || limit.rlim_cur <= kMost) return;
  limit.rlim_cur = kMost;
  setrlimit(RLIMIT_DATA, &limit);
}

/// The parameter tf_prefix of the node or of the nearest namespace, as robot_state_publisher reads
/// it.
void takeFramePrefix() {
  const ros::NodeHandle private_node("~");
  std::string parameter, prefix;
  if (!private_node.searchParam("tf_prefix", parameter)) return;
  if (!private_node.getParam(parameter, prefix)) {
    throw std::invalid_argument("parameter " + parameter + " is not a string");
  }
  setFramePrefix(prefix);
}

}  // namespace

bool isEnding() { return ending || !ros::ok(); }

void limitEnding(std::chrono::seconds most) {
  std::signal(SIGALRM, handleAlarm);
  alarm(static_cast<unsigned>(most.count()));
}

int runNode(int argc, char** argv, const ProcessTraits& traits,
            const std::function<RunningNode()>& make) {
  ros::init(argc, argv, traits.name, ros::init_options::NoSigintHandler);
  const ros::NodeHandle started;  // without a node ROS_FATAL prints nothing
  takeOverEnding();
  limitMemory();
  preferMessages(traits.on_force_path);
  if (traits.on_force_path) realtime::lockMemory();
  int status = 0;
  try {
    takeFramePrefix();
    RunningNode running = make();
    ros::AsyncSpinner spinner(traits.spinners);
    spinner.start();
    while (!isEnding()) endAsked().waitFor(kLook);
    limitEnding(kMostEnding);
    running.stop();
    realtime::makeAllOrdinary();
    spinner.stop();
  } catch (const std::exception& error) {
    ROS_FATAL("%s: %s", traits.name.c_str(), error.what());
    realtime::makeAllOrdinary();
    if (ros::param::param("~stay", false)) {
      while (!isEnding()) endAsked().waitFor(kLook);
    }
    status = 1;
  }
  ros::shutdown();
  return status;
}

}  // namespace haptex::nodes
