// How long does an answer of the node proximity take, from request to response, over a persistent
// and over a fresh connection? Against the node itself, which bench/touch/proximity_service.launch
// starts; this program plays the cloth, a sheet of 10082 triangles that moves 80 times a second. An
// empty service of its own shows what ROS needs for a round trip.
#include <haptex/ClothMesh.h>
#include <haptex/ClothState.h>
#include <haptex/QueryProximity.h>
#include <ros/ros.h>
#include <std_srvs/Empty.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "haptex/mesh/mesh.h"
#include "haptex/oracles/scenes/deformed_sheets.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using Clock = std::chrono::steady_clock;

constexpr int kCells = 71;
constexpr int kStateRate = 80;  // Hz, as of a cloth with 12.5 ms steps
constexpr int kPersistentCalls = 4000;
constexpr int kFreshCalls = 400;

/// Publishes a sheet that moves to and fro, until destroyed.
class PlayedCloth {
 public:
  explicit PlayedCloth(ros::NodeHandle& node)
      : mesh_(mesh::makeRectangle(0.2, 0.2, kCells, kCells, mesh::Triangulation::kAlternating)),
        positions_(oracles::deformedSheet(mesh_, "crumpled_1")),
        mesh_publisher_(node.advertise<ClothMesh>("cloth/mesh", 1, true)),
        state_publisher_(node.advertise<ClothState>("cloth/state", 1)) {
    publishMesh();
    thread_ = std::thread([this] { publishStates(); });
  }
  ~PlayedCloth() {
    stop_ = true;
    thread_.join();
  }

  const std::vector<Eigen::Vector3d>& positions() const { return positions_; }
  std::string triangles() const { return std::to_string(mesh_.triangles.size()); }

 private:
  void publishMesh() {
    ClothMesh message;
    message.header.stamp = ros::Time::now();
    message.header.frame_id = "world";
    message.fabrics = {"bench"};
    for (const Eigen::Vector2d& rest : mesh_.rest_coordinates) {
      message.rest_weft_coordinates.push_back(rest.x());
      message.rest_warp_coordinates.push_back(rest.y());
      message.masses.push_back(1e-6);
    }
    for (const auto& triangle : mesh_.triangles) {
      message.triangles.insert(message.triangles.end(), triangle.begin(), triangle.end());
    }
    mesh_publisher_.publish(message);
  }

  void publishStates() {
    ClothState message;
    message.header.frame_id = "world";
    message.positions.resize(positions_.size());
    message.velocities.resize(positions_.size());
    message.forces.resize(positions_.size());
    auto due = Clock::now();
    while (!stop_) {
      const double sway = 0.001 * static_cast<double>(message.step % 2);
      for (std::size_t i = 0; i < positions_.size(); ++i) {
        message.positions[i].x = positions_[i].x() + sway;
        message.positions[i].y = positions_[i].y();
        message.positions[i].z = positions_[i].z();
      }
      ++message.step;
      message.header.stamp = ros::Time::now();
      state_publisher_.publish(message);
      due += std::chrono::microseconds(1000000 / kStateRate);
      std::this_thread::sleep_until(due);
    }
  }

  mesh::ClothMesh mesh_;
  std::vector<Eigen::Vector3d> positions_;
  ros::Publisher mesh_publisher_, state_publisher_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// The fingertip of `scripts/bench proximity`, at a particle.
QueryProximity requestAt(const Eigen::Vector3d& place) {
  QueryProximity call;
  call.request.header.frame_id = "world";
  call.request.shape = QueryProximity::Request::SPHERES;
  call.request.points.resize(1);
  call.request.points[0].x = place.x();
  call.request.points[0].y = place.y();
  call.request.points[0].z = place.z();
  call.request.radii = {0.012};
  return call;
}

/// Sorted times (ms) of calls, one after the other.
std::vector<double> timeCalls(int count, const std::function<void(int)>& call) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i) {
    const auto begin = Clock::now();
    call(i);
    times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
  }
  std::sort(times.begin(), times.end());
  return times;
}

double quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

void print(const std::string& name, const std::string& triangles,
           const std::vector<double>& times) {
  bench::printLine("proximity_service/" + name + "_p50/" + triangles, quantile(times, 0.5), "ms");
  bench::printLine("proximity_service/" + name + "_p99/" + triangles, quantile(times, 0.99), "ms");
}

void require(bool success, const std::string& why) {
  if (!success) throw std::runtime_error(why);
}

bool answerEmpty(std_srvs::Empty::Request&, std_srvs::Empty::Response&) { return true; }

void run() {
  ros::NodeHandle node;
  const PlayedCloth cloth(node);
  const ros::ServiceServer server = node.advertiseService("empty", answerEmpty);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  require(ros::service::waitForService("proximity/query", ros::Duration(20.0)),
          "no service proximity/query: bench/touch/proximity_service.launch starts the node");
  auto persistent = node.serviceClient<QueryProximity>("proximity/query", true);
  double elements = 0.0;
  const auto query = [&](ros::ServiceClient& client, int i) {
    const auto particle = static_cast<std::size_t>(i) * 7919 % cloth.positions().size();
    QueryProximity call = requestAt(cloth.positions()[particle]);
    require(client.call(call), "the call of proximity/query failed");
    require(call.response.success, call.response.message);
    elements += static_cast<double>(call.response.elements.size());
  };
  // The first states have to arrive, and a fingertip asks on a connection that is open already.
  for (int attempt = 0; attempt < 100; ++attempt) {
    QueryProximity call = requestAt(cloth.positions()[0]);
    if (persistent.call(call) && call.response.success) break;
    ros::Duration(0.05).sleep();
  }
  const std::vector<double> kept =
      timeCalls(kPersistentCalls, [&](int i) { query(persistent, i); });
  print("persistent", cloth.triangles(), kept);
  bench::printLine("proximity_service/elements/" + cloth.triangles(), elements / kPersistentCalls,
                   "elements");
  const std::vector<double> fresh = timeCalls(kFreshCalls, [&](int i) {
    auto client = node.serviceClient<QueryProximity>("proximity/query");
    query(client, i);
  });
  print("fresh", cloth.triangles(), fresh);
  auto empty = node.serviceClient<std_srvs::Empty>("empty", true);
  const std::vector<double> least = timeCalls(kPersistentCalls, [&](int) {
    std_srvs::Empty call;
    require(empty.call(call), "the call of an empty service failed");
  });
  print("empty_service", cloth.triangles(), least);
  bench::printLine("proximity_service/persistent_over_empty/" + cloth.triangles(),
                   quantile(kept, 0.5) / quantile(least, 0.5), "ratio");
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "bench_proximity_service");
  // Information goes to standard output, which is for the lines only.
  ros::console::set_logger_level(ROSCONSOLE_ROOT_LOGGER_NAME, ros::console::levels::Warn);
  try {
    run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_proximity_service: %s\n", error.what());
    return 1;
  }
  return 0;
}
