// Pressure and friction between a fingertip and a fabric.
#pragma once

#include <vector>

#include "haptex/material/fabric.h"
#include "haptex/material/strain_stress_curve.h"

namespace haptex::contact {

/// What a fingertip's pulp adds to the fabric's own properties.
struct PulpSettings {
  /// Pa/m: pressure by depth of the pulp. The force on a fingertip of radius R at depth d in a flat
  /// fabric is pi R stiffness d^2, its stiffness 2 sqrt(pi R stiffness force): with 8e6 Pa/m and a
  /// thumb of 9 mm 1345 N/m at 2 N, the stiffest wall that the exoskeleton renders steadily under
  /// every finger (scripts/bench exoskeleton).
  double stiffness = 8e6;
  /// s/m: the pressure of a fingertip that approaches with v is 1 + damping v times the elastic one
  /// (Hunt and Crossley 1975).
  double damping = 2.0;
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
  /// @param most_layers of folded cloth that a fingertip may push through, >= 1
  /// @throws std::invalid_argument if the fabric has no compression or no friction, or a setting is
  ///   not finite and > 0
  ContactLaw(const material::Fabric& fabric, const PulpSettings& pulp = {}, int most_layers = 1);

  /// Pressure (Pa) and its slope (Pa/m) at a depth (m); zero where depth <= 0.
  material::CurveValue pressure(double depth) const;
  /// The same of a place whose middle surface is `distance` (m) from the fingertip's surface, with
  /// other layers of the fabric in between, all in series:
  ///   (layers + 1/2) thickness - distance
  ///     = pressure / pulp stiffness + (layers + 1/2) (thickness - compressed thickness(pressure)),
  /// interpolated in straight lines between whole numbers of them.
  /// @param layers_before from 0 to most_layers - 1
  material::CurveValue pressureThrough(double layers_before, double distance) const;
  /// m: the distance of pressureThrough() from which on there is no pressure.
  double reachThrough(double layers_before) const {
    return (2.0 * layers_before + 1.0) * half_thickness_;
  }
  double halfThickness() const { return half_thickness_; }  ///< m, uncompressed
  double friction() const { return friction_; }             ///< coefficient, MIU
  double damping() const { return damping_; }               ///< s/m, of Hunt and Crossley
  /// Pa/m: shear traction by tangential displacement while the fabric sticks.
  double tangentialStiffness() const { return tangential_stiffness_; }

 private:
  std::vector<material::StrainStressCurve> pressures_;  // by layers before, 0 at least
  double half_thickness_;
  double friction_;
  double damping_;
  double tangential_stiffness_;
};

}  // namespace haptex::contact
