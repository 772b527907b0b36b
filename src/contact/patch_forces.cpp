#include "haptex/contact/patch_forces.h"

#include <algorithm>
#include <map>
#include <memory>
#include <numeric>
#include <utility>

#include "haptex/cloth/forces/aerodynamics.h"
#include "haptex/cloth/forces/bending/bending.h"
#include "haptex/cloth/forces/bending/seam_bending.h"
#include "haptex/cloth/forces/membrane.h"
#include "haptex/mesh/merged_seams.h"

namespace haptex::contact {
namespace {

using Rigidities = std::vector<material::BendingRigidity>;

/// Some triangles on the particles of a cut, as a mesh of their own.
struct Part {
  mesh::ClothMesh mesh;
  std::vector<int> particles;  // of the cut, ascending
};

/// @param mesh of some triangles, of the cut's particles, without what is said of particles
Part partOf(const RefinedCut& cut, mesh::ClothMesh mesh) {
  std::map<int, int> places;
  for (const auto& triangle : mesh.triangles) {
    for (const int particle : triangle) places[particle] = 0;
  }
  Part part{std::move(mesh), {}};
  for (auto& [particle, place] : places) {
    place = static_cast<int>(part.particles.size());
    part.particles.push_back(particle);
    part.mesh.rest_coordinates.push_back(cut.mesh.rest_coordinates[particle]);
  }
  for (auto& triangle : part.mesh.triangles) {
    for (int& particle : triangle) particle = places.at(particle);
  }
  part.mesh.initial_positions.assign(part.particles.size(), Eigen::Vector3d::Zero());
  if (!part.mesh.corner_coordinates.empty()) mesh::addHingesOfMergedSeams(part.mesh);
  return part;
}

template <typename T>
std::vector<T> firstOf(const std::vector<T>& of_triangles, std::ptrdiff_t count) {
  if (of_triangles.empty()) return {};
  return {of_triangles.begin(), of_triangles.begin() + count};
}

/// The elements that are refined; unless others surround them, all of the cut as it is.
Part refinedPart(const RefinedCut& cut) {
  if (!cut.isSurrounded()) {
    Part part{cut.mesh, std::vector<int>(cut.mesh.rest_coordinates.size())};
    std::iota(part.particles.begin(), part.particles.end(), 0);
    return part;
  }
  const auto count = static_cast<std::ptrdiff_t>(cut.refined_count) << (2 * cut.refinement);
  mesh::ClothMesh mesh;
  mesh.panels = cut.mesh.panels;
  mesh.triangles = firstOf(cut.mesh.triangles, count);
  mesh.triangle_panels = firstOf(cut.mesh.triangle_panels, count);
  mesh.triangle_fabrics = firstOf(cut.mesh.triangle_fabrics, count);
  mesh.corner_coordinates = firstOf(cut.mesh.corner_coordinates, count);
  return partOf(cut, std::move(mesh));
}

/// All elements of the cut by their corners.
/// @param none the number of a fabric that resists nothing, which the refined ones are of
Part coarsePart(const mesh::ClothMesh& coarse, const RefinedCut& cut, int none) {
  mesh::ClothMesh mesh;
  mesh.panels = cut.mesh.panels;
  for (std::size_t e = 0; e < cut.elements.size(); ++e) {
    const int element = cut.elements[e];
    std::array<int, 3> triangle = coarse.triangles[element];
    for (int& corner : triangle) corner = cornerIn(cut, corner);
    mesh.triangles.push_back(triangle);
    const bool is_refined = static_cast<int>(e) < cut.refined_count;
    mesh.triangle_fabrics.push_back(is_refined ? none : coarse.fabricOf(element));
    if (coarse.corner_coordinates.empty()) continue;
    mesh.triangle_panels.push_back(coarse.panelOf(element));
    mesh.corner_coordinates.push_back(coarse.restCorners(element));
  }
  return partOf(cut, std::move(mesh));
}

/// Of every panel that the part has something of.
std::vector<std::unique_ptr<cloth::Bending>> bendingOf(const Part& part,
                                                       const Rigidities& rigidities,
                                                       const cloth::BendingSettings& settings) {
  std::vector<std::unique_ptr<cloth::Bending>> bending;
  const auto add = [&](const mesh::ClothMesh& sheet, const std::vector<int>& particles) {
    if (sheet.triangles.empty()) return;
    bending.push_back(rigidities.size() == 1
                          ? std::make_unique<cloth::Bending>(sheet, rigidities.front(), settings)
                          : std::make_unique<cloth::Bending>(sheet, rigidities, settings));
    bending.back()->renumber(particles);
  };
  if (part.mesh.corner_coordinates.empty()) {
    add(part.mesh, part.particles);
    return bending;
  }
  for (int panel = 0; panel < part.mesh.panelCount(); ++panel) {
    mesh::CutPanel cut = mesh::cutPanel(part.mesh, panel);
    for (int& particle : cut.particles) particle = part.particles[particle];
    add(cut.sheet, cut.particles);
  }
  return bending;
}

void addSeamBending(const Part& part, const Rigidities& rigidities, PatchForces& forces) {
  if (part.mesh.seam_hinges.empty()) return;
  auto bending = std::make_unique<cloth::SeamBending>(part.mesh, rigidities);
  bending->renumber(part.particles);
  forces.sum.add(std::move(bending));
}

void addBending(const mesh::ClothMesh& coarse, const RefinedCut& cut, Rigidities rigidities,
                const cloth::BendingSettings& settings, PatchForces& forces) {
  const Part refined = refinedPart(cut);
  for (auto& bending : bendingOf(refined, rigidities, settings)) {
    forces.sum.add(std::move(bending));
  }
  addSeamBending(refined, rigidities, forces);
  if (!cut.isSurrounded()) return;
  rigidities.push_back({0.0, 0.0});
  const int none = static_cast<int>(rigidities.size()) - 1;
  const Part around = coarsePart(coarse, cut, none);
  for (auto& bending : bendingOf(around, rigidities, settings)) {
    // Edges of a refined element are no edges of the cut.
    for (const cloth::Bending::Coupling& coupling : bending->couplings()) {
      forces.pairs.push_back({coupling.column, coupling.row});
    }
    forces.sum.add(std::move(bending));
  }
  addSeamBending(around, rigidities, forces);
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
