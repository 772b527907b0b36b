// Pressure and friction between a fingertip and a fabric.
#pragma once

#include "haptex/material/fabric.h"
#include "haptex/material/strain_stress_curve.h"

namespace haptex::contact {

/// What a fingertip's pulp adds to the fabric's own properties.
struct PulpSettings {
  /// Pa/m: pressure by depth of the pulp. The force on a fingertip of radius R at depth d in a flat
  /// fabric is pi R stiffness d^2.
  double stiffness = 1.3e7;
  /// s: the pressure's viscous part is this times the stiffness times the speed of approach.
  double damping_time = 2e-3;
};

/// Normal pressure against depth, and Coulomb friction.
///
/// The depth is how far the fingertip's sphere reaches beyond the fabric's uncompressed surface
/// (half its thickness from the middle surface). Pulp and half of the fabric are springs in series:
///   depth = pressure / pulp stiffness + (thickness - compressed thickness(pressure)) / 2,
/// so a fabric between two fingertips has exactly the thickness that its compression curve gives
/// for the pressure.
class ContactLaw {
 public:
  /// @throws std::invalid_argument if the fabric has no compression or no friction, or a setting is
  ///   not finite and > 0
  ContactLaw(const material::Fabric& fabric, const PulpSettings& pulp = {});

  /// Pressure (Pa) and its slope (Pa/m) at a depth (m); zero where depth <= 0.
  material::CurveValue pressure(double depth) const;
  double halfThickness() const { return half_thickness_; }  ///< m, uncompressed
  double friction() const { return friction_; }             ///< coefficient, MIU
  double dampingTime() const { return damping_time_; }      ///< s
  /// Pa/m: shear traction by tangential displacement while the fabric sticks.
  double tangentialStiffness() const { return tangential_stiffness_; }

 private:
  material::StrainStressCurve pressure_;
  double half_thickness_;
  double friction_;
  double damping_time_;
  double tangential_stiffness_;
};

}  // namespace haptex::contact
