#include "haptex/cloth/forces/modelled_effects.h"

#include <stdexcept>

#include "haptex/cloth/forces/bending/bending_friction.h"
#include "haptex/cloth/forces/corotational.h"
#include "haptex/cloth/forces/membrane.h"
#include "haptex/cloth/forces/spring_lattice.h"

namespace haptex::cloth {
namespace {

void requireHysteresis(const material::Fabric& fabric, const ModelledEffects& effects) {
  if (!effects.bending) {
    throw std::invalid_argument("hysteresis of bending is modelled and bending is not");
  }
  if (effects.elasticity == Elasticity::kMassSpring) {
    throw std::invalid_argument(
        "hysteresis of bending is modelled, which bend springs do not know");
  }
  if (!fabric.bending_hysteresis) {
    throw std::invalid_argument("hysteresis of bending is modelled and fabric '" + fabric.name +
                                "' has none: add the key hysteresis to bending");
  }
}

void requireModelled(const material::Fabric& fabric, const ModelledEffects& effects) {
  if (effects.contraction && effects.elasticity != Elasticity::kGreenLagrange) {
    throw std::invalid_argument(
        "contraction is modelled, which only Green-Lagrange elasticity knows");
  }
  if (effects.bending_hysteresis) requireHysteresis(fabric, effects);
  if (effects.bending && !fabric.bending) {
    throw std::invalid_argument("bending is modelled and fabric '" + fabric.name +
                                "' has no bending rigidity: add the key bending");
  }
  if (effects.contraction && !fabric.contraction) {
    throw std::invalid_argument("contraction is modelled and fabric '" + fabric.name +
                                "' has none: add the key contraction");
  }
}

void addElasticity(const mesh::ClothMesh& mesh, const material::Fabric& fabric,
                   const ModelledEffects& effects, ForceSum& forces) {
  switch (effects.elasticity) {
    case Elasticity::kMassSpring:
      forces.add(std::make_unique<SpringLattice>(mesh, fabric, effects.viscosity, effects.bending));
      return;
    case Elasticity::kCorotational:
      forces.add(std::make_unique<Corotational>(restElements(mesh), fabric, effects.viscosity));
      return;
    case Elasticity::kGreenLagrange:
      forces.add(std::make_unique<Membrane>(restElements(mesh), fabric, effects.viscosity,
                                            effects.contraction));
      return;
  }
}

/// But where springs do it.
void addBending(const mesh::ClothMesh& mesh, const material::Fabric& fabric,
                const ModelledEffects& effects, ForceSum& forces) {
  if (effects.elasticity == Elasticity::kMassSpring) return;
  auto bending = std::make_unique<Bending>(mesh, *fabric.bending, effects.bending_settings);
  if (effects.bending_hysteresis) {
    const material::BendingHysteresis& hysteresis = *fabric.bending_hysteresis;
    auto friction = std::make_unique<BendingFriction>(mesh, bending->hinges(), bending->corners(),
                                                      *fabric.bending, hysteresis);
    if (friction->memorySize() > 0) forces.add(std::move(friction));
  }
  forces.add(std::move(bending));
}

}  // namespace

void addFabricForces(const mesh::ClothMesh& mesh, const material::Fabric& fabric,
                     const ModelledEffects& effects, ForceSum& forces) {
  requireModelled(fabric, effects);
  addElasticity(mesh, fabric, effects, forces);
  if (effects.air) forces.add(std::make_unique<Aerodynamics>(restElements(mesh), *effects.air));
  if (effects.bending) addBending(mesh, fabric, effects, forces);
}

}  // namespace haptex::cloth
