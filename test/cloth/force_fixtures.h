// What tests of single forces ask them with.
#pragma once

#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/forces/cells/bilinear_cells.h"
#include "haptex/cloth/forces/corotational.h"
#include "haptex/cloth/forces/membrane.h"
#include "haptex/cloth/forces/spring_lattice.h"

namespace haptex::cloth {

/// Where velocities do not matter.
inline ForceState resting(const Positions& positions) {
  static const Velocities kNone;
  return {positions, kNone};
}

inline const Membrane& membraneOf(const Cloth& cloth) { return *cloth.forces().find<Membrane>(); }

/// The force that resists stretch and shear.
inline const Force& elasticityOf(const Cloth& cloth) {
  if (const auto* springs = cloth.forces().find<SpringLattice>()) return *springs;
  if (const auto* cells = cloth.forces().find<BilinearCells>()) return *cells;
  if (const auto* corotational = cloth.forces().find<Corotational>()) return *corotational;
  return membraneOf(cloth);
}

inline const std::vector<PointLoad>& loadsOf(const Cloth& cloth) {
  return cloth.forces().find<PointLoads>()->loads();
}

/// What Newton iterations hold of a stage that starts from these positions.
inline std::vector<Eigen::Vector3d> heldSince(const Force& force, const Positions& base) {
  std::vector<Eigen::Vector3d> held(force.heldSize(), Eigen::Vector3d::Zero());
  const StrainPast past = StrainPast::since(base, 1.0);
  ForceState at = resting(base);
  at.past = &past;
  force.hold({base, at, 1.0, false}, held.data());
  return held;
}

/// What they hold of a stage that ends near a state, whose rates are those of the velocities.
inline std::vector<Eigen::Vector3d> heldBefore(const Force& force, const ForceState& at, double a) {
  std::vector<Eigen::Vector3d> held(force.heldSize(), Eigen::Vector3d::Zero());
  force.hold({at.positions, at, a, false}, held.data());
  return held;
}

}  // namespace haptex::cloth
