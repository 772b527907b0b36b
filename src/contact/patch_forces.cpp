#include "haptex/contact/patch_forces.h"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "haptex/cloth/forces/aerodynamics.h"
#include "haptex/cloth/forces/bending/bending.h"
#include "haptex/cloth/forces/membrane.h"

namespace haptex::contact {
namespace {

using Rigidities = std::vector<material::BendingRigidity>;

/// Some triangles on the particles of a cut, as a mesh of their own.
struct Part {
  mesh::ClothMesh mesh;
  std::vector<int> particles;  // of the cut, ascending
};

/// @param triangles of the cut's particles
/// @param fabrics   one per triangle; empty: all are of the first
Part partOf(const RefinedCut& cut, std::vector<std::array<int, 3>> triangles,
            std::vector<int> fabrics) {
  std::map<int, int> places;
  for (const auto& triangle : triangles) {
    for (const int particle : triangle) places[particle] = 0;
  }
  Part part;
  for (auto& [particle, place] : places) {
    place = static_cast<int>(part.particles.size());
    part.particles.push_back(particle);
    part.mesh.rest_coordinates.push_back(cut.mesh.rest_coordinates[particle]);
  }
  for (auto& triangle : triangles) {
    for (int& particle : triangle) particle = places.at(particle);
  }
  part.mesh.initial_positions.assign(part.particles.size(), Eigen::Vector3d::Zero());
  part.mesh.triangles = std::move(triangles);
  part.mesh.triangle_fabrics = std::move(fabrics);
  return part;
}

Part refinedPart(const RefinedCut& cut) {
  const auto count = static_cast<std::ptrdiff_t>(cut.refined_count) << (2 * cut.refinement);
  const auto& triangles = cut.mesh.triangles;
  const auto& fabrics = cut.mesh.triangle_fabrics;
  return partOf(cut, {triangles.begin(), triangles.begin() + count},
                {fabrics.begin(), fabrics.empty() ? fabrics.end() : fabrics.begin() + count});
}

/// All elements of the cut by their corners.
/// @param none the number of a fabric that resists nothing, which the refined ones are of
Part coarsePart(const mesh::ClothMesh& coarse, const RefinedCut& cut, int none) {
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> fabrics;
  for (std::size_t e = 0; e < cut.elements.size(); ++e) {
    const int element = cut.elements[e];
    std::array<int, 3> triangle = coarse.triangles[element];
    for (int& corner : triangle) corner = cornerIn(cut, corner);
    triangles.push_back(triangle);
    const bool is_refined = static_cast<int>(e) < cut.refined_count;
    fabrics.push_back(is_refined ? none : coarse.fabricOf(element));
  }
  return partOf(cut, std::move(triangles), std::move(fabrics));
}

std::unique_ptr<cloth::Bending> bendingOf(const Part& part, const Rigidities& rigidities,
                                          const cloth::BendingSettings& settings) {
  auto bending = std::make_unique<cloth::Bending>(part.mesh, rigidities, settings);
  bending->renumber(part.particles);
  return bending;
}

void addBending(const mesh::ClothMesh& coarse, const RefinedCut& cut, Rigidities rigidities,
                const cloth::BendingSettings& settings, PatchForces& forces) {
  if (!cut.isSurrounded()) {
    forces.sum.add(rigidities.size() == 1
                       ? std::make_unique<cloth::Bending>(cut.mesh, rigidities.front(), settings)
                       : std::make_unique<cloth::Bending>(cut.mesh, rigidities, settings));
    return;
  }
  forces.sum.add(bendingOf(refinedPart(cut), rigidities, settings));
  rigidities.push_back({0.0, 0.0});
  const int none = static_cast<int>(rigidities.size()) - 1;
  auto around = bendingOf(coarsePart(coarse, cut, none), rigidities, settings);
  // Edges of a refined element are no edges of the cut.
  for (const cloth::Bending::Coupling& coupling : around->couplings()) {
    forces.pairs.push_back({coupling.column, coupling.row});
  }
  forces.sum.add(std::move(around));
}

}  // namespace

PatchForces forcesOn(const mesh::ClothMesh& coarse, const RefinedCut& cut,
                     const std::vector<material::Fabric>& fabrics,
                     const cloth::ModelledEffects& effects) {
  PatchForces forces;
  Rigidities rigidities;
  for (std::size_t f = 0; f < fabrics.size(); ++f) {
    rigidities.push_back(*fabrics[f].bending);
    std::vector<cloth::MembraneElement> elements =
        cloth::restElements(cut.mesh, static_cast<int>(f));
    if (elements.empty()) continue;
    forces.sum.add(std::make_unique<cloth::Membrane>(std::move(elements), fabrics[f],
                                                     effects.viscosity, effects.contraction));
  }
  addBending(coarse, cut, std::move(rigidities), effects.bending_settings, forces);
  if (effects.air) {
    forces.sum.add(
        std::make_unique<cloth::Aerodynamics>(cloth::restElements(cut.mesh), *effects.air));
  }
  const std::vector<std::array<int, 2>> of_sum = forces.sum.pairs();
  forces.pairs.insert(forces.pairs.end(), of_sum.begin(), of_sum.end());
  return forces;
}

}  // namespace haptex::contact
