// Cloth that collides with itself.
#pragma once

#include <string>
#include <vector>

#include "derivatives.h"
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

/// Of the contact alone (N).
inline std::vector<Eigen::Vector3d> contactForces(const Cloth& cloth, const ClothState& state) {
  std::vector<Eigen::Vector3d> forces(cloth.particleCount(), Eigen::Vector3d::Zero());
  cloth.selfContact()->addForces(state.ofForces(), forces);
  return forces;
}

/// Expects them to be the negative gradient of its energy.
inline void expectContactGradient(const Cloth& cloth, const ClothState& state, double tolerance) {
  const auto energy = [&](const ClothState& at) {
    return cloth.selfContact()->energy(at.ofForces());
  };
  expectGradient(contactForces(cloth, state), state, energy, 1e-8, tolerance);
}

inline ModelledEffects selfCollision() {
  ModelledEffects effects;
  effects.self_collision = true;
  return effects;
}

}  // namespace haptex::cloth
