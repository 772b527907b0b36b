// Parts of validateCloth(), by what they look at.
#pragma once

#include <string>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/material/fabric.h"
#include "haptex/oracles/checks/validation.h"

namespace haptex::oracles {

/// A number for a name, without trailing zeros.
std::string numbered(double value);

/// The models for comparison with the membrane: what they deliver of a fabric's curves, what they
/// cannot, their Jacobians.
void validateModels(const material::Fabric& linear, const material::Fabric& wool, const Sink& sink);

/// Largest difference between a cloth's Jacobian and central differences of its forces, relative to
/// the largest entry, in a random deformation about a given mean.
/// @param name cloth/jacobian_position and cloth/jacobian_velocity, the latter only if the fabric
///   is viscous, are followed by it
void validateJacobian(const material::Fabric& fabric, cloth::Elasticity elasticity,
                      const std::string& name, const Eigen::Matrix2d& mean_deformation,
                      const Sink& sink);

/// Orders of convergence, energy of an oscillator, and losses of swinging sheets.
void validateIntegrators(const material::Fabric& linear, const material::Fabric& wool,
                         const Sink& sink);

/// Parameters that the virtual KES tests measure against those that the fabric file says, without a
/// hysteresis of stretch and shear.
/// @param anisotropic a fabric that resists bending differently in weft and warp
void validateKes(const material::Fabric& fabric, const material::Fabric& anisotropic,
                 const Sink& sink);

/// The same parameters of tensile and shear tests, with the hysteresis: of each fabric, and of the
/// first one with an unusual one.
/// @param fabrics with a resilience and a hysteresis of shear
void validateKesHysteresis(const std::vector<material::Fabric>& fabrics, const Sink& sink);

/// A free strip against the coupled equations, and a clamped square with and without contraction.
/// @param wool with a contraction
void validateContraction(const material::Fabric& wool, const Sink& sink);

/// Drag of a plate, terminal velocity, wind against motion, and a strip in the wind.
void validateAir(const material::Fabric& fabric, const Sink& sink);

/// Cantilevers, lateral buckling, a catenary, and free strips with a rest curvature.
void validateBending(const Sink& sink);

}  // namespace haptex::oracles
