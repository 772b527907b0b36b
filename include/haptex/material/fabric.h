// A fabric: areal density and the strain-stress curves of its three membrane directions.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "haptex/material/strain_stress_curve.h"
#include "haptex/material/surface.h"

namespace haptex::material {

/// Where a property of a fabric comes from.
struct Provenance {
  enum class Kind {
    kMeasured,        ///< measured on a real fabric; `source` says by whom
    kRepresentative,  ///< typical for this kind of fabric; `source` says why this value
  };
  Kind kind;
  std::string source;
};

/// Elastic curve: stress (N/m) against Green-Lagrange strain.
/// Viscous curve: stress (N/m) against strain rate (1/s).
struct MembraneCurves {
  StrainStressCurve elastic;
  StrainStressCurve viscous;
};

/// Bending rigidity: moment per width over curvature (N.m), KES value B.
struct BendingRigidity {
  double weft;  ///< when the weft is curved, >= 0
  double warp;  ///< when the warp is curved, >= 0
};

/// Hysteresis of bending: width of the loop of moment per width over curvature (N), KES value 2HB.
struct BendingHysteresis {
  double weft;  ///< when the weft is curved, >= 0, 0 if the rigidity is
  double warp;  ///< likewise
};

/// Hysteresis of stretch: the share of the work of pulling that comes back (no unit), KES value RT
/// over 100.
struct TensileResilience {
  static constexpr double kLeast = 0.1;  ///< at less cloth would not contract when it is let go
  double weft;                           ///< pulled along the weft, kLeast to 1
  double warp;                           ///< likewise
};

/// Hysteresis of shear: width of the loop of shear stress over shear angle (N/m).
struct ShearHysteresis {
  double at_half_degree;   ///< KES value 2HG, >= 0
  double at_five_degrees;  ///< KES value 2HG5, >= 0
};

/// Lateral compression between two plates.
struct Compression {
  double thickness;  ///< m, without pressure, > 0
  StrainStressCurve
      pressure;  ///< Pa against compressive strain (thickness - compressed) / thickness
};

struct Fabric {
  std::string name;
  std::string description;     ///< for people; may be empty
  double areal_density = 0.0;  ///< kg/m^2, > 0
  MembraneCurves weft;         ///< along the rest coordinate u
  MembraneCurves warp;         ///< along the rest coordinate v
  MembraneCurves shear;        ///< against U.V, without the factor 1/2
  // What a scene without hysteresis, bending, contact, tactile rendering or pictures does not need.
  std::optional<TensileResilience> resilience;
  std::optional<ShearHysteresis> shear_hysteresis;
  std::optional<BendingRigidity> bending;
  std::optional<BendingHysteresis> bending_hysteresis;  ///< only with bending
  /// Coupling of weft and warp like a Poisson ratio, >= 0: haptex/material/contraction.h
  std::optional<double> contraction;
  std::optional<Compression> compression;
  std::optional<double> friction;  ///< coefficient of kinetic friction against skin, KES MIU, > 0
  std::optional<Surface> surface;
  std::optional<Look> look;
  std::map<std::string, Provenance> provenance;  ///< by key, for example "warp.elastic"
  /// The text of the fabric file that it was read from, which parseFabric() reads wherever that is;
  /// empty where it was made otherwise.
  std::string file;
};

}  // namespace haptex::material
