// Triangle meshes of cloth with rest coordinates in the fabric's own weft and warp directions.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace haptex::mesh {

/// A piece that is cut from a fabric.
struct Panel {
  int fabric = 0;  ///< which of the cloth's fabrics
  double grain =
      0.0;  ///< rad, from the axes of its rest coordinates to weft and warp of the fabric
};

/// A particle that is sewn to an edge between two others, and goes with it:
///   x_particle = (1 - share) x_ends[0] + share x_ends[1].
struct Tie {
  int particle = -1;
  std::array<int, 2> ends = {-1, -1};
  double share = 0.0;  ///< from 0 to 1
};

/// A piece of a seam with the triangles on either side. Directions are in the rest coordinates of
/// each triangle's fabric (ClothMesh::restCorners()), of unit length.
struct SeamHinge {
  std::array<int, 2> triangles = {-1, -1};
  std::array<Eigen::Vector2d, 2> along = {};   ///< the seam, from the same end to the other
  std::array<Eigen::Vector2d, 2> inward = {};  ///< into the triangle, across the seam
  double length = 0.0;                         ///< m, at rest
  /// rad, of the cloth without forces, from flat; positive towards the first one's weft x warp.
  double angle = 0.0;
};

/// Cloth as triangles between particles. A sheet is one panel, whose particles have one rest
/// coordinate each. Where panels are sewn together (haptex/mesh/seam.h) they share the particles of
/// the seam, and every corner of a triangle has the rest coordinate that it has in its own panel;
/// or the particles of one edge are tied to the other.
struct ClothMesh {
  std::vector<Eigen::Vector2d> rest_coordinates;   ///< (u along weft, v along warp), m
  std::vector<Eigen::Vector3d> initial_positions;  ///< m, world frame
  std::vector<std::array<int, 3>> triangles;       ///< particle indices

  std::vector<Panel> panels = {};         ///< empty: one panel of fabric 0 along the grain
  std::vector<int> triangle_panels = {};  ///< per triangle; empty: all are of panel 0
  /// Per triangle and corner, m, in the axes of the panel; empty: those of the particles.
  std::vector<std::array<Eigen::Vector2d, 3>> corner_coordinates = {};
  /// Per triangle, which of the cloth's fabrics; empty: that of its panel. So regions of a panel
  /// can be of other fabrics, as one piece that is woven or reinforced there: along the same grain,
  /// and without a seam.
  std::vector<int> triangle_fabrics = {};
  std::vector<Tie> ties = {};               ///< as resolveTies() allows
  std::vector<SeamHinge> seam_hinges = {};  ///< of the seams that resist bending

  int panelCount() const { return panels.empty() ? 1 : static_cast<int>(panels.size()); }
  int panelOf(std::size_t triangle) const {
    return triangle_panels.empty() ? 0 : triangle_panels[triangle];
  }
  /// Which of the cloth's fabrics a triangle is of.
  int fabricOf(std::size_t triangle) const {
    return triangle_fabrics.empty() ? panel(panelOf(triangle)).fabric : triangle_fabrics[triangle];
  }
  Panel panel(int index) const { return panels.empty() ? Panel() : panels[index]; }
  /// Of the corners of a triangle, (u along weft, v along warp) of its fabric, m.
  std::array<Eigen::Vector2d, 3> restCorners(std::size_t triangle) const;
};

/// One panel of a mesh as a sheet of its own, with rest coordinates along weft and warp, and the
/// fabric of every triangle.
struct CutPanel {
  ClothMesh sheet;
  /// Of the mesh, for every one of the sheet, ascending. One that has two rest coordinates in the
  /// panel, as where a dart was merged, stands twice.
  std::vector<int> particles;
};
/// @param mesh sound @param panel of it
CutPanel cutPanel(const ClothMesh& mesh, int panel);

/// How makeRectangle() splits its cells into two triangles.
enum class Triangulation {
  kOneWay,       ///< every diagonal from (u, v) to (u + du, v + dv)
  kAlternating,  ///< the diagonal turns from each cell to the next, like a chess board
};

/// A rectangular sample [0, width] x [0, height] in rest coordinates (u, v), cells_u x cells_v
/// cells of two triangles. Particle row j, column i has index j (cells_u + 1) + i.
/// Initial positions lie in the plane x = 0 of the world frame with weft along +y and warp along
/// +z: (u, v) -> (0, u - width/2, v - height), so that the middle of the top edge (v = height) is
/// the world origin and the sample hangs below it.
/// @param width, height m, finite and > 0
/// @param cells_u, cells_v >= 1
/// @throws std::invalid_argument naming the parameter and its value
ClothMesh makeRectangle(double width, double height, int cells_u, int cells_v,
                        Triangulation triangulation);

/// A disc of `rings` rings of triangles that are nearly equilateral and equal, about 11 rings^2
/// / 2. It has no rotational symmetry that folds could keep to: the particles of each circle are
/// turned against those of the next by the golden angle. Particle 0 is the middle, the others
/// follow from circle to circle. Rest coordinates are (x, y) of the initial positions, which lie in
/// the plane z = 0 of the world frame around the origin.
/// @param radius m, finite and > 0
/// @param rings  >= 1
/// @throws std::invalid_argument naming the parameter and its value
ClothMesh makeDisc(double radius, int rings);

/// Positions (m) of the particles of a sheet that lies in the plane z = 0: their rest coordinates.
std::vector<Eigen::Vector3d> flatPositions(const ClothMesh& mesh);

/// Cuts every triangle from the fabric by itself, as large as its initial positions have it, which
/// is more than nothing, and with its first edge along weft, as for a closed surface that no plane
/// pattern makes. Its rest coordinates are replaced.
void cutAsInSpace(ClothMesh& mesh);

/// The particles on one side of the bounding rectangle of the rest coordinates, in ascending order:
/// those within 1e-9 of its diagonal.
enum class Side { kBottom, kTop, kLeft, kRight };  // v min, v max, u min, u max
std::vector<int> sideParticles(const ClothMesh& mesh, Side side);

/// What is wrong with a mesh, by index.
struct MeshDefects {
  std::vector<int> invalid_triangles;     ///< an index outside of the particles
  std::vector<int> degenerate_triangles;  ///< a repeated particle, or an altitude in rest
                                          ///< coordinates below 1e-9 of the longest edge
  std::vector<int> duplicate_triangles;   ///< same three particles as an earlier triangle
  std::vector<int> unreferenced_particles;
  std::vector<int> non_finite_particles;  ///< rest coordinate or position
  std::vector<int> unknown_panels;        ///< triangles whose panel does not exist
  std::vector<int> unsound_panels;        ///< fabric below 0, or grain not finite
  std::vector<int> unsound_fabrics;       ///< triangles whose fabric is below 0
  bool panel_mismatch = false;  ///< panels, corner coordinates or fabrics are not as many as
                                ///< triangles
  bool size_mismatch = false;   ///< rest_coordinates and initial_positions differ in length
  bool empty = false;           ///< no triangle

  bool none() const;
  /// One line that names every kind of defect found and the first ten indices of each.
  std::string description() const;
};

MeshDefects findDefects(const ClothMesh& mesh);

/// @throws std::invalid_argument with MeshDefects::description() unless the mesh has no defect
void requireSound(const ClothMesh& mesh);

/// Of a cloth; contacts number them in a byte.
constexpr std::size_t kMostFabrics = 256;

/// @param count of the cloth's fabrics
/// @throws std::invalid_argument if it is 0 or more than kMostFabrics, or a triangle is of one that
///   is not there
void requireFabrics(const ClothMesh& mesh, std::size_t count);

}  // namespace haptex::mesh
