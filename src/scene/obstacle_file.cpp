#include "haptex/scene/obstacle_file.h"

#include <set>
#include <string>

#include "haptex/mesh/obj_file.h"
#include "haptex/scene/scene_values.h"

namespace haptex::scene {
namespace {

using base::YamlValue;

constexpr double kShortestPeriod = 1e-3;  // s
constexpr double kFastest = 1e3;          // m/s
constexpr double kFastestTurn = 1e4;      // rad/s
constexpr double kLightest = 1e-6;        // kg
constexpr double kHeaviest = 1e6;         // kg
const std::vector<std::string> kShapes = {"sphere", "box", "capsule", "mesh"};

mesh::ObstacleBox readBox(const YamlValue& value) {
  const auto sides = value.items(3);
  return {{readSize(sides[0]), readSize(sides[1]), readSize(sides[2])}};
}

mesh::ObstacleCapsule readCapsule(const YamlValue& value) {
  value.requireKeys({"radius", "length"});
  return {readSize(value.at("radius")), readSize(value.at("length"))};
}

mesh::ObstacleMesh readMesh(const YamlValue& value) {
  const std::string path = resolveFile(value, "meshes", ".obj");
  mesh::ObstacleMesh mesh = mesh::loadObjSurface(path);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (mesh.vertices[i].cwiseAbs().maxCoeff() > kMaxSize) {
      value.refuseBecause("position " + std::to_string(i + 1) + " of " + path +
                          " must be from -100 to 100 m along every axis");
    }
  }
  return mesh;
}

auto readShape(const YamlValue& value) -> decltype(mesh::Obstacle::shape) {
  int shapes = 0;
  for (const std::string& shape : kShapes) shapes += value.has(shape) ? 1 : 0;
  if (shapes != 1) value.refuseBecause("must have exactly one of sphere, box, capsule, mesh");
  if (value.has("sphere")) return mesh::ObstacleSphere{readSize(value.at("sphere"))};
  if (value.has("box")) return readBox(value.at("box"));
  if (value.has("capsule")) return readCapsule(value.at("capsule"));
  return readMesh(value.at("mesh"));
}

mesh::ObstacleOrbit readOrbit(const YamlValue& value) {
  value.requireKeys({"centre", "axis", "period"});
  mesh::ObstacleOrbit orbit{readPosition(value.at("centre")), readVector(value.at("axis")),
                            value.at("period").number()};
  if (!(orbit.axis.stableNorm() > 0.0)) value.at("axis").refuseBecause("must not be zero");
  orbit.axis.stableNormalize();
  if (!(orbit.period >= kShortestPeriod)) value.at("period").refuse("must be at least 1e-3 s");
  return orbit;
}

Eigen::Vector3d readVelocity(const YamlValue& value) {
  return readVectorWithin(value, kFastest, "must be from -1000 to 1000 m/s");
}

auto readMotion(const YamlValue& value) -> decltype(mesh::Obstacle::motion) {
  if (value.has("orbit") && value.has("velocity")) {
    value.refuseBecause("must have at most one of orbit, velocity");
  }
  if (value.has("orbit")) return readOrbit(value.at("orbit"));
  if (value.has("velocity")) return mesh::ObstacleDrift{readVelocity(value.at("velocity"))};
  return {};
}

double readFriction(const YamlValue& value) {
  const double friction = value.number();
  if (!(friction >= 0.0)) value.refuse("must be >= 0");
  return friction;
}

mesh::ObstacleBody readBody(const YamlValue& value) {
  value.requireKeys({"mass", "friction"}, {"velocity", "angular_velocity"});
  mesh::ObstacleBody body{value.at("mass").number()};
  if (!(body.mass >= kLightest && body.mass <= kHeaviest)) {
    value.at("mass").refuse("must be from 1e-6 to 1e6 kg");
  }
  body.friction = readFriction(value.at("friction"));
  if (value.has("velocity")) body.velocity = readVelocity(value.at("velocity"));
  if (value.has("angular_velocity")) {
    body.angular_velocity = readVectorWithin(value.at("angular_velocity"), kFastestTurn,
                                             "must be from -10000 to 10000 rad/s");
  }
  return body;
}

/// What a rigid body with mass may not be beside.
void requireFree(const YamlValue& value) {
  for (const char* key : {"capsule", "mesh"}) {
    if (!value.has(key)) continue;
    value.at("body").refuseBecause(std::string("is not allowed with ") + key +
                                   ", only with sphere or box");
  }
  for (const char* key : {"orbit", "velocity"}) {
    if (!value.has(key)) continue;
    value.at("body").refuseBecause(std::string("is not allowed with ") + key +
                                   ": a body goes as it is pushed, from body.velocity on");
  }
}

mesh::Obstacle readObstacle(const YamlValue& value) {
  std::vector<std::string> optional = kShapes;
  for (const char* key : {"rpy", "orbit", "velocity", "friction", "body"}) optional.push_back(key);
  value.requireKeys({"name", "position"}, optional);
  mesh::Obstacle obstacle;
  obstacle.name = value.at("name").text();
  obstacle.shape = readShape(value);
  obstacle.pose = readPose(value);
  obstacle.motion = readMotion(value);
  if (value.has("body")) {
    requireFree(value);
    obstacle.body = readBody(value.at("body"));
  }
  if (value.has("friction")) obstacle.friction = readFriction(value.at("friction"));
  return obstacle;
}

}  // namespace

std::vector<mesh::Obstacle> readObstacles(const YamlValue& list) {
  std::vector<mesh::Obstacle> obstacles;
  std::set<std::string> names;
  for (const YamlValue& item : list.items()) {
    obstacles.push_back(readObstacle(item));
    if (!names.insert(obstacles.back().name).second) {
      item.at("name").refuse("is the name of an earlier obstacle, must be unique");
    }
  }
  return obstacles;
}

}  // namespace haptex::scene
