// Values that several parts of a scene file have in common.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "haptex/base/yaml_reader.h"
#include "haptex/mesh/obj_file.h"

namespace haptex::scene {

constexpr double kMaxSize = 100.0;  ///< m, of what a scene file describes

/// The path of a file that a scene names. A name without a separator lies in the directory `kind`
/// beside the scene's, a path is relative to the scene's directory.
/// @param extension with the dot; added if the name does not end with it
/// @throws std::invalid_argument naming the files that there are if there is no such file
std::string resolveFile(const base::YamlValue& value, const std::string& kind,
                        const std::string& extension);

/// Three finite numbers.
/// @throws std::invalid_argument naming file, key, value and what is allowed
Eigen::Vector3d readVector(const base::YamlValue& value);

/// The same, each at most `largest` from 0.
/// @param allowed says so when it refuses one, with the unit
/// @throws std::invalid_argument naming file, key, value and what is allowed
Eigen::Vector3d readVectorWithin(const base::YamlValue& value, double largest, const char* allowed);

/// A length (m), > 0 and at most kMaxSize.
/// @throws std::invalid_argument naming file, key, value and what is allowed
double readSize(const base::YamlValue& value);

/// A place (m), each coordinate at most kMaxSize from 0.
/// @throws std::invalid_argument naming file, key, value and what is allowed
Eigen::Vector3d readPosition(const base::YamlValue& value);

/// The pose that the keys `position` (m) and `rpy` (rad) of a map give, each zero if not given. As
/// in URDF: rotations about the fixed axes x, y and z, in this order.
/// @throws std::invalid_argument naming file, key, value and what is allowed
Eigen::Isometry3d readPose(const base::YamlValue& value);

/// A name that may become part of a topic: isFrameName().
/// @throws std::invalid_argument naming file, key, value and what is allowed
std::string readName(const base::YamlValue& value);

/// @throws std::invalid_argument naming file, key, value and what is allowed
int readParticle(const base::YamlValue& value, const mesh::ClothMesh& mesh);

/// Triangles of a group of the mesh.
/// @throws std::invalid_argument naming file, key, value and the groups that there are
const std::vector<int>& readGroup(const base::YamlValue& value, const mesh::MeshGroups& groups);

/// @throws std::invalid_argument naming file, key, number and the most that are allowed
void requireTriangleCount(const base::YamlValue& value, long long triangles);

}  // namespace haptex::scene
