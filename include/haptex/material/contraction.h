// How much weft and warp of a fabric draw on each other.
#pragma once

#include "haptex/material/fabric.h"

namespace haptex::material {

/// The modulus c (N/m) by which weft and warp are coupled:
///   suu = fu(euu) + c evv,  svv = fv(evv) + c euu,  c = contraction sqrt(fu'(0) fv'(0)),
/// the gradient of an energy with the term c euu evv. Where the transverse stretch is held at rest
/// the curves are those of the fabric. For a linear isotropic fabric pulled along one direction
/// the other's strain is -contraction times that. 0 if the fabric has no contraction.
double contractionModulus(const Fabric& fabric);

/// The contraction below which the energy is convex for all strains of weft and warp:
///   sqrt(min fu' min fv' / (fu'(0) fv'(0))), 0 if a curve falls or is level somewhere.
double largestContraction(const Fabric& fabric);

}  // namespace haptex::material
