// A fingertip that presses flat fabric on a rigid plate: the contact law, integrated.
#pragma once

#include "haptex/contact/contact_law.h"
#include "haptex/material/fabric.h"

namespace haptex::oracles {

/// The force (N, upwards) on a fingertip that has pressed a sheet on a plate, slowly and straight
/// down, from where it touched it. The sheet is plane, does not stretch, and is so fine that its
/// particles are a continuum.
///
/// A place of the middle surface at the radius rho gives way by w towards the plate. With
/// s = sqrt(rho^2 + (height + w)^2) from the centre, the pulp and its half of the fabric push it
/// along the line from the centre with the pressure p(radius + half thickness - s); it is held by
/// the fingertip's friction, which has stuck or slipped all the way down (return mapping); and the
/// plate holds it with the pressure of the compression curve at the strain w / half thickness. w is
/// where the three are in equilibrium across the plate. Each ring is followed down in small steps,
/// and the force is the integral of the plate's pressure over the rings.
/// @param fabric with compression @param law of that fabric
/// @param radius m, of the fingertip, finite and > 0
/// @param height m, of the fingertip's centre above the middle surface of the sheet before it
///   yields, > 0 and at most radius + half thickness
/// @throws std::invalid_argument naming what is out of range
double supportedPressForce(const material::Fabric& fabric, const contact::ContactLaw& law,
                           double radius, double height);

}  // namespace haptex::oracles
