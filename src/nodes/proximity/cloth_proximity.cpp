#include "haptex/nodes/proximity/cloth_proximity.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "haptex/base/quoted.h"
#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/common/transforms.h"
#include "haptex/nodes/wire/frame_names.h"

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

/// Volumes of a level in colours of their own.
VolumeGroup volumesOf(const proximity::KdopHierarchy& hierarchy, int level, std::string name) {
  VolumeGroup group{std::move(name), {}, {}};
  for (int i = 0; i < 1 << level; ++i) {
    group.volumes.push_back(hierarchy.volume(level, i));
    group.colours.push_back(i);
  }
  return group;
}

proximity::Range rangeOf(const Request& request) {
  proximity::Range range;
  range.distance = request.distance;
  if (request.nearest > 0) range.count = request.nearest;
  return range;
}

}  // namespace

ClothProximity::ClothProximity(double stale_after, Obstacles obstacles,
                               const std::vector<mesh::Obstacle>& moving)
    : stale_after_(stale_after), obstacles_(std::move(obstacles)) {
  for (const mesh::Obstacle& obstacle : moving) {
    if (obstacle.body) {
      bodies_.emplace(obstacle.name, bodies_.size());
    } else if (obstacle.moves()) {
      moving_.emplace(obstacle.name, obstacle);
    }
  }
  status_.refit_seconds = status_.answer_seconds = kNaN;
}

void ClothProximity::setMesh(const haptex::ClothMesh& message) try {
  RestMesh mesh = restMesh(message);
  std::shared_ptr<FittedCloth> before;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    before = latest_.fitted;
  }
  const bool same = before && before->mesh() == mesh;
  const std::size_t particles = mesh.rest_coordinates.size();
  const auto fitted = same ? before : std::make_shared<FittedCloth>(std::move(mesh));
  const std::lock_guard<std::mutex> lock(mutex_);
  ++status_.meshes;
  if (same) return;
  // A state that came before the first mesh may be of this one, but a state of another mesh is not,
  // even if it has as many particles.
  const haptex::ClothStateConstPtr& state = latest_.state.message;
  if (before ||
      (state && (state->mesh != fitted->mesh().number || state->positions.size() != particles))) {
    latest_.state.message.reset();
  }
  latest_.fitted = fitted;
  ++status_.builds;
  status_.triangles = fitted->mesh().triangles.size();
} catch (const std::exception& error) {
  drop("cloth/mesh", error.what());
}

void ClothProximity::setState(const haptex::ClothStateConstPtr& message,
                              Clock::time_point arrival) try {
  requireValid(*message);
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::size_t count = message->positions.size();
  if (latest_.fitted && count != latest_.fitted->mesh().rest_coordinates.size()) {
    throw std::invalid_argument(
        "positions has " + std::to_string(count) + " elements: cloth/mesh has " +
        std::to_string(latest_.fitted->mesh().rest_coordinates.size()) + " particles");
  }
  if (latest_.fitted && message->mesh != latest_.fitted->mesh().number) {
    throw std::invalid_argument("mesh = " + std::to_string(message->mesh) + ": cloth/mesh is " +
                                std::to_string(latest_.fitted->mesh().number));
  }
  ++latest_.state.number;
  latest_.state.message = message;
  latest_.arrival = arrival;
  ++status_.states;
} catch (const std::exception& error) {
  drop("cloth/state", error.what());
}

void ClothProximity::drop(const std::string& topic, const std::string& why) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++status_.dropped;
  status_.dropped_why = topic + ": " + why;
}

/// Why queries are refused now; empty if they are not. Needs the mutex.
std::string ClothProximity::trouble(Clock::time_point now) const {
  const std::string dropped =
      status_.dropped == 0 ? "" : "; the last message that was dropped: " + status_.dropped_why;
  const char* missing = !latest_.fitted          ? "cloth/mesh"
                        : !latest_.state.message ? "cloth/state"
                                                 : nullptr;
  if (missing) {
    return std::string("there is no cloth yet, no good message on ") + missing +
           ": is cloth_simulation running?" + dropped;
  }
  const double age = inSeconds(now - latest_.arrival);
  if (age <= stale_after_) return "";
  std::ostringstream message;
  message << std::setprecision(3) << "the cloth is stale, its last state arrived " << age
          << " s ago, allowed are " << stale_after_
          << " s: is cloth_simulation running? If it is that slow, set ~stale_after" << dropped;
  return message.str();
}

ClothProximity::Cloth ClothProximity::requireLive(Clock::time_point now) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::string what = trouble(now);
  if (!what.empty()) throw std::runtime_error(what);
  return latest_;
}

FittedCloth::View ClothProximity::look(const Cloth& cloth) {
  FittedCloth::View view = cloth.fitted->look(cloth.state);
  if (!std::isnan(view.refit_seconds)) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++status_.refits;
    status_.refit_seconds = view.refit_seconds;
  }
  return view;
}

proximity::RigidObstacle ClothProximity::requireObstacle(const std::string& name) const {
  const auto found = obstacles_.find(name);
  if (found != obstacles_.end()) return found->second;
  std::string known;
  for (const auto& [known_name, obstacle] : obstacles_) known += " " + known_name;
  throw std::invalid_argument("obstacle = " + base::quoted(name) + ": " +
                              (known.empty() ? "there is none in the scene; parameter ~scene names "
                                               "the scene file that lists them"
                                             : "those of the scene are" + known));
}

