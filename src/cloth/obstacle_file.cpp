#include "haptex/cloth/obstacle_file.h"

#include <cmath>
#include <set>
#include <string>

#include "haptex/cloth/obj_file.h"
#include "haptex/cloth/scene_values.h"

namespace haptex::cloth {
namespace {

using material::YamlValue;

const std::vector<std::string> kShapes = {"sphere", "box", "capsule", "mesh"};

Eigen::Vector3d readVector(const YamlValue& value) {
  const auto components = value.items(3);
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) vector[i] = components[i].number();
  return vector;
}

Eigen::Vector3d readPosition(const YamlValue& value) {
  const Eigen::Vector3d position = readVector(value);
  for (int i = 0; i < 3; ++i) {
    if (std::abs(position[i]) > kLargestSize)
      value.items(3)[i].refuse("must be from -100 to 100 m");
  }
  return position;
}

// As in URDF: rotations about the fixed axes x, y and z, in this order.
Eigen::Matrix3d readRotation(const YamlValue& value) {
  const Eigen::Vector3d rpy = readVector(value);
  return (Eigen::AngleAxisd(rpy[2], Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(rpy[1], Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy[0], Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

ObstacleBox readBox(const YamlValue& value) {
  const auto sides = value.items(3);
  return {{readSize(sides[0]), readSize(sides[1]), readSize(sides[2])}};
}

ObstacleCapsule readCapsule(const YamlValue& value) {
  value.requireKeys({"radius", "length"});
  return {readSize(value.at("radius")), readSize(value.at("length"))};
}

ObstacleMesh readMesh(const YamlValue& value) {
  const std::string path = resolveFile(value, "meshes", ".obj");
  ObstacleMesh mesh = loadObjSurface(path);
  requireTriangleCount(value, static_cast<long long>(mesh.triangles.size()));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (mesh.vertices[i].cwiseAbs().maxCoeff() > kLargestSize) {
      value.refuseBecause("position " + std::to_string(i + 1) + " of " + path +
                          " must be from -100 to 100 m along every axis");
    }
  }
  return mesh;
}

auto readShape(const YamlValue& value) -> decltype(Obstacle::shape) {
  int shapes = 0;
  for (const std::string& shape : kShapes) shapes += value.has(shape) ? 1 : 0;
  if (shapes != 1) value.refuseBecause("must have exactly one of sphere, box, capsule, mesh");
  if (value.has("sphere")) return ObstacleSphere{readSize(value.at("sphere"))};
  if (value.has("box")) return readBox(value.at("box"));
  if (value.has("capsule")) return readCapsule(value.at("capsule"));
  return readMesh(value.at("mesh"));
}

Obstacle readObstacle(const YamlValue& value) {
  std::vector<std::string> optional = kShapes;
  optional.push_back("rpy");
  value.requireKeys({"name", "position"}, optional);
  Obstacle obstacle;
  obstacle.name = value.at("name").text();
  obstacle.shape = readShape(value);
  obstacle.pose.setIdentity();
  obstacle.pose.translation() = readPosition(value.at("position"));
  if (value.has("rpy")) obstacle.pose.linear() = readRotation(value.at("rpy"));
  return obstacle;
}

}  // namespace

std::vector<Obstacle> readObstacles(const YamlValue& list) {
  std::vector<Obstacle> obstacles;
  std::set<std::string> names;
  for (const YamlValue& item : list.items()) {
    obstacles.push_back(readObstacle(item));
    if (!names.insert(obstacles.back().name).second) {
      item.at("name").refuse("is the name of an earlier obstacle, must be unique");
    }
  }
  return obstacles;
}

}  // namespace haptex::cloth
