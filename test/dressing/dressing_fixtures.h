// A tube of two panels and a cone that it comes to rest on.
#pragma once

#include <cmath>
#include <string>

#include "haptex/dressing/drape.h"
#include "haptex/garment/pattern/pattern_file.h"
#include "haptex/material/fabric_file.h"

namespace haptex::dressing {

/// Of 0.3 m width each, in front of the z axis and behind it, `from` to `from` + 0.2 m high.
inline garment::Pattern tube(double from) {
  const std::string z = std::to_string(from);
  return garment::parsePattern(R"(
source: drawn for a test
panels:
  - name: front
    fabric: wool
    placement: {position: [0.25, 0, )" +
                                   z + R"(], rpy: [1.570796326794897, 0, 1.570796326794897]}
    outline:
      - {line: [[-0.15, 0], [0.15, 0]]}
      - {line: [[0.15, 0], [0.15, 0.2]], name: left}
      - {line: [[0.15, 0.2], [-0.15, 0.2]]}
      - {line: [[-0.15, 0.2], [-0.15, 0]], name: right}
  - name: back
    fabric: wool
    placement: {position: [-0.25, 0, )" +
                                   z + R"(], rpy: [1.570796326794897, 0, 1.570796326794897]}
    outline:
      - {line: [[-0.15, 0], [0.15, 0]]}
      - {line: [[0.15, 0], [0.15, 0.2]], name: left}
      - {line: [[0.15, 0.2], [-0.15, 0.2]]}
      - {line: [[-0.15, 0.2], [-0.15, 0]], name: right}
seams:
  - sides: [{panel: front, edges: [left]}, {panel: back, edges: [left]}]
  - sides: [{panel: front, edges: [right]}, {panel: back, edges: [right]}]
)",
                               "tube");
}

/// Closed, from the radius `bottom` at z = 0 to `top` at z = height, about the z axis (m), in so
/// many bands of triangles.
inline mesh::ObstacleMesh cone(double bottom, double top, double height, int bands = 1) {
  constexpr int kSides = 24;
  mesh::ObstacleMesh body;
  for (int ring = 0; ring <= bands; ++ring) {
    const double share = static_cast<double>(ring) / bands;
    for (int i = 0; i < kSides; ++i) {
      const double angle = 2.0 * M_PI * i / kSides, radius = bottom + share * (top - bottom);
      body.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                                 share * height);
    }
  }
  const int low = static_cast<int>(body.vertices.size()), last = bands * kSides;
  body.vertices.emplace_back(0.0, 0.0, 0.0);
  body.vertices.emplace_back(0.0, 0.0, height);
  for (int i = 0; i < kSides; ++i) {
    const int j = (i + 1) % kSides;
    for (int band = 0; band < last; band += kSides) {
      body.triangles.push_back({band + i, band + j, band + kSides + j});
      body.triangles.push_back({band + i, band + kSides + j, band + kSides + i});
    }
    body.triangles.push_back({j, i, low});
    body.triangles.push_back({last + i, last + j, low + 1});
  }
  return body;
}

inline std::vector<material::Fabric> wool() {
  return {material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml")};
}

}  // namespace haptex::dressing
