// A fabric: areal density and the strain-stress curves of its three membrane directions.
#pragma once

#include <map>
#include <string>

#include "haptex/material/strain_stress_curve.h"

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

struct Fabric {
  std::string name;
  std::string description;                       ///< for people; may be empty
  double areal_density = 0.0;                    ///< kg/m^2, > 0
  MembraneCurves weft;                           ///< along the rest coordinate u
  MembraneCurves warp;                           ///< along the rest coordinate v
  MembraneCurves shear;                          ///< against U.V, without the factor 1/2
  std::map<std::string, Provenance> provenance;  ///< by key, for example "warp.elastic"
};

}  // namespace haptex::material
