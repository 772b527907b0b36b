// DXF drawings in ASCII, as far as sewing patterns use them.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace haptex::garment {

/// A point, line, polyline or text of a drawing, in its unit.
struct DxfEntity {
  enum class Kind { kPoint, kLine, kPolyline, kText };
  Kind kind = Kind::kPoint;
  std::string layer;
  std::vector<Eigen::Vector2d>
      points;           ///< of a polyline without bulges, which are straightened out
  bool closed = false;  ///< the last point is joined to the first
  std::string text;
};

struct DxfBlock {
  std::string name;
  std::vector<DxfEntity> entities;
};

struct DxfDrawing {
  int unit = 0;                     ///< $INSUNITS: 1 inch, 4 mm, 5 cm, 6 m; 0 if it says nothing
  std::vector<DxfBlock> blocks;     ///< of the section BLOCKS
  std::vector<DxfEntity> entities;  ///< of the section ENTITIES
};

/// Reads group codes and values, each on a line, by the DXF reference of AutoCAD release 13. Other
/// kinds of entities, sections and group codes are passed over. Arcs between the points of
/// polylines become straight lines within 1e-5 of their chord.
/// @param name of the text in messages
/// @throws std::invalid_argument naming it, the line, the value and what is allowed
DxfDrawing readDxf(const std::string& text, const std::string& name);

}  // namespace haptex::garment
