// A fingertip on a flat sheet that does not yield: what it feels when it is drawn sideways.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/contact/contact_law.h"
#include "haptex/contact/sphere_contact.h"

namespace haptex::oracles {

/// A fine flat sheet in the plane x = 0 that does not move.
struct FlatSheet {
  std::vector<Eigen::Vector3d> positions, velocities;
  std::vector<double> areas;

  FlatSheet(double half_side, int cells);
  contact::Particles particles() const {
    return {positions, velocities, areas, static_cast<int>(positions.size())};
  }
};

/// Before all slips, each place pulls with its spring or with its share of friction:
///   force(s) = integral of min(k s, coefficient pressure) over the area of contact (N),
/// for displacements s that are small beside it. With the distance r = radius + half thickness -
/// depth of a place from the centre, rho d rho = r d r makes it an integral over the depth.
/// @param radius m, of the fingertip, > 0
/// @param depth  m, in the middle, >= 0 and at most radius + half thickness
/// @param displacement m, >= 0
/// @throws std::invalid_argument naming what is out of these ranges
double exactDrag(const contact::ContactLaw& law, double radius, double depth, double displacement);

}  // namespace haptex::oracles
