// Two spheres that press a flat sheet from opposite sides: the contact law, integrated.
#pragma once

#include "haptex/contact/contact_law.h"

namespace haptex::oracles {

/// What each of two equal spheres feels that meet a sheet face to face. The sheet is plane and so
/// fine that its particles are a continuum; the line through the centres is normal to it.
struct PinchForce {
  double force;      ///< N, along the line through the centres, on each sphere
  double stiffness;  ///< N/m: how the force rises as the distance of the centres falls
  double area;       ///< m^2, of the sheet under pressure
};

/// With z = distance / 2, a place of the middle surface at the radius rho from the axis has the
/// distance s = sqrt(rho^2 + z^2) from each centre, so the depth there is radius + half thickness -
/// s. The pressure acts along the line from the centre, on the sheet's area at rest; the part along
/// the axis is z / s, and the rest cancels around the axis and is borne by the sheet. As
/// rho d rho = s d s,
///   force = 2 pi z integral of pressure(depth) d depth, from 0 to radius + half thickness - z.
/// The integral by Gauss-Legendre quadrature to 1e-8 of the force.
/// @param radius   m, of both spheres
/// @param distance m, of their centres
/// @throws std::invalid_argument naming what is not finite and > 0
PinchForce pinchForce(const contact::ContactLaw& law, double radius, double distance);

}  // namespace haptex::oracles
