// Strips of cloth under their own weight, at rest: exact and simulated.
#pragma once

#include <array>

#include "haptex/cloth/forces/bending/bending.h"
#include "haptex/cloth/forces/modelled_effects.h"
#include "haptex/kes/virtual_test.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"

namespace haptex::oracles {

enum class StripMesh { kOneWay, kAlternating, kIrregular };

struct NamedStripMesh {
  const char* name;  ///< in what the programs print
  StripMesh mesh;
};
/// Every mesh once.
inline constexpr std::array<NamedStripMesh, 3> kStripMeshes = {
    {{"one_way", StripMesh::kOneWay},
     {"alternating", StripMesh::kAlternating},
     {"irregular", StripMesh::kIrregular}}};

/// A strip that is clamped level at one end. Gamma = w g L^3 / B with the weight w g per area, the
/// length L and the bending rigidity B along it.
struct Cantilever {
  double gamma;  ///< no unit, > 0
  StripMesh mesh = StripMesh::kAlternating;
  kes::Direction along = kes::Direction::kWeft;
  int cells = 60;  ///< along the strip, >= 4
  cloth::BendingModel model = cloth::BendingModel::kLinear;
  double across = 7.0;  ///< bending rigidity across the strip over that along it
  /// rad, of the threads in the strip. Any, where the rigidities are equal: then a sheet bends in
  /// all directions alike. Otherwise oblique threads twist what they bend.
  double grain = 0.0;
  unsigned seed = 5;  ///< of the irregular mesh
  cloth::Elasticity elasticity = cloth::Elasticity::kGreenLagrange;
  /// N/m, of a strip of 0.1 m and 0.1 N/m^2: its threads stretch by 3e-5 unless it is less.
  double modulus = 300.0;
  double warp_over_weft = 1.0;  ///< of the moduli; `modulus` is the weft's, and twice the shear's
};

/// Drop of the tip over its horizontal distance from the clamp, mean of the tip's particles; exact:
/// exactDropOverReach().
/// @throws std::runtime_error if the equilibrium is not reached
double simulatedDropOverReach(const Cantilever& cantilever);

/// A strip on edge, clamped at one end, tips over sideways under a weight of w g L^3 / D = 18.18
/// (12.85 sqrt(B C) = w g width L^3 with the bending and torsional rigidities B = D width and
/// C = 2 D width of a strip without transverse contraction: Timoshenko and Gere 1961, 6.3).
constexpr double kLateralBucklingLoad = 18.18;
/// The same load of a simulated strip: the one at which the exact Jacobian of the cloth at rest
/// becomes singular.
/// @throws std::runtime_error if the equilibrium is not reached
double simulatedLateralBucklingLoad(StripMesh mesh, int cells);

/// Curvature (1/m) of the circle nearest to a strip that lies free, without weight, whose fabric
/// rests at `curvature` along the strip; less than 0 if it is curved away from its normal. A strip
/// 0.1 m long.
/// @param curvature 1/m, not 0
/// @throws std::runtime_error if the equilibrium is not reached
double simulatedRestCurvature(StripMesh mesh, kes::Direction along, cloth::BendingModel model,
                              double curvature);

/// The same of a strip 0.1 m long without rest curvature that was bent to three times `held` and is
/// let go, whose friction is as much as that of the elastic moment at the curvature `held`.
/// @param held 1/m, > 0: what friction holds
/// @throws std::runtime_error if the equilibrium is not reached
double simulatedResidualCurvature(StripMesh mesh, kes::Direction along, cloth::BendingModel model,
                                  double held);

/// A strip of 50 x 200 mm without weight, warp along it, whose ends are held at the distance of its
/// length and turned against each other: the torque (N.m) about its axis.
/// @param cells along the strip, >= 4; a quarter of them across
/// @throws std::runtime_error if the equilibrium is not reached
double simulatedTwistTorque(const material::Fabric& fabric, cloth::Elasticity elasticity,
                            mesh::Triangulation triangulation, int cells, double angle);

constexpr double kSlack = 5.0 / 3.0;  ///< length over span of a hanging strip

/// Sag over span of a strip that hangs from both ends without bending rigidity: that of the
/// catenary, and of a simulated strip.
/// @param slack length over span, >= 1.001 and <= 1000
/// @throws std::invalid_argument naming a slack out of this range
double exactSagOverSpan(double slack = kSlack);
/// @param slack as above, at most 5: the strip starts on a circle
/// @throws std::runtime_error if the equilibrium is not reached
double simulatedSagOverSpan(StripMesh mesh, int cells, double slack = kSlack);

}  // namespace haptex::oracles
