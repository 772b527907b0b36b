// What a scene file attaches: particles that are held, and particles that frames carry.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "haptex/base/yaml_reader.h"
#include "haptex/mesh/mesh.h"

namespace haptex::scene {

/// Particles that go with a frame, as the links of a mechanism and all that tf knows.
struct CarryingFrame {
  std::string name;                                         ///< isFrameName()
  Eigen::Isometry3d start = Eigen::Isometry3d::Identity();  ///< its pose in the world for which the
                                                            ///< mesh's initial positions are right
  std::vector<int> particles;                               ///< ascending
  std::vector<Eigen::Vector3d> places;                      ///< m, of the particles in the frame
};

struct Attachments {
  std::vector<int> particles;         ///< all, ascending, those that frames carry among them
  std::vector<CarryingFrame> frames;  ///< by name
};

/// Reads the keys `attach` and `frames`.
/// @throws std::invalid_argument naming file, key, value and what is allowed: a particle that there
///   is not, a range of rest coordinates without a particle, a frame that `frames` does not list or
///   that carries nothing, a particle that is attached by two frames, or by one and the world
Attachments readAttachments(const base::YamlValue& file, const mesh::ClothMesh& mesh);

}  // namespace haptex::scene
