// A small garment for the tests of files.
#pragma once

#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "haptex/garment/pattern/pattern_file.h"

namespace haptex::garment {

/// Two panels with every kind of edge, a hole, a dart, a seam and a button.
inline const std::string kSmallGarment = R"(source: made up for tests
carriers:
  - {name: torso, shape: cylinder, segment: spine}
panels:
  - name: front
    fabric: wool
    layer: 1
    grain: [0, 2]
    placement: {position: [0.2, 0, 1], rpy: [1.5707963267948966, 0, 1.5707963267948966]}
    outline:
      - {line: [[0, 0], [0.4, 0]], name: hem}
      - {quadratic: [[0.4, 0], [0.45, 0.3], [0.4, 0.6]], name: side}
      - {line: [[0.4, 0.6], [0.25, 0.6]]}
      - {line: [[0.25, 0.6], [0.2, 0.4]], name: left of dart}
      - {line: [[0.2, 0.4], [0.15, 0.6]], name: right of dart}
      - {line: [[0.15, 0.6], [0, 0.6]]}
      - {cubic: [[0, 0.6], [-0.05, 0.4], [-0.05, 0.2], [0, 0]]}
    holes:
      - - {arc: [[0.15, 0.2], [0.2, 0.25], [0.25, 0.2]]}
        - {arc: [[0.25, 0.2], [0.2, 0.15], [0.15, 0.2]]}
  - name: back
    fabric: denim
    placement: {carrier: torso, angle: 3.14, along: 0.5}
    outline:
      - {line: [[0, 0], [0, 0.6], [0.4, 0.6]]}
      - {quadratic: [[0.4, 0.6], [0.45, 0.3], [0.4, 0]], name: side}
      - {line: [[0.4, 0], [0, 0]]}
seams:
  - sides: [{panel: front, edges: [side]}, {panel: back, edges: [1], reversed: true}]
  - {sides: [{panel: front, edges: [6, hem]}, {panel: back, edges: [0]}], easing: 0.1}
darts:
  - {panel: front, edges: [left of dart, right of dart], easing: 0}
fasteners:
  - {name: button, between: [{panel: front, at: [0.05, 0.1]}, {panel: back, at: [0.3, 0.2]}]}
)";

/// Two squares of 20 cm that face each other in front of and behind the body, sewn at their left
/// sides, as edge 1 of the front and edge 3 of the back.
inline const std::string kTwoSquares = R"({"pattern": {"panels": {
  "front": {"translation": [0, 100, 10], "rotation": [0, 0, 0],
    "vertices": [[0, 0], [20, 0], [20, 20], [0, 20]],
    "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]},
              {"endpoints": [3, 0]}]},
  "back": {"translation": [20, 100, -10], "rotation": [0, 180, 0],
    "vertices": [[0, 0], [20, 0], [20, 20], [0, 20]],
    "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]},
              {"endpoints": [3, 0]}]}},
  "stitches": [[{"panel": "front", "edge": 1}, {"panel": "back", "edge": 3}]]},
  "properties": {"units_in_meter": 100, "curvature_coords": "relative"}})";

/// What is said to a text with the first `part` replaced.
inline std::string refusalOf(std::string text, const std::string& part,
                             const std::string& replacement) {
  const std::size_t begin = text.find(part);
  if (begin == std::string::npos) return "(no such part)";
  return test::refusalOf(
      [&] { parsePattern(text.replace(begin, part.size(), replacement), "small.yaml"); });
}

}  // namespace haptex::garment
