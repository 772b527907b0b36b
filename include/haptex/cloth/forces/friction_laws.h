// Friction within a fabric against one strain of its membrane, independent of the rate: what
// MembraneFriction computes with.
//
// A law has a stress c(e; p) of the Green-Lagrange strain e and of one number p that remembers the
// past. At a fixed p it is the slope of an energy >= 0. After every step p follows e, and never
// makes that energy larger: friction takes energy out. Equations and their sources:
// docs/mechanics.md, Hysteresis of stretch and shear.
#pragma once

#include "haptex/material/fabric.h"
#include "haptex/material/strain_stress_curve.h"

namespace haptex::cloth {

struct FrictionResponse {
  double stress = 0.0;   ///< c, N/m
  double tangent = 0.0;  ///< dc/de, N/m; less than 0 where friction falls with the strain
  double secant = 0.0;   ///< N/m, >= 0: of a spring that would exert c about where there is none
  double energy = 0.0;   ///< J/m^2, the integral of c from where it is 0
};

/// Against the stretch of weft or warp. With Q = q0 + W, W the work to the strain by the fabric's
/// curve s = dW/de, and P a work that is remembered,
///   c = r s t,  t = (Q - P) / (kYieldShare P), from -1 to 1.
/// Beside (1 - r) s, the membrane's share (elasticShare()), stretching from rest meets the curve
/// and letting go 1 - 2 r of it, so a cycle from rest to any strain returns
///   1 - 2 r / (1 + kYieldShare)
/// of its work: that is the resilience. In compression c = r s, so that both together are the
/// curve.
class ThreadFriction {
 public:
  /// Of the work remembered: by so much it changes until friction yields.
  static constexpr double kYieldShare = 0.1;
  /// q0 (J/m^2): strains of less work have no past. A millionth of a percent in most fabrics.
  static constexpr double kLeastWork = 1e-12;

  /// r of a resilience from TensileResilience::kLeast to 1: from 0.495 to 0.
  static double share(double resilience) { return 0.5 * (1.0 + kYieldShare) * (1.0 - resilience); }

  /// @param curve      s, the fabric's own
  /// @param resilience from TensileResilience::kLeast to 1, not checked: MembraneFriction does
  ThreadFriction(material::StrainStressCurve curve, double resilience);

  /// @param strain Green-Lagrange, no unit @param remembered P, J/m^2, > 0
  FrictionResponse respond(double strain, double remembered) const;
  /// P (J/m^2) of a fabric that was stretched to here for the first time.
  double forgotten(double strain) const;
  /// P (J/m^2) after a step that has ended at the strain.
  double follow(double strain, double remembered) const;

 private:
  struct Work {
    double energy;   // J/m^2, of the curve
    bool slack;      // the thread does not pull
    double counted;  // Q, J/m^2
  };
  Work workAt(double strain) const;

  material::StrainStressCurve curve_;
  double share_;
};

/// Against shear. With a plastic strain p,
///   c = y(e) t,  t = (e - p) / kYieldStrain, from -1 to 1,
/// y half of 2HG up to the strain of 0.5 degrees either way, half of 2HG5 from that of 5 degrees
/// on, and straight in between.
class ShearFriction {
 public:
  static constexpr double kYieldStrain = 0.005;  ///< U.V, 0.29 degrees

  /// @param hysteresis finite and >= 0, not checked: MembraneFriction does
  explicit ShearFriction(const material::ShearHysteresis& hysteresis);

  /// @param strain U.V, no unit @param remembered p, likewise
  FrictionResponse respond(double strain, double remembered) const;
  /// p where there is no friction.
  double forgotten(double strain) const { return strain; }
  /// p after a step that has ended at the strain.
  double follow(double strain, double remembered) const;

 private:
  struct Yield {
    double stress;  // y, N/m, and its derivative
    double slope;
    double energy;  // integral of y from 0, J/m^2
    double moment;  // integral of y times strain from 0, J/m^2
  };
  Yield yieldAt(double strain) const;

  double small_, large_, slope_;  // N/m: y on either side, and between
};

}  // namespace haptex::cloth
