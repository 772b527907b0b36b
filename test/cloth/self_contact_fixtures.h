// Cloth that collides with itself.
#pragma once

#include <string>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/material/fabric_file.h"
#include "haptex/mesh/mesh.h"

namespace haptex::cloth {

inline material::Fabric fabricNamed(const std::string& name) {
  return material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/" + name + ".yaml");
}

/// Sheets of their own in one mesh, at rest coordinates beside each other.
inline mesh::ClothMesh layers(int count, double side, int cells) {
  mesh::ClothMesh all;
  for (int layer = 0; layer < count; ++layer) {
    const mesh::ClothMesh one =
        mesh::makeRectangle(side, side, cells, cells, mesh::Triangulation::kAlternating);
    const int first = static_cast<int>(all.rest_coordinates.size());
    for (const Eigen::Vector2d& rest : one.rest_coordinates) {
      all.rest_coordinates.push_back(rest + Eigen::Vector2d(2.0 * side * layer, 0.0));
      all.initial_positions.emplace_back(rest.x(), rest.y(), 1.0 * layer);
    }
    for (const auto& t : one.triangles) {
      all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
  return all;
}

inline ModelledEffects selfCollision() {
  ModelledEffects effects;
  effects.self_collision = true;
  return effects;
}

}  // namespace haptex::cloth
