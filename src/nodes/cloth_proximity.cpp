#include "haptex/nodes/cloth_proximity.h"

#include <cstdio>
#include <limits>
#include <stdexcept>
#include <utility>

#include "haptex/nodes/cloth_messages.h"

namespace haptex::nodes {
namespace {

using Request = haptex::QueryProximity::Request;
using Response = haptex::QueryProximity::Response;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double inSeconds(ClothProximity::Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

double secondsSince(ClothProximity::Clock::time_point begin) {
  return inSeconds(ClothProximity::Clock::now() - begin);
}

proximity::Range rangeOf(const Request& request) {
  proximity::Range range;
  range.distance = request.distance;
  if (request.nearest > 0) range.count = request.nearest;
  return range;
}

}  // namespace

ClothProximity::ClothProximity(double stale_after, Obstacles obstacles)
    : stale_after_(stale_after), obstacles_(std::move(obstacles)) {
  status_.refit_seconds = status_.answer_seconds = kNaN;
}

void ClothProximity::setMesh(const haptex::ClothMesh& message) try {
  RestMesh mesh = restMesh(message);
  {
    const std::shared_lock<std::shared_mutex> lock(hierarchy_mutex_);
    if (hierarchy_ && mesh == mesh_) {
      const std::lock_guard<std::mutex> latest_lock(latest_mutex_);
      ++status_.meshes;
      return;
    }
  }
  std::optional<proximity::KdopHierarchy> hierarchy;
  hierarchy.emplace(mesh.triangles, mesh.rest_coordinates);
  const std::unique_lock<std::shared_mutex> lock(hierarchy_mutex_);
  const std::lock_guard<std::mutex> latest_lock(latest_mutex_);
  // A state of the mesh before this one may have as many particles. Before the first mesh there is
  // none.
  const bool first = !hierarchy_;
  if (latest_ && (!first || latest_->positions.size() != mesh.rest_coordinates.size())) {
    latest_.reset();
  }
  particle_count_ = mesh.rest_coordinates.size();
  hierarchy_ = std::move(hierarchy);
  mesh_ = std::move(mesh);
  fitted_.reset();
  ++status_.meshes;
  ++status_.builds;
  status_.triangles = mesh_.triangles.size();
} catch (const std::exception& error) {
  drop("cloth/mesh", error.what());
}

void ClothProximity::setState(const haptex::ClothStateConstPtr& message,
                              Clock::time_point arrival) try {
  requireValid(*message);
  const std::lock_guard<std::mutex> lock(latest_mutex_);
  if (particle_count_ > 0 && message->positions.size() != particle_count_) {
    throw std::invalid_argument("positions has " + std::to_string(message->positions.size()) +
                                " elements: cloth/mesh has " + std::to_string(particle_count_) +
                                " particles");
  }
  latest_ = message;
  arrival_ = arrival;
  ++status_.states;
} catch (const std::exception& error) {
  drop("cloth/state", error.what());
}

void ClothProximity::drop(const std::string& topic, const std::string& why) {
  const std::lock_guard<std::mutex> lock(latest_mutex_);
  ++status_.dropped;
  status_.dropped_why = topic + ": " + why;
}

/// Why queries are refused now; empty if they are not. Needs latest_mutex_.
std::string ClothProximity::trouble(Clock::time_point now) const {
  const std::string dropped =
      status_.dropped == 0 ? "" : "; the last message that was dropped: " + status_.dropped_why;
  if (particle_count_ == 0) {
    return "there is no cloth yet, no good message on cloth/mesh: is cloth_simulation running?" +
           dropped;
  }
  if (!latest_) {
    return "there is no cloth yet, no good message on cloth/state: is cloth_simulation running?" +
           dropped;
  }
  const double age = inSeconds(now - arrival_);
  if (age <= stale_after_) return "";
  char text[200];
  std::snprintf(text, sizeof(text),
                "the cloth is stale, its last state arrived %.3g s ago, allowed are %.3g s: is "
                "cloth_simulation running? If it is that slow, set ~stale_after",
                age, stale_after_);
  return text + dropped;
}

haptex::ClothStateConstPtr ClothProximity::requireLive(Clock::time_point now) const {
  const std::lock_guard<std::mutex> lock(latest_mutex_);
  const std::string what = trouble(now);
  if (!what.empty()) throw std::runtime_error(what);
  return latest_;
}

/// Fits the hierarchy to a state or a later one, unless it is. @returns a lock under which it stays
std::shared_lock<std::shared_mutex> ClothProximity::lockFitted(
    const haptex::ClothStateConstPtr& state) {
  std::shared_lock<std::shared_mutex> lock(hierarchy_mutex_);
  if (fitted_ == state) return lock;
  lock.unlock();
  refit();
  lock.lock();
  if (!fitted_) throw std::runtime_error("the mesh of the cloth has just changed: ask again");
  return lock;
}

void ClothProximity::refit() {
  const std::unique_lock<std::shared_mutex> lock(hierarchy_mutex_);
  haptex::ClothStateConstPtr state;
  {
    const std::lock_guard<std::mutex> latest_lock(latest_mutex_);
    state = latest_;
  }
  if (!state || state == fitted_) return;
  const Clock::time_point begin = Clock::now();
  positions_.resize(state->positions.size());
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    const geometry_msgs::Point& position = state->positions[i];
    positions_[i] = {position.x, position.y, position.z};
  }
  hierarchy_->refit(positions_);
  fitted_ = state;
  const double seconds = secondsSince(begin);
  const std::lock_guard<std::mutex> latest_lock(latest_mutex_);
  status_.refit_seconds = seconds;
  ++status_.refits;
}

const proximity::RigidObstacle& ClothProximity::requireObstacle(const std::string& name) const {
  const auto found = obstacles_.find(name);
  if (found != obstacles_.end()) return found->second;
  std::string known;
  for (const auto& [known_name, obstacle] : obstacles_) known += " " + known_name;
  throw std::invalid_argument("obstacle = '" + name + "': " +
                              (known.empty() ? "there is none in the scene; parameter ~scene names "
                                               "the scene file that lists them"
                                             : "those of the scene are" + known));
}

haptex::QueryProximity::Response ClothProximity::answer(const Request& request,
                                                        const FrameLookup& world_from_frame,
                                                        Clock::time_point now) {
  const Clock::time_point begin = Clock::now();
  try {
    Response response = compute(request, world_from_frame, now);
    const std::lock_guard<std::mutex> lock(latest_mutex_);
    ++status_.answered;
    status_.answer_seconds = secondsSince(begin);
    return response;
  } catch (const std::exception& error) {
    const std::lock_guard<std::mutex> lock(latest_mutex_);
    ++status_.refused;
    status_.refused_why = error.what();
    return refusal(error.what());
  }
}

haptex::QueryProximity::Response ClothProximity::compute(const Request& request,
                                                         const FrameLookup& world_from_frame,
                                                         Clock::time_point now) {
  requireValid(request);
  const proximity::RigidObstacle* obstacle = nullptr;
  if (request.shape == Request::OBSTACLE) obstacle = &requireObstacle(request.obstacle);
  std::optional<proximity::Cursor> cursor;
  if (!obstacle) {
    cursor = cursorInWorld(request, world_from_frame());
  } else if (!request.header.frame_id.empty()) {
    world_from_frame();  // not used, but an unknown one is refused like everywhere
  }
  Response response;
  std::vector<proximity::NearElement> found;
  {
    const auto lock = lockFitted(requireLive(now));
    if (obstacle) {
      query(*hierarchy_, *obstacle, rangeOf(request), found);
    } else {
      hierarchy_->query(*cursor, rangeOf(request), found);
    }
    response.header.stamp = fitted_->header.stamp;
    response.step = fitted_->step;
  }
  response.header.frame_id = kFixedFrame;
  fillResponse(found, request.distance, response);
  return response;
}

std::optional<ProximityScene> ClothProximity::scene(const std::vector<int>& triangles, int level) {
  refit();
  const std::shared_lock<std::shared_mutex> lock(hierarchy_mutex_);
  if (!fitted_) return std::nullopt;
  ProximityScene scene;
  scene.stamp = fitted_->header.stamp;
  const int count = static_cast<int>(hierarchy_->triangles().size());
  for (const int index : triangles) {
    if (index < count) scene.triangles.push_back(hierarchy_->triangle(index));
  }
  if (level >= 0) {
    const int shown = std::min(level, hierarchy_->levels() - 1);
    for (int i = 0; i < 1 << shown; ++i) scene.volumes.push_back(hierarchy_->volume(shown, i));
  }
  return scene;
}

ProximityStatus ClothProximity::status(Clock::time_point now) const {
  const std::lock_guard<std::mutex> lock(latest_mutex_);
  ProximityStatus status = status_;
  status.trouble = trouble(now);
  status.cloth_age = latest_ ? inSeconds(now - arrival_) : kNaN;
  return status;
}

}  // namespace haptex::nodes
