#include "haptex/scene/scene_values.h"

#include <cmath>
#include <filesystem>
#include <set>
#include <vector>

#include "haptex/base/quoted.h"
#include "haptex/mesh/obj_file.h"
#include "haptex/scene/frame_name.h"

namespace haptex::scene {
namespace {

using base::YamlValue;
namespace fs = std::filesystem;

constexpr auto kMaxTriangles = static_cast<long long>(mesh::kMostTriangles);

// Names of the files of one kind, for a message that says what there is.
std::string namesIn(const fs::path& directory, const std::string& extension) {
  std::set<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    if (entry.path().extension() == extension) names.insert(entry.path().stem().string());
  }
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return names.empty() ? "none" : list;
}

Eigen::Matrix3d readRotation(const YamlValue& value) {
  const Eigen::Vector3d rpy = readVector(value);
  return (Eigen::AngleAxisd(rpy[2], Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(rpy[1], Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy[0], Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace

std::string resolveFile(const YamlValue& value, const std::string& kind,
                        const std::string& extension) {
  const std::string name = value.text();
  const fs::path scene_directory = fs::path(value.file()).parent_path();
  const fs::path kind_directory = (scene_directory / ".." / kind).lexically_normal();
  const bool is_path = name.find('/') != std::string::npos;
  fs::path path = (is_path ? scene_directory : kind_directory) / name;
  if (path.extension() != extension) path += extension;
  path = path.lexically_normal();
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    value.refuse("must be a name in " + kind_directory.string() + " (" +
                 namesIn(kind_directory, extension) + ") or a path with a '/'; there is no file " +
                 base::shortened(path.string()));
  }
  return path.string();
}

Eigen::Vector3d readVector(const YamlValue& value) {
  const std::vector<YamlValue> components = value.items(3);
  return {components[0].number(), components[1].number(), components[2].number()};
}

Eigen::Vector3d readVectorWithin(const YamlValue& value, double largest, const char* allowed) {
  const Eigen::Vector3d vector = readVector(value);
  for (int i = 0; i < 3; ++i) {
    if (std::abs(vector[i]) > largest) value.items(3)[i].refuse(allowed);
  }
  return vector;
}

double readSize(const YamlValue& value) {
  const double size = value.number();
  if (size <= 0.0 || size > kMaxSize) value.refuse("must be > 0 and <= 100 m");
  return size;
}

void requireTriangleCount(const YamlValue& value, long long triangles) {
  if (triangles > kMaxTriangles) {
    value.refuseBecause(std::to_string(triangles) + " triangles, at most " +
                        std::to_string(kMaxTriangles) + " are allowed");
  }
}

Eigen::Vector3d readPosition(const YamlValue& value) {
  return readVectorWithin(value, kMaxSize, "must be from -100 to 100 m");
}

Eigen::Isometry3d readPose(const YamlValue& value) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (value.has("position")) pose.translation() = readPosition(value.at("position"));
  if (value.has("rpy")) pose.linear() = readRotation(value.at("rpy"));
  return pose;
}

std::string readName(const YamlValue& value) {
  std::string name = value.text();
  if (!isFrameName(name)) value.refuse(std::string("must be ") + kFrameNames);
  return name;
}

int readParticle(const YamlValue& value, const mesh::ClothMesh& mesh) {
  const int particle = value.integer();
  const int count = static_cast<int>(mesh.rest_coordinates.size());
  if (particle < 0 || particle >= count) {
    value.refuse("must be a particle from 0 to " + std::to_string(count - 1));
  }
  return particle;
}

const std::vector<int>& readGroup(const YamlValue& value, const mesh::MeshGroups& groups) {
  const auto group = groups.find(value.text());
  if (group != groups.end()) return group->second;
  std::string names;
  for (const auto& [name, triangles] : groups) names += (names.empty() ? "" : ", ") + name;
  value.refuse("must be a group ('g') of the mesh that has a face: " +
               (names.empty() ? "there is none" : base::shortened(names)));
}

}  // namespace haptex::scene
