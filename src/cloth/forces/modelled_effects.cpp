#include "haptex/cloth/forces/modelled_effects.h"

#include <algorithm>
#include <stdexcept>

#include "haptex/base/quoted.h"
#include "haptex/cloth/forces/bending/bending_friction.h"
#include "haptex/cloth/forces/bending/seam_bending.h"
#include "haptex/cloth/forces/cells/bilinear_cells.h"
#include "haptex/cloth/forces/corotational.h"
#include "haptex/cloth/forces/membrane.h"
#include "haptex/cloth/forces/membrane_friction.h"
#include "haptex/cloth/forces/self_contact/self_contact.h"
#include "haptex/cloth/forces/spring_lattice.h"

namespace haptex::cloth {
namespace {

void requireMembraneHysteresis(const material::Fabric& fabric, const ModelledEffects& effects) {
  if (effects.elasticity != Elasticity::kGreenLagrange) {
    throw std::invalid_argument(
        "hysteresis of stretch and shear is modelled, which only Green-Lagrange elasticity knows");
  }
  const auto require = [&](bool stated, const char* key) {
    if (stated) return;
    throw std::invalid_argument("hysteresis of stretch and shear is modelled and fabric " +
                                base::quoted(fabric.name) + " lacks it: add the key " + key);
  };
  require(fabric.resilience.has_value(), "resilience");
  require(fabric.shear_hysteresis.has_value(), "hysteresis to shear");
}

void requireHysteresis(const material::Fabric& fabric, const ModelledEffects& effects) {
  if (!effects.bending) {
    throw std::invalid_argument("hysteresis of bending is modelled and bending is not");
  }
  if (effects.elasticity == Elasticity::kMassSpring) {
    throw std::invalid_argument(
        "hysteresis of bending is modelled, which bend springs do not know");
  }
  if (!fabric.bending_hysteresis) {
    throw std::invalid_argument("hysteresis of bending is modelled and fabric " +
                                base::quoted(fabric.name) +
                                " has none: add the key hysteresis to bending");
  }
}

void requireModelled(const material::Fabric& fabric, const ModelledEffects& effects) {
  if (effects.contraction && effects.elasticity != Elasticity::kGreenLagrange) {
    throw std::invalid_argument(
        "contraction is modelled, which only Green-Lagrange elasticity knows");
  }
  if (effects.membrane_hysteresis) requireMembraneHysteresis(fabric, effects);
  if (effects.bending_hysteresis) requireHysteresis(fabric, effects);
  if (effects.bending && !fabric.bending) {
    throw std::invalid_argument("bending is modelled and fabric " + base::quoted(fabric.name) +
                                " has no bending rigidity: add the key bending");
  }
  if (effects.contraction && !fabric.contraction) {
    throw std::invalid_argument("contraction is modelled and fabric " + base::quoted(fabric.name) +
                                " has none: add the key contraction");
  }
}

void requirePanels(const mesh::ClothMesh& mesh, const std::vector<material::Fabric>& fabrics,
                   const ModelledEffects& effects) {
  mesh::requireFabrics(mesh, fabrics.size());
  if (effects.elasticity != Elasticity::kMassSpring) return;
  if (fabrics.size() > 1) {
    throw std::invalid_argument("springs know one fabric, and the cloth has " +
                                std::to_string(fabrics.size()));
  }
  if (mesh.panelCount() > 1) {
    throw std::invalid_argument("springs know one panel, and the mesh has " +
                                std::to_string(mesh.panelCount()));
  }
}

void addMembrane(std::vector<MembraneElement> elements, const material::Fabric& fabric,
                 const ModelledEffects& effects, ForceSum& forces) {
  const bool hysteresis = effects.membrane_hysteresis && !MembraneFriction::isZero(fabric);
  if (!hysteresis) {
    forces.add(std::make_unique<Membrane>(std::move(elements), fabric, effects.viscosity,
                                          effects.contraction));
    return;
  }
  auto friction = std::make_unique<MembraneFriction>(elements, fabric);
  forces.add(std::make_unique<Membrane>(std::move(elements), elasticShare(fabric),
                                        effects.viscosity, effects.contraction));
  forces.add(std::move(friction));
}

/// Cells of one fabric, and the membrane where a triangle has no partner.
void addCells(const mesh::ClothMesh& mesh, int fabric_index, const material::Fabric& fabric,
              const ModelledEffects& effects, ForceSum& forces) {
  const PairedTriangles paired = pairTriangles(mesh, fabric_index);
  if (!paired.pairs.empty()) {
    forces.add(std::make_unique<BilinearCells>(paired.pairs, fabric, effects.viscosity));
  }
  if (!paired.single.empty()) {
    forces.add(
        std::make_unique<Membrane>(restElements(mesh, paired.single), fabric, effects.viscosity));
  }
}

/// The elements of every fabric, or the springs of the only one.
void addElasticity(const mesh::ClothMesh& mesh, const std::vector<material::Fabric>& fabrics,
                   const ModelledEffects& effects, ForceSum& forces) {
  if (effects.elasticity == Elasticity::kMassSpring) {
    forces.add(
        std::make_unique<SpringLattice>(mesh, fabrics.front(), effects.viscosity, effects.bending));
    return;
  }
  for (std::size_t f = 0; f < fabrics.size(); ++f) {
    const material::Fabric& fabric = fabrics[f];
    if (effects.elasticity == Elasticity::kBilinear) {
      addCells(mesh, static_cast<int>(f), fabric, effects, forces);
      continue;
    }
    std::vector<MembraneElement> elements = restElements(mesh, static_cast<int>(f));
    if (elements.empty()) continue;
    if (effects.elasticity == Elasticity::kCorotational) {
      forces.add(std::make_unique<Corotational>(std::move(elements), fabric, effects.viscosity));
    } else {
      addMembrane(std::move(elements), fabric, effects, forces);
    }
  }
}

std::vector<material::BendingRigidity> rigiditiesOf(const std::vector<material::Fabric>& fabrics) {
  std::vector<material::BendingRigidity> rigidities;
  for (const material::Fabric& fabric : fabrics) rigidities.push_back(*fabric.bending);
  return rigidities;
}

/// Whether darts of the panel were merged, so that a particle has two places in it.
bool hasMergedDarts(const mesh::CutPanel& cut) {
  return std::adjacent_find(cut.particles.begin(), cut.particles.end()) != cut.particles.end();
}

void requireNoMergedDarts(const mesh::CutPanel& cut, const ModelledEffects& effects) {
  const bool curved = !effects.bending_settings.rest_curvature.isZero(0.0);
  if ((!effects.bending_hysteresis && !curved) || !hasMergedDarts(cut)) return;
  throw std::invalid_argument(std::string(curved ? "curvature at rest" : "hysteresis of bending") +
                              " is modelled, and a panel has a dart that was merged: allowed is to "
                              "sew darts by ties");
}

/// Of a panel with regions of other fabrics.
void addBendingOfRegions(const mesh::CutPanel& cut, const std::vector<material::Fabric>& fabrics,
                         const ModelledEffects& effects, ForceSum& forces) {
  if (effects.bending_hysteresis) {
    throw std::invalid_argument(
        "hysteresis of bending knows one fabric in a panel, and the mesh has regions of others");
  }
  auto bending =
      std::make_unique<Bending>(cut.sheet, rigiditiesOf(fabrics), effects.bending_settings);
  bending->renumber(cut.particles);
  forces.add(std::move(bending));
}

void addBending(const mesh::CutPanel& cut, const std::vector<material::Fabric>& fabrics,
                const ModelledEffects& effects, ForceSum& forces) {
  const std::vector<int>& named = cut.sheet.triangle_fabrics;
  if (named.empty()) return;  // of a part of a cloth that has nothing of this panel
  requireNoMergedDarts(cut, effects);
  if (std::any_of(named.begin(), named.end(), [&](int f) { return f != named.front(); })) {
    return addBendingOfRegions(cut, fabrics, effects, forces);
  }
  const material::Fabric& fabric = fabrics[named.front()];
  auto bending = std::make_unique<Bending>(cut.sheet, *fabric.bending, effects.bending_settings);
  if (effects.bending_hysteresis) {
    auto friction =
        std::make_unique<BendingFriction>(cut.sheet, bending->hinges(), bending->corners(),
                                          *fabric.bending, *fabric.bending_hysteresis);
    friction->renumber(cut.particles);
    if (friction->memorySize() > 0) forces.add(std::move(friction));
  }
  bending->renumber(cut.particles);
  forces.add(std::move(bending));
}

void addStuffing(const mesh::ClothMesh& mesh, const ModelledEffects& effects, ForceSum& forces) {
  if (!mesh.ties.empty()) {
    throw std::invalid_argument(
        "stuffing is modelled, and particles are tied: allowed are edges that are merged");
  }
  if (effects.contacts && !effects.self_collision) {
    throw std::invalid_argument(
        "stuffing is modelled among obstacles, which needs self_collision modelled, too");
  }
  forces.add(std::make_unique<Stuffing>(mesh, *effects.stuffing));
}

}  // namespace

void addFabricForces(const mesh::ClothMesh& mesh, const std::vector<material::Fabric>& fabrics,
                     const ModelledEffects& effects, ForceSum& forces) {
  requirePanels(mesh, fabrics, effects);
  for (const material::Fabric& fabric : fabrics) requireModelled(fabric, effects);
  addElasticity(mesh, fabrics, effects, forces);
  if (effects.self_collision) {
    forces.add(std::make_unique<SelfContact>(RestSurface(mesh), fabrics));
  }
  if (effects.stuffing) addStuffing(mesh, effects, forces);
  if (effects.air) forces.add(std::make_unique<Aerodynamics>(restElements(mesh), *effects.air));
  if (!effects.bending || effects.elasticity == Elasticity::kMassSpring) return;
  for (int p = 0; p < mesh.panelCount(); ++p) {
    addBending(mesh::cutPanel(mesh, p), fabrics, effects, forces);
  }
  if (mesh.seam_hinges.empty()) return;
  forces.add(std::make_unique<SeamBending>(mesh, rigiditiesOf(fabrics)));
}

}  // namespace haptex::cloth
