// Panels as triangle meshes.
#pragma once

#include <vector>

#include "haptex/garment/pattern/pattern.h"
#include "haptex/mesh/mesh.h"

namespace haptex::garment {

constexpr double kShortestMeshEdge = 5e-4;  ///< m
constexpr double kMostTriangles = 2e6;      ///< of a panel

/// What lies along an edge of a panel, from its start to its end.
struct EdgeParticles {
  std::vector<int> particles;
  std::vector<double> lengths;  ///< m, of the edge up to each of them, from 0 to its own
};

/// How a panel is filled with triangles.
enum class Interior {
  kEven,  ///< nearly equilateral ones in all directions
  /// A grid of weft and warp, cut at the outline: squares of two triangles whose corners lie at
  /// multiples of the edge length, where they are half a length or more from it.
  kGrid,
};

struct PanelMesh {
  /// One panel. Rest coordinates are (u along weft, v along warp) as seen from the right side of
  /// the fabric, m, from which all triangles turn counter-clockwise. Initial positions are those of
  /// its placement, in the world frame; of a panel that is to be laid on a carrier those of its own
  /// plane, as z = 0.
  mesh::ClothMesh mesh;
  std::vector<std::vector<EdgeParticles>> edges;  ///< per outline and edge
};

/// How far edges may be from the curves of an outline, of the edge length, where nothing else is
/// asked for.
constexpr double kCurveTolerance = 0.05;

/// Lengths (m) at which edges of a panel are to be divided, ascending from 0 to their own: per
/// outline and edge. Empty: as triangulate() finds best.
using EdgeDivisions = std::vector<std::vector<std::vector<double>>>;

/// Where a curve has to be divided at least: its ends, and the corners of lines of more than 20
/// degrees. @returns m, ascending
std::vector<double> cornerLengths(const Curve& curve);
/// How many even parts of a piece of a curve are at most so long and keep so near to it.
/// @param from, to m, lengths along the curve @param edge_length, tolerance m, > 0
int fewestParts(const Curve& curve, double from, double to, double edge_length, double tolerance);

/// The outline is divided evenly, lines with corners of more than 20 degrees there, into edges of
/// at most that length that are no farther than the tolerance from its curves, or where they are
/// near each other a part of it; refine() does the rest. Where it halves sides of the outline the
/// new particles lie on them.
/// @param panel sound @param edge_length m, from kShortestMeshEdge
/// @param tolerance m, > 0
/// @throws std::invalid_argument naming panel, value and what is allowed, also where the outline so
///   divided would cross itself or there would be more than about kMostTriangles
PanelMesh triangulate(const Panel& panel, double edge_length, double tolerance,
                      Interior interior = Interior::kEven);
/// The same where some edges are divided already. Empty divisions divide nothing.
/// @param divisions empty, or of all outlines and edges
PanelMesh triangulate(const Panel& panel, double edge_length, double tolerance, Interior interior,
                      const EdgeDivisions& divisions);
/// The same with a tolerance of kCurveTolerance of the edge length.
PanelMesh triangulate(const Panel& panel, double edge_length);

/// Some panels as one mesh, one after the other, with no particle in common; all of fabric 0.
mesh::ClothMesh joined(const std::vector<PanelMesh>& panels);
/// The number of every panel's first particle there.
std::vector<int> firstParticles(const std::vector<PanelMesh>& panels);

}  // namespace haptex::garment
