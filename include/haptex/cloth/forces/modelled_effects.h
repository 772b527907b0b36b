// What is modelled of a fabric and of what surrounds it, and the forces that this makes.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "haptex/cloth/forces/aerodynamics.h"
#include "haptex/cloth/forces/bending/bending.h"
#include "haptex/cloth/forces/fasteners/fasteners.h"
#include "haptex/cloth/forces/force_sum.h"
#include "haptex/cloth/forces/stuffing/stuffing.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"

namespace haptex::cloth {

/// How the cloth resists stretch and shear.
enum class Elasticity {
  kGreenLagrange,  ///< Membrane: nonlinear, exact for every curve
  kBilinear,       ///< BilinearCells of each two triangles; of those without a partner Membrane
  kMassSpring,     ///< SpringLattice: for comparison, on rectangular cells
  kCorotational,   ///< Corotational: for comparison, linear
};

/// What is modelled besides inertia. What is not asked for is not computed.
struct ModelledEffects {
  bool viscosity = false;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();     ///< m/s^2
  Elasticity elasticity = Elasticity::kGreenLagrange;    ///< against stretch and shear
  bool membrane_hysteresis = false;                      ///< of stretch and shear, of the fabric
  bool bending = false;                                  ///< by the fabric's rigidity
  BendingSettings bending_settings = BendingSettings();  ///< how, if bending is modelled
  bool bending_hysteresis = false;                       ///< of the fabric, only with bending
  bool contraction = false;                              ///< of the fabric, transverse
  std::optional<Air> air = std::nullopt;                 ///< drag and lift, of still air or wind
  bool contacts = false;                                 ///< of particles with bodies
  bool self_collision = false;                           ///< of the cloth with itself
  bool point_loads = false;                              ///< forces on points of triangles
  std::vector<Fastener> fasteners = {};                  ///< buttons, bands, drawstrings
  std::optional<StuffingMass> stuffing = std::nullopt;   ///< of a closed cloth
};

/// Adds the forces that fabrics and the air have on a cloth; a new kind of force is added here.
/// Each panel bends by itself; seams resist it where the mesh has hinges for them.
/// @param mesh    without defects
/// @param fabrics that the triangles name
/// @throws std::invalid_argument if a panel's fabric is not there, the mesh is not what the
///   elasticity needs (findLatticeSprings(), or several panels of springs), bending, a hysteresis
///   or contraction is modelled and the fabric has none, contraction or hysteresis of stretch and
///   shear is modelled with another elasticity than Green-Lagrange, that of bending without bending
///   or with bend springs, what SelfContact says if collision of the cloth with itself is modelled,
///   particles are tied and the cloth is stuffed, or it is among obstacles without colliding with
///   itself, or as Stuffing, Bending, BendingFriction,
///   MembraneFriction and Aerodynamics
void addFabricForces(const mesh::ClothMesh& mesh, const std::vector<material::Fabric>& fabrics,
                     const ModelledEffects& effects, ForceSum& forces);

}  // namespace haptex::cloth
