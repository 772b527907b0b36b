// Meshes, fabrics and motions that several tests of the contact room use.
#pragma once

#include <string>

#include "haptex/contact/haptic_layer.h"
#include "haptex/material/fabric_file.h"

namespace haptex::contact {

inline material::Fabric wool() {
  return material::loadFabric(std::string(HAPTEX_CONFIG_DIRECTORY) + "/fabrics/wool.yaml");
}

/// 40 mm, 8 x 8 cells of 5 mm, in the plane x = 0 with its middle in (0, 0, -0.02 m).
inline mesh::ClothMesh smallSample() {
  return mesh::makeRectangle(0.04, 0.04, 8, 8, mesh::Triangulation::kAlternating);
}

inline const Eigen::Vector3d kSmallSampleMiddle(0.0, 0.0, -0.02);

/// Triangles with all corners within a distance (m) of a place in rest coordinates, as seen along
/// the axes.
inline std::vector<int> trianglesAround(const mesh::ClothMesh& mesh, const Eigen::Vector2d& place,
                                        double distance) {
  std::vector<int> result;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    bool near = true;
    for (int p : mesh.triangles[t]) {
      near = near && (mesh.rest_coordinates[p] - place).lpNorm<Eigen::Infinity>() < distance + 1e-9;
    }
    if (near) result.push_back(static_cast<int>(t));
  }
  return result;
}

inline std::vector<char> nothingAttached(const mesh::ClothMesh& mesh) {
  return std::vector<char>(mesh.rest_coordinates.size(), 0);
}

inline std::vector<Eigen::Vector3d> atRest(const mesh::ClothMesh& mesh) {
  return std::vector<Eigen::Vector3d>(mesh.rest_coordinates.size(), Eigen::Vector3d::Zero());
}

/// A fingertip that presses a plane x = 0 from +x to the depth (m), above a point of the plane.
inline Fingertip pressing(const ContactLaw& law, const Eigen::Vector3d& point, double depth) {
  Fingertip fingertip;
  fingertip.radius = 7.5e-3;
  fingertip.position =
      point + Eigen::Vector3d(fingertip.radius + law.halfThickness() - depth, 0.0, 0.0);
  return fingertip;
}

}  // namespace haptex::contact