/// Copies of an obstacle share its shape, so each query may have a pose of its own.
/// @throws std::invalid_argument if it has mass and the state does not have it
void ClothProximity::moveObstacle(const std::string& name, const haptex::ClothState& state,
                                  proximity::RigidObstacle& obstacle) const {
  const auto moving = moving_.find(name);
  if (moving != moving_.end()) obstacle.setPose(moving->second.poseAt(state.simulated_time));
  const auto body = bodies_.find(name);
  if (body == bodies_.end()) return;
  if (body->second >= state.bodies.size()) {
    throw std::invalid_argument("obstacle = " + base::quoted(name) +
                                ": it has mass, and cloth/state has " +
                                std::to_string(state.bodies.size()) + " of the " +
                                std::to_string(bodies_.size()) + " bodies of the scene");
  }
  obstacle.setPose(fromMessage(state.bodies[body->second]));
}

haptex::QueryProximity::Response ClothProximity::answer(const Request& request,
                                                        const FrameLookup& world_from_frame,
                                                        Clock::time_point now) {
  const Clock::time_point begin = Clock::now();
  try {
    Response response = compute(request, world_from_frame, now);
    const std::lock_guard<std::mutex> lock(mutex_);
    ++status_.answered;
    status_.answer_seconds = secondsSince(begin);
    return response;
  } catch (const std::exception& error) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++status_.refused;
    status_.refused_why = error.what();
    return refusal(error.what());
  }
}

haptex::QueryProximity::Response ClothProximity::compute(const Request& request,
                                                         const FrameLookup& world_from_frame,
                                                         Clock::time_point now) {
  requireValid(request);
  std::optional<proximity::RigidObstacle> obstacle;
  if (request.shape == Request::OBSTACLE) obstacle = requireObstacle(request.obstacle);
  std::optional<proximity::Cursor> cursor;
  if (!obstacle) {
    cursor = cursorInWorld(request, world_from_frame());
  } else if (!request.header.frame_id.empty()) {
    world_from_frame();  // not used, but an unknown one is refused like everywhere
  }
  const Cloth cloth = requireLive(now);
  Response response;
  std::vector<proximity::NearElement> found;
  {
    const FittedCloth::View view = look(cloth);
    if (obstacle) {
      moveObstacle(request.obstacle, view.state, *obstacle);
      query(view.hierarchy, *obstacle, rangeOf(request), found);
    } else {
      view.hierarchy.query(*cursor, rangeOf(request), found);
    }
    response.header.stamp = view.state.header.stamp;
    response.step = view.state.step;
  }
  response.header.frame_id = fixedFrame();
  fillResponse(found, request.distance, response);
  return response;
}

std::vector<proximity::VolumeIndex> ClothProximity::tested(const AnsweredQuery& query,
                                                           const FittedCloth::View& view) const {
  const Request& request = query.request;
  if (request.shape != Request::OBSTACLE) {
    return view.hierarchy.tested(cursorInWorld(request, query.world_from_frame), rangeOf(request));
  }
  proximity::RigidObstacle obstacle = requireObstacle(request.obstacle);
  moveObstacle(request.obstacle, view.state, obstacle);
  return proximity::tested(view.hierarchy, obstacle, rangeOf(request));
}

/// None of a query that could be answered once, and not of this state.
std::vector<proximity::VolumeIndex> ClothProximity::testedOrNone(
    const AnsweredQuery& query, const FittedCloth::View& view) const try {
  return tested(query, view);
} catch (const std::invalid_argument&) {
  return {};
}

std::optional<ProximityScene> ClothProximity::scene(const SceneRequest& request) {
  Cloth cloth;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    cloth = latest_;
  }
  if (!cloth.fitted || !cloth.state.message) return std::nullopt;
  const FittedCloth::View view = look(cloth);
  const proximity::KdopHierarchy& hierarchy = view.hierarchy;
  ProximityScene scene;
  scene.stamp = view.state.header.stamp;
  const int count = static_cast<int>(hierarchy.triangles().size());
  for (const int index : request.triangles) {
    if (index < count) scene.triangles.push_back(hierarchy.triangle(index));
  }
  const int levels = hierarchy.levels();
  if (request.level >= 0) {
    scene.volumes.push_back(volumesOf(hierarchy, std::min(request.level, levels - 1), "volumes"));
  }
  for (int level = 0; level < levels && request.level == SceneRequest::kAllLevels; ++level) {
    scene.volumes.push_back(volumesOf(hierarchy, level, "volumes/" + std::to_string(level)));
  }
  if (request.tested) {
    VolumeGroup group{"tested_volumes", {}, {}};
    for (const proximity::VolumeIndex& volume : testedOrNone(*request.tested, view)) {
      group.volumes.push_back(hierarchy.volume(volume.level, volume.index));
      group.colours.push_back(volume.level);
    }
    scene.volumes.push_back(std::move(group));
  }
  return scene;
}

ProximityStatus ClothProximity::status(Clock::time_point now) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  ProximityStatus status = status_;
  status.trouble = trouble(now);
  status.cloth_age = latest_.state.message ? inSeconds(now - latest_.arrival) : kNaN;
  return status;
}

}  // namespace haptex::nodes
