// Small bodies for tests.
#pragma once

#include <cmath>
#include <string>

#include "haptex/garment/body/body.h"

namespace haptex::garment {

/// A closed prism around the world's z axis, with so many sides, from z = 0 to the height (m), of
/// one segment `spine` that fills it.
inline Body makePrism(double radius, double height, int sides) {
  Body body;
  const auto corner = [&](int ring, int side) { return 2 + 2 * (side % sides) + ring; };
  body.vertices = {{0, 0, 0}, {0, 0, height}};
  for (int side = 0; side < sides; ++side) {
    const double angle = 2.0 * M_PI * side / sides;
    for (const double z : {0.0, height}) {
      body.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
    body.triangles.push_back({0, corner(0, side + 1), corner(0, side)});
    body.triangles.push_back({1, corner(1, side), corner(1, side + 1)});
    body.triangles.push_back({corner(0, side), corner(0, side + 1), corner(1, side + 1)});
    body.triangles.push_back({corner(0, side), corner(1, side + 1), corner(1, side)});
  }
  body.segments = {{"spine", -1, "trunk", "", {0, 0, 0}, {0, 0, height}}};
  body.shares.assign(body.vertices.size(), {{0, 1.0}});
  return body;
}

inline std::string bodyPath(const std::string& name) {
  return HAPTEX_CONFIG_DIRECTORY "/bodies/" + name;
}

}  // namespace haptex::garment
