// Cloth as a Wavefront OBJ file.
#pragma once

#include <Eigen/Core>
#include <iosfwd>
#include <string>
#include <vector>

#include "haptex/mesh/mesh.h"
#include "haptex/mesh/obstacle.h"

namespace haptex::mesh {

/// Writes initial positions ("v", m), the rest coordinates of each triangle's corners along weft
/// and warp as texture coordinates ("vt", m), and the triangles of each panel as a group ("g"), in
/// their order. Numbers have as many digits as give them back.
/// @param names of the panels, as many, without blanks
/// @throws std::invalid_argument if there are not as many names as panels, or one is empty or has a
///   blank or a control character
void writeObj(const ClothMesh& mesh, const std::vector<std::string>& names, std::ostream& out);

/// Writes positions ("v", m) alone, with as many digits as give them back; the stream keeps these.
void writeObjPositions(const std::vector<Eigen::Vector3d>& positions, std::ostream& out);

/// Writes a surface: its vertices ("v", m) and triangles.
void writeObj(const ObstacleMesh& surface, std::ostream& out);

}  // namespace haptex::mesh
